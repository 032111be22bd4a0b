// An LLVM module in the making: the functions and tables of one IR module that its entries reach, in one form.
#pragma once

#include "jit/codegen.h"
#include "jit/llvm.h"

#include <map>
#include <memory>
#include <tuple>
#include <vector>

namespace haptel::jit {

// How a value is held: one for all points or in lanes, a real in f64 or in f32.
struct Form {
    bool in_lanes = false, is_single = false;
};

// Of one function, by ir::Value::index.
class ValueForms {
public:
    ValueForms(const ir::Function& of, std::vector<bool> varying, std::vector<bool> wide_values, uint32_t lane_count)
        : function(of), varies(std::move(varying)), wide(std::move(wide_values)), lanes(lane_count)
    {
    }
    bool is_varying(ir::Value value) const { return varies[value.index]; }
    bool is_wide(ir::Value value) const { return wide[value.index]; }
    Form operator[](ir::Value value) const
    {
        const bool is_real = function.type(value) == ir::Type::real;
        return {lanes > 1 && is_varying(value), is_real && is_varying(value) && !is_wide(value)};
    }

private:
    const ir::Function& function;
    std::vector<bool> varies, wide;
    uint32_t lanes;
};

class ModuleEmitter {
public:
    ModuleEmitter(const ir::Module& from, llvm::Module& to, const Processor& of, bool is_batch, Precision precision)
        : source(from), target(to), processor(of), lanes(is_batch ? of.lanes : 1), plan(from, precision)
    {
    }

    struct Function {
        llvm::Function* code = nullptr;
        std::shared_ptr<const ValueForms> forms;
    };
    // The function for arguments of which those vary, with results of which those are f64; its body follows with the
    // next finish().
    const Function& function(uint32_t index, const std::vector<bool>& arguments, const std::vector<bool>& wide_results);
    void finish();

    ValueForms forms(uint32_t index, const std::vector<bool>& arguments, const std::vector<bool>& wide_results) const;
    llvm::GlobalVariable* table(uint32_t index, bool is_single);
    llvm::Type* type(ir::Type type, Form form);

    const ir::Module& source;
    llvm::Module& target;
    const Processor& processor;
    const uint32_t lanes; // of what varies

private:
    struct Key {
        uint32_t index;
        std::vector<bool> arguments, wide_results;
        bool operator<(const Key& other) const
        {
            return std::tie(index, arguments, wide_results) <
                   std::tie(other.index, other.arguments, other.wide_results);
        }
        Form result(const ir::Function& of, size_t i, uint32_t lane_count) const;
    };
    using Functions = std::map<Key, Function>;
    const PrecisionPlan plan;
    Functions functions;
    std::vector<Functions::const_iterator> unfinished;
    std::map<std::pair<uint32_t, bool>, llvm::GlobalVariable*> tables;

    void write_body(const Key& key, const Function& function);
};

} // namespace haptel::jit
