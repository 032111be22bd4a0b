// What programs share: kernels and elementary functions, linked once per process, on disk known by what they are.
#pragma once

#include "jit/codegen/kernels.h"
#include "jit/engine/linker.h"
#include "jit/engine/machine_code.h"

#include <atomic>
#include <future>
#include <map>
#include <mutex>
#include <string>
#include <vector>

namespace haptel::jit {

// On disk, of that effort or a greater one; no bytes: there is none.
Object found_object(const std::string& identity, Effort effort);
void keep(const Object& object, const std::string& identity);

class SharedCode {
public:
    // `names`: what decides, with a function's name, which code it has.
    SharedCode(Compilers& makes, Linker& links, const std::string& names)
        : compilers(makes), linker(links), target(names)
    {
    }

    using Function = FunctionsApart::value_type;
    // Nothing or why not.
    std::string link(const Function& function, Effort effort);
    // Null: not linked yet, or of less effort.
    llvm::orc::ExecutorAddr known(const std::string& name, Effort effort);
    size_t count();

private:
    struct Linked {
        llvm::orc::ExecutorAddr address;
        Effort effort;
    };
    Compilers& compilers;
    Linker& linker;
    const std::string& target;
    std::mutex mutex;
    std::map<std::string, Linked> linked; // by name; the best of each
};

// Functions on their way while their caller, too, is compiled: other threads begin with what is not linked yet.
class Fetch {
public:
    Fetch(SharedCode& from, const FunctionsApart& functions, Effort effort);

    // Lends a hand and waits. Nothing or why not.
    std::string finish(Addresses& addresses);

private:
    struct Missing {
        const SharedCode::Function& function;
        std::string error = {};
    };
    void work();

    SharedCode& shared;
    const FunctionsApart& wanted;
    const Effort effort;
    std::vector<Missing> missing;
    std::atomic<size_t> next{0};            // of them
    std::vector<std::future<void>> helpers; // last: ends before what it works on
};

} // namespace haptel::jit
