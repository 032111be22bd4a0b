// What programs share: kernels and elementary functions, linked once per process, on disk known by what they are.
#pragma once

#include "jit/codegen/kernels.h"
#include "jit/engine/compilers.h"
#include "jit/engine/linker.h"

#include <atomic>
#include <functional>
#include <future>
#include <map>
#include <mutex>
#include <string>
#include <vector>

namespace haptel::jit {

using Generate = std::function<std::unique_ptr<llvm::Module>(llvm::LLVMContext&, Effort)>;

// On disk, of that effort or a greater one; no bytes: there is none.
Object found_object(const std::string& identity, Effort effort);
void keep(const Object& object, const std::string& identity);

class SharedCode {
public:
    SharedCode(Compilers& makes, Linker& links) : compilers(makes), linker(links) {}

    struct Function {
        std::string name, identity;
        Generate generate; // a module with that function; any thread
    };
    // Nothing or why not.
    std::string link(const Function& function, Effort effort, llvm::orc::ExecutorAddr& address);
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
    std::mutex mutex;
    std::map<std::string, Linked> linked; // by name; the best of each
};

// Functions on their way while their caller, too, is compiled: other threads begin with what is not linked yet.
class Fetch {
public:
    Fetch(SharedCode& from, std::vector<SharedCode::Function> wanted, Effort effort);

    // Lends a hand and waits. Nothing or why not.
    std::string finish(Addresses& addresses);

private:
    struct Item {
        SharedCode::Function function;
        llvm::orc::ExecutorAddr address;
        std::string error;
    };
    void work();

    SharedCode& shared;
    const Effort effort;
    Addresses found;
    std::vector<Item> missing;
    std::atomic<size_t> next{0};            // of them
    std::vector<std::future<void>> helpers; // last: ends before what it works on
};

} // namespace haptel::jit
