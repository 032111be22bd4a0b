// An LLVM module in the making: the functions and tables of one IR module that its entries reach, in one form.
#pragma once

#include "jit/codegen/codegen.h"
#include "jit/codegen/iteration_lanes.h"
#include "jit/codegen/llvm.h"
#include "lang/ir/dead_code.h"

#include <map>
#include <memory>
#include <tuple>
#include <vector>

namespace haptel::jit {

class KernelCalls;

// How a value is held: one for all, or in lanes, which are points or iterations of a loop; a real in f64 or in f32.
struct Form {
    bool in_lanes = false, is_single = false;
};

// What a function is made for.
struct Signature {
    std::vector<bool> arguments;    // that vary between points
    std::vector<bool> in_lanes;     // arguments that differ between lanes
    std::vector<bool> wide_results; // that are f64
    std::vector<bool> in_order;     // arguments that differ between iterations that lanes would hold, were it no draft
    // The others are left out, in the forms of all else; empty: all of them. No function for all has a list of all.
    std::vector<bool> needed_results;
    auto operator<=>(const Signature&) const = default;
    std::string text() const; // all of it: equal texts, equal signatures
};

// Of one function, by ir::Value::index.
struct ValueForms {
    const ir::Function& function;
    std::vector<bool> varies = {}, in_lanes = {}, wide = {};
    std::vector<bool> needed = {};   // empty: everything
    LaneLoops loops = {};            // whose iterations are lanes, or have the bits of lanes
    std::vector<bool> in_order = {}; // what differs between the iterations of those that are ordered

    bool is_varying(ir::Value value) const { return varies[value.index]; }
    bool is_wide(ir::Value value) const { return wide[value.index]; }
    bool is_needed(ir::Value value) const { return needed.empty() || needed[value.index]; }
    bool is_single(ir::Value value) const
    {
        return function.type(value) == ir::Type::real && is_varying(value) && !is_wide(value);
    }
    Form operator[](ir::Value value) const { return {in_lanes[value.index], is_single(value)}; }
};

// A field of a structure.
llvm::Value* at_offset(llvm::IRBuilder<>& builder, llvm::Value* base, size_t offset);

// Asks for the memory that these lanes of an array will be in, `points_ahead` later: to read, or to write.
void ask_ahead(llvm::IRBuilder<>& builder, llvm::Type* element, llvm::Value* array, llvm::Value* first, uint32_t lanes,
               bool to_write);

class ModuleEmitter {
public:
    // With `kernel_calls`, what is worth a kernel is called and not written. A draft has the bits of lanes, but not
    // the lanes where that takes long to compile.
    ModuleEmitter(const ir::Module& from, llvm::Module& to, const Processor& of, LaneForm of_lanes, Precision precision,
                  KernelCalls* kernel_calls, bool draft)
        : source(from)
        , target(to)
        , processor(of)
        , form(of_lanes)
        , lanes(of_lanes == LaneForm::points ? of.lanes : iteration_lanes)
        , plan(from, precision)
        , kernels(kernel_calls)
        , is_draft(draft)
    {
    }

    struct Function {
        llvm::Function* code = nullptr;
        std::shared_ptr<const ValueForms> forms;
        std::vector<Form> results;
    };
    // Its body follows with the next finish().
    const Function& function(uint32_t index, const Signature& signature);
    void finish();

    ValueForms forms(uint32_t index, const Signature& signature);
    llvm::Type* type(ir::Type type, Form held);

    // The cells of a constant table, reals in f32 where `is_single`.
    llvm::GlobalVariable* table(uint32_t index, bool is_single);
    // Those at `index`, a vector of i32, each in range. A small table stays in registers and is permuted where the
    // processor can; any other is gathered from memory.
    llvm::Value* read_in_lanes(llvm::IRBuilder<>& builder, uint32_t table, llvm::Value* index, bool is_single);

    bool fuses() const { return plan.precision != Precision::f64 && processor.fuses; }

    // Where a program is written whole: library functions that its batches call all the same. Within a batch's loop
    // LLVM would take their constants out of it, and these would fill the registers.
    std::vector<bool> called_by_batches; // by function; empty: none

    const ir::Module& source;
    llvm::Module& target;
    const Processor& processor;
    const LaneForm form;
    const uint32_t lanes; // in a vector

private:
    static constexpr uint32_t iteration_lanes = 8; // more loops have fewer iterations than have more

    const PrecisionPlan plan;
    KernelCalls* const kernels; // null: everything is written
    const bool is_draft;
    std::map<std::pair<uint32_t, Signature>, Function> functions;
    std::vector<const Function*> unfinished;
    std::map<std::pair<uint32_t, bool>, llvm::GlobalVariable*> tables;
    ir::NeededValues needs{source};
};

} // namespace haptel::jit
