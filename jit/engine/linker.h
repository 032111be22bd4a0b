// Object files to code in this process. Objects may call the functions of code_library(), what they are linked with,
// and nothing else. Any thread.
#pragma once

#include "jit/codegen/llvm.h"

#include <atomic>
#include <map>
#include <memory>
#include <string>
#include <string_view>

namespace haptel::jit {

using Addresses = std::map<std::string, llvm::orc::ExecutorAddr>; // by symbol

class Linker {
public:
    // Nothing or why not.
    std::string start(const llvm::orc::JITTargetMachineBuilder& host, const llvm::DataLayout& layout);

    // One object, to be removed as a whole.
    struct Linked {
        llvm::orc::JITDylib* place = nullptr; // null: see error
        std::string error = {};
    };
    // Asks for the addresses in `wanted`, whose names are what must be in the object.
    Linked link(std::string_view object, const Addresses& others, Addresses& wanted);
    void remove(llvm::orc::JITDylib& place);

private:
    std::unique_ptr<llvm::orc::LLJIT> jit;
    llvm::orc::JITDylib* library = nullptr; // holds code_library()
    std::atomic<uint64_t> links{0};         // made so far, for names

    llvm::orc::JITDylib& new_place(const std::string& name);
    void define(llvm::orc::JITDylib& place, const Addresses& functions);
};

} // namespace haptel::jit
