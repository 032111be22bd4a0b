// Functions of the library that are compiled apart, once for all programs that call them.
//
// A kernel is a function for one signature with all that it calls. Its name is a hash of what decides
// its code: the text of the function, the signature, lanes and precision, the processor and the versions of both code
// generators. So any two programs that call the same function share the object, in memory and on disk, and a program of
// the user's is a few calls. A program with kernels gives the bits of one without: they are the same operations.
#pragma once

#include "jit/codegen/codegen_module.h"
#include "jit/codegen/content_hash.h"

#include <functional>
#include <map>
#include <string>
#include <vector>

namespace haptel::jit {

// By index: library functions, with all that they call, that are long enough to be called.
std::vector<bool> worth_a_kernel(const ir::Module& module);

// By symbol, what writes a function into a module that is otherwise empty. Any thread.
using FunctionsApart = std::map<std::string, std::function<void(llvm::Module& alone, bool is_draft)>>;

// The functions compiled apart that one program calls, found while its code is generated.
class KernelCalls {
public:
    // `target` names processor and compiler: code for another one has other names. Module and processor must outlive
    // what is used().
    KernelCalls(const ir::Module& module, const Processor& processor, std::string target);

    // The name to call it by, which is then one of used(); empty: it becomes part of the program.
    std::string call(uint32_t function, const Signature& signature, LaneForm lanes, Precision precision);
    // Elementary functions are compiled apart likewise (jit/codegen/codegen_math.h): those that the program calls.
    void note(const llvm::Module& made);
    const FunctionsApart& used() const { return functions; }

    const ContentHash& hash_of(uint32_t function) const { return hashes[function]; }

private:
    const ir::Module& module;
    const Processor& processor;
    const std::string target;
    const std::vector<ContentHash> hashes; // by function
    const std::vector<bool> is_worth_it;   // likewise
    FunctionsApart functions;
};

} // namespace haptel::jit
