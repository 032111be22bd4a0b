// An LLVM module in the making: the functions and tables of one IR module that its entries reach.
#pragma once

#include "jit/llvm.h"
#include "lang/ir/ir.h"

#include <map>
#include <vector>

namespace haptel::jit {

class ModuleEmitter {
public:
    // `lanes`: of what varies; 1 where nothing does.
    ModuleEmitter(const ir::Module& from, llvm::Module& to, uint32_t lane_count)
        : source(from), target(to), lanes(lane_count)
    {
    }

    // The function for arguments of which those vary; its body follows with the next finish().
    llvm::Function* function(uint32_t index, const std::vector<bool>& arguments);
    void finish();

    llvm::GlobalVariable* table(uint32_t index);
    llvm::Type* type(ir::Type type, bool in_lanes);

    const ir::Module& source;
    llvm::Module& target;
    const uint32_t lanes;

private:
    using Form = std::pair<uint32_t, std::vector<bool>>; // index, which arguments vary
    std::map<Form, llvm::Function*> functions;
    std::vector<std::map<Form, llvm::Function*>::const_iterator> unfinished;
    std::vector<llvm::GlobalVariable*> tables = std::vector<llvm::GlobalVariable*>(source.tables.size());

    void write_body(const Form& form, llvm::Function& function);
};

} // namespace haptel::jit
