// One interval evaluation of a function and everything it calls.
#pragma once

#include "lang/ir/bounds.h"

#include <optional>

namespace haptel::ir {

class IntervalEvaluator {
public:
    // `operations` that one evaluation may execute: a result that needs more is unknown.
    IntervalEvaluator(const Module& module, uint64_t operations);

    // `box` may be null for functions that are not entries.
    std::vector<Interval> run(uint32_t function, std::span<const Interval> arguments, const BoundsBox* box);
    uint64_t operations_used() const { return limit - left; }

private:
    struct Frame {
        const Function& function;
        std::vector<Interval> values; // by Value::index
        const std::vector<const Instruction*>& makers;
    };
    struct Narrowed {
        Value value;
        Interval before;
    };

    const Module& module;
    const uint64_t limit;
    uint64_t left = 0;
    uint32_t depth = 0; // blocks and calls inside each other
    const BoundsBox* box = nullptr;
    std::vector<std::vector<const Instruction*>> makers; // by function, then Value::index; filled when first needed

    const std::vector<const Instruction*>& makers_of(uint32_t function);
    std::vector<Interval> call(uint32_t function, std::span<const Interval> arguments);
    std::vector<Interval> look_inside(uint32_t function, std::span<const Interval> arguments);
    std::optional<Interval> by_slope(uint32_t function, std::span<const Interval> arguments, double useful_radius);
    void block(Frame& frame, const Block& block);
    // Arms that cannot be entered give no values at all.
    std::vector<Interval> arm(Frame& frame, const Block& block, Value condition, bool taken);
    bool narrow(Frame& frame, Value condition, bool taken, std::vector<Narrowed>& undo);
    bool narrow_comparison(Frame& frame, const Instruction& comparison, bool taken, std::vector<Narrowed>& undo);

    void visit(Frame& frame, const Instruction& made, const Operation& kind);
    void visit(Frame& frame, const Instruction& made, const RealConstant& kind);
    void visit(Frame& frame, const Instruction& made, const IntConstant& kind);
    void visit(Frame& frame, const Instruction& made, const BoolConstant& kind);
    void visit(Frame& frame, const Instruction& made, const ReadInput& kind);
    void visit(Frame& frame, const Instruction& made, const ReadParameter& kind);
    void visit(Frame& frame, const Instruction& made, const ReadTable& kind);
    void visit(Frame& frame, const Instruction& made, const Call& kind);
    void visit(Frame& frame, const Instruction& made, const PointDerivative& kind);
    void visit(Frame& frame, const Instruction& made, const If& kind);
    void visit(Frame& frame, const Instruction& made, const For& kind);
};

} // namespace haptel::ir
