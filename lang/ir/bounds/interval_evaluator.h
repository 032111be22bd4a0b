// One interval evaluation of a function and everything it calls; where asked for, with bounds of its derivatives.
//
// interval_evaluator.cpp walks blocks, interval_variation.cpp knows how operations vary, interval_choice.cpp `if`s,
// interval_call.cpp calls and facts, interval_narrow.cpp conditions.
#pragma once

#include "lang/ir/bounds/bounds.h"
#include "lang/ir/bounds/cell_ranges.h"
#include "lang/ir/bounds/seams.h"
#include "lang/ir/derive/activity.h"

#include <map>
#include <optional>
#include <set>

namespace haptel::ir {

class IntervalEvaluator {
public:
    // `operations` that one evaluation may execute: a result that needs more is unknown.
    IntervalEvaluator(const Module& module, uint64_t operations);

    // `box` may be null for functions that are not entries.
    std::vector<Interval> run(uint32_t function, std::span<const Interval> arguments, const BoundsBox* box);
    uint64_t operations_used() const { return limit - left; }

    // Values, and how each varies with the point. `variations` is empty where they were not asked for.
    struct Results {
        std::vector<Interval> values;
        std::vector<Variation> variations;
    };
    // `with_class`: how smooth results are is looked for, at seams and where arms meet; else they are no smoother than
    // they are said to be.
    Results run_varying(uint32_t entry, const BoundsBox& box, bool with_class);
    // Met by the last run_varying(), each place once.
    const std::vector<Undefined>& undefined() const { return undefined_operations; }
    // Functions whose facts the last run_varying() believed although they are not proven.
    const std::set<uint32_t>& believed() const { return believed_functions; }
    // Facts that are not true, of any run so far.
    const std::map<std::pair<uint32_t, FalseFact::What>, FalseFact>& contradicted() const { return false_facts; }

    // How far a sum of multiples is written out: enough for the edges of a smoothstep.
    static constexpr uint32_t linear_steps_max = 16;
    // By Value::index.
    struct Structure {
        std::vector<const Instruction*> makers; // null: a parameter
        std::vector<bool> has_shared_terms;     // a sum that, written out, names some value twice
        std::vector<bool> is_part_of_result;    // and not only compared
    };

private:
    static constexpr uint32_t depth_max = 1000; // beyond, nothing is known: recursion stays bounded

    struct Frame {
        const Function& function;
        std::vector<Interval> values;      // by Value::index
        std::vector<Variation> variations; // likewise, or empty
        const Structure& structure;
        const std::vector<bool>& has_tangent; // by Value::index; empty where no variations are asked for
        const std::vector<const Instruction*>& makers = structure.makers;
    };
    struct Narrowed {
        Value value;
        Interval before;
    };

    const Module& module;
    const uint64_t limit;
    uint64_t left = 0;
    uint32_t depth = 0; // blocks and calls inside each other
    bool varying = false;
    PartialRules rules;
    std::optional<Seams> seams; // where the class is asked for
    uint32_t kinks = 0;         // numbered as they are met
    bool is_trying = false;     // arms are evaluated where they meet
    bool is_compared = false;   // inside a call whose results are only compared
    std::optional<Span> user;   // the call, while inside the library
    std::vector<Undefined> undefined_operations;
    std::set<uint32_t> believed_functions;
    std::map<std::pair<uint32_t, FalseFact::What>, FalseFact> false_facts; // by function
    const BoundsBox* box = nullptr;
    std::vector<std::optional<CellRanges>> of_cells; // by table; made when first read
    std::vector<Structure> structures;               // by function; filled when first needed

    Dependences dependences;
    // By function and which of its parameters have a tangent: which of its values have.
    std::map<std::pair<uint32_t, std::vector<bool>>, std::vector<bool>> tangents;

    const Structure& structure_of(uint32_t function);
    const std::vector<bool>& tangents_of(uint32_t function, std::span<const Variation> arguments);
    Variation variation_at(const Frame& frame, Value value) const;
    // Arguments and results of calls, carried values of loops, yields of arms.
    Results gather(const Frame& frame, std::span<const Value> values) const;
    void store(Frame& frame, Value value, const Interval& interval, const Variation& variation);
    void store(Frame& frame, std::span<const Value> values, const Results& results);
    Results nothing_yet(size_t count) const;
    void join_into(Results& all, const Results& other) const;
    Results unknown(const Function& function, std::span<const Value> values, Span cause);
    void roughen_all(Results& results, const Variation& by, Span where) const;
    void note_undefined(const Instruction& made, Op op, std::span<const Interval> operands, const Interval& result);
    void note_derivative(const Instruction& made, Op op, std::span<const Interval> operands, const Interval& result);
    void note(const Undefined& found);
    std::optional<Interval> of_linear_sum(const Frame& frame, Value whole) const;
    bool is_guarded_division(const Frame& frame, const Instruction& made, Op op) const;
    Interval sharpened(const Frame& frame, const Instruction& made, Op op, const Interval& result) const;

    Results call(uint32_t function, const Results& arguments, Span span);
    Results call_beside_nan(uint32_t function, const Results& arguments, Span span);
    void pass_faults(uint32_t function, const Results& arguments, Results& results);
    Results look_inside(uint32_t function, const Results& arguments, Span span);
    Variation by_facts(const Function& function, const Facts& facts, const Results& arguments,
                       const Variation* by_others) const;
    Results by_other_arguments(uint32_t function, const Results& arguments, Span span);
    void sharpen_by_slope(uint32_t function, const Results& arguments, double reach, Results& results);
    Variation variation_of(Frame& frame, const Instruction& made, Op op, std::span<const Interval> operands,
                           const Interval& result);
    // Operations of images, in interval_image.cpp.
    Interval of_image(Op op, std::span<const Interval> operands) const;
    Partials spline_partials(std::span<const Interval> operands) const;
    std::vector<Seams::Operand> seam_operands(const Frame& frame, std::span<const Value> values);
    void cross_call(const Function& function, uint32_t index, const Results& arguments, Results& results, Span span);
    Variation chosen(Frame& frame, const Instruction& made, bool first, bool second, const Variation* by) const;
    void block(Frame& frame, const Block& block);
    // How smooth each result of an undecided `if` is where its arms meet: they may meet in value, and in slope.
    std::vector<Continuity> meeting(Frame& frame, const Instruction& made, const If& choice, const Results& joined);
    void choose(Frame& frame, const Instruction& made, const If& choice, const Results (&arms)[2], Results& all);
    // Arms that cannot be entered give no values at all.
    Results arm(Frame& frame, const Block& block, Value condition, bool taken, Span span);
    bool narrow(Frame& frame, Value condition, bool taken, std::vector<Narrowed>& undo);
    bool narrow_comparison(Frame& frame, const Instruction& comparison, bool taken, std::vector<Narrowed>& undo);

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
