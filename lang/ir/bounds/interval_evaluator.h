// One interval evaluation of a function and everything it calls; where asked for, with bounds of its derivatives.
//
// interval_evaluator.cpp walks blocks, interval_variation.cpp knows how operations vary, interval_choice.cpp `if`s and
// conditions, interval_call.cpp calls and facts, interval_structure.cpp what values are made of.
#pragma once

#include "lang/ir/bounds/bounds.h"
#include "lang/ir/bounds/cell_ranges.h"
#include "lang/ir/bounds/polynomial.h"
#include "lang/ir/bounds/seams.h"
#include "lang/ir/derive/activity.h"

#include <map>
#include <optional>
#include <set>
#include <unordered_map>

namespace haptel::ir {

// The operation that makes a value; nothing if it is no operation, or a parameter (null).
inline std::optional<Op> op_of(const Instruction* maker)
{
    auto* operation = maker ? std::get_if<Operation>(&maker->kind) : nullptr;
    return operation ? std::optional(operation->op) : std::nullopt;
}

class IntervalEvaluator {
public:
    // `operations` that one evaluation may execute: a result that needs more is unknown.
    IntervalEvaluator(const Module& module, uint64_t operations);

    // `box` may be null for functions that are not entries.
    std::vector<Interval> run(uint32_t function, std::span<const Interval> arguments, const BoundsBox* box);
    // By the last run. More than the limit where calls make a large part of it: they take time, and decide no result.
    uint64_t operations_used() const { return limit - left + of_calls; }

    // Values, and how each varies with the point. `variations` is empty where they were not asked for.
    struct Results {
        std::vector<Interval> values;
        std::vector<Variation> variations;
    };
    // How much of how they vary: each of these, and those before it. Where the class is not sought they are no smoother
    // than they are said to be; with it, it is looked for at seams and where arms meet. A curvature that is not sought
    // takes half the time and means nothing.
    enum class Sought : uint8_t { slope, curvature, continuity };
    Results run_varying(uint32_t entry, const BoundsBox& box, Sought sought);
    struct Findings {
        std::vector<Undefined> undefined; // met by the last run_varying(), each place once
        std::set<uint32_t> believed;      // functions whose facts it believed although they are not proven
        std::map<std::pair<uint32_t, FalseFact::What>, FalseFact> contradicted; // by function; of any run so far
    };
    const Findings& findings() const { return noted; }

    // Of a function's text, by Value::index.
    struct Structure {
        std::vector<const Instruction*> makers;               // null: a parameter
        std::vector<bool> is_part_of_result;                  // and not only compared
        std::unordered_map<uint32_t, Polynomial> polynomials; // what is one of values that stand in it twice

        const Polynomial* polynomial_of(Value value) const
        {
            const auto found = polynomials.find(value.index);
            return found == polynomials.end() ? nullptr : &found->second;
        }
    };
    // Of one evaluation of it, likewise.
    struct Frame {
        const Function& function;
        std::vector<Interval> values;
        std::vector<Variation> variations; // or empty
        const Structure& structure;
        const Activity& tangents; // which values have one
        const std::vector<const Instruction*>& makers = structure.makers;
    };

private:
    static constexpr uint32_t depth_max = 1000; // beyond, nothing is known: recursion stays bounded

    const Module& module;
    const uint64_t limit;
    uint64_t left = 0, of_calls = 0;
    uint32_t depth = 0; // blocks and calls inside each other
    bool varying = false, with_curvature = true;
    PartialRules rules;
    std::optional<Seams> seams; // where the class is asked for
    uint32_t kinks = 0;         // numbered as they are met
    bool is_trying = false;     // arms are evaluated where they meet
    bool is_compared = false;   // inside a call whose results are only compared
    std::optional<Span> user;   // the call, while inside the library
    Findings noted;
    const BoundsBox* box = nullptr;
    std::map<uint32_t, CellRanges> of_cells; // by table; made when first read
    std::vector<Structure> structures;       // by function; filled when first needed

    Dependences dependences;
    std::vector<std::map<std::vector<bool>, Activity>> activities; // by function and which parameters have tangents
    const Activity no_tangents{0, 0};
    // Memory of calls that are done, and of operands: calls and operations are many, and short.
    std::vector<Results> spare;
    std::array<Variation, operands_max> operand_variations;

    std::map<uint32_t, bool> short_functions; // asked so far

    const Structure& structure_of(uint32_t function);
    bool is_short(uint32_t function);
    const Activity& tangents_of(uint32_t function, std::span<const Variation> arguments);
    // Arguments and results of calls, carried values of loops, yields of arms.
    Results gather(const Frame& frame, std::span<const Value> values, Results memory = {}) const;
    Results take_spare();
    void store(Frame& frame, std::span<const Value> values, const Results& results);
    void join_into(Results& all, const Results& other) const;
    Results unknown(const Function& function, std::span<const Value> values, Span cause);
    void note_fault(const Instruction& made, Op op, std::span<const Interval> operands, Undefined::Why why);
    void note(const Undefined& place);
    // What the operands say together.
    static bool is_guarded_division(const Frame& frame, const Instruction& made, Op op);
    static Interval sharpened(const Frame& frame, const Instruction& made, Op op, const Interval& result);

    Results call(uint32_t function, const Results& arguments, Span span);
    Results call_beside_nan(uint32_t function, const Results& arguments, Span span);
    void pass_faults(uint32_t function, const Results& arguments, Results& results);
    Results look_inside(uint32_t function, const Results& arguments, Span span);
    std::vector<Interval> values_inside(uint32_t function, std::vector<Interval> arguments, Span span);
    Results by_other_arguments(uint32_t function, const Results& arguments, Span span);
    void sharpen_by_slope(uint32_t function, const Results& arguments, double reach, Results& results);
    Variation variation_of(Frame& frame, const Instruction& made, Op op, std::span<const Interval> operands,
                           const Interval& result);
    Interval of_image(Op op, std::span<const Interval> operands) const;
    Partials spline_partials(std::span<const Interval> operands) const;
    std::vector<Seams::Operand> seam_operands(const Frame& frame, std::span<const Value> values);
    void cross_call(const Function& function, uint32_t index, const Results& arguments, Results& results, Span span);
    void block(Frame& frame, const Block& block);
    std::vector<Continuity> meeting(Frame& frame, const Instruction& made, const If& choice, const Results& joined);
    void choose(Frame& frame, const Instruction& made, const If& choice, const Results (&arms)[2], Results& all);
    // Arms that cannot be entered give no values at all.
    Results arm(Frame& frame, const Block& block, Value condition, bool taken, Span span);

    void visit(Frame& frame, const Instruction& made, const Operation& kind);
    void visit(Frame& frame, const Instruction& made, const RealConstant& kind);
    void visit(Frame& frame, const Instruction& made, const WordConstant& kind);
    void visit(Frame& frame, const Instruction& made, const ReadInput& kind);
    void visit(Frame& frame, const Instruction& made, const ReadParameter& kind);
    void visit(Frame& frame, const Instruction& made, const ReadTable& kind);
    void visit(Frame& frame, const Instruction& made, const Call& kind);
    void visit(Frame& frame, const Instruction& made, const PointDerivative& kind);
    void visit(Frame& frame, const Instruction& made, const If& kind);
    void visit(Frame& frame, const Instruction& made, const For& kind);
};

} // namespace haptel::ir
