#include "lang/ir/interval_evaluator.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace haptel::ir {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr uint32_t depth_max = 1000; // beyond, nothing is known: recursion stays bounded
constexpr Interval nothing{infinity, -infinity, false};

void collect_makers(const Block& block, std::vector<const Instruction*>& makers)
{
    for (const Instruction& made : block.instructions) {
        for (Value result : made.results) makers[result.index] = &made;
        if (auto* choice = std::get_if<If>(&made.kind))
            for (const Block& arm : choice->arms) collect_makers(arm, makers);
        if (auto* loop = std::get_if<For>(&made.kind)) collect_makers(loop->body[0], makers);
    }
}

std::vector<Interval> unknown_results(const Function& function)
{
    std::vector<Interval> results;
    for (Value result : function.body.yields) results.push_back(everything(function.type(result)));
    return results;
}

Interval integer(Type type, uint32_t bits)
{
    double value = type == Type::i32 ? static_cast<double>(static_cast<int32_t>(bits)) : static_cast<double>(bits);
    return {value, value};
}

Interval cell(const Table& table, size_t index)
{
    if (table.element == Type::real)
        return std::isnan(table.reals[index]) ? Interval{infinity, -infinity, true}
                                              : Interval{table.reals[index], table.reals[index]};
    uint32_t word = table.words[index];
    return integer(table.element, word);
}

} // namespace

IntervalEvaluator::IntervalEvaluator(const Module& whole, uint64_t operations)
    : module(whole), limit(operations), makers(whole.functions.size())
{
}

std::vector<Interval> IntervalEvaluator::run(uint32_t function, std::span<const Interval> arguments,
                                             const BoundsBox* where)
{
    box = where;
    left = limit;
    depth = 0;
    return look_inside(function, arguments);
}

const std::vector<const Instruction*>& IntervalEvaluator::makers_of(uint32_t function)
{
    std::vector<const Instruction*>& known = makers[function];
    if (known.empty()) {
        known.resize(module.functions[function].value_types.size() + 1);
        collect_makers(module.functions[function].body, known);
    }
    return known;
}

std::vector<Interval> IntervalEvaluator::look_inside(uint32_t index, std::span<const Interval> arguments)
{
    const Function& function = module.functions[index];
    if (depth >= depth_max || left == 0) return unknown_results(function);
    ++depth;
    Frame frame{function, std::vector<Interval>(function.value_types.size(), nothing), makers_of(index)};
    for (size_t i = 0; i < arguments.size(); ++i) frame.values[function.parameters[i].index] = arguments[i];
    block(frame, function.body);
    --depth;
    if (left == 0) return unknown_results(function);
    std::vector<Interval> results;
    for (Value result : function.body.yields) results.push_back(frame.values[result.index]);
    return results;
}

// Facts speak of arguments that are numbers, and of the first result only. An argument without bounds counts as some
// number; what comes of an infinite one is left open, as NaN is.
std::vector<Interval> IntervalEvaluator::call(uint32_t index, std::span<const Interval> arguments)
{
    const Function& function = module.functions[index];
    const Facts& facts = function.facts;
    bool may_be_nan = false, are_finite = true;
    for (const Interval& argument : arguments) {
        may_be_nan |= argument.may_be_nan || argument.is_empty();
        are_finite &= argument.is_finite();
    }
    const bool has_value = facts.value_minimum && facts.value_maximum;
    if (may_be_nan || (!has_value && !facts.slope)) return look_inside(index, arguments);

    Interval declared{-infinity, infinity, true};
    if (has_value) declared = {*facts.value_minimum, *facts.value_maximum, !are_finite};
    std::optional<Interval> near = by_slope(index, arguments, (declared.maximum - declared.minimum) / 2);
    // Where the slope says nothing, a box is too wide for natural evaluation to say more than the facts do.
    const bool is_wide = has_value && facts.slope && !near && function.body.yields.size() == 1;
    if (is_wide) return {declared};
    std::vector<Interval> results = look_inside(index, arguments);
    results[0] = intersect(results[0], declared);
    if (near) results[0] = intersect(results[0], *near);
    return results;
}

// |f(x) - f(middle)| <= slope |x - middle|.
std::optional<Interval> IntervalEvaluator::by_slope(uint32_t index, std::span<const Interval> arguments,
                                                    double useful_radius)
{
    const Function& function = module.functions[index];
    if (!function.facts.slope) return std::nullopt;
    std::vector<Interval> middle(arguments.begin(), arguments.end());
    double square = 0;
    for (uint32_t i = 0; i < function.first_argument_size; ++i) {
        double at = arguments[i].minimum / 2 + arguments[i].maximum / 2;
        double reach = std::max(arguments[i].maximum - at, at - arguments[i].minimum);
        square += reach * reach;
        middle[i] = {at, at};
    }
    const double change = *function.facts.slope * std::sqrt(square) * (1 + 1e-14);
    if (!(change < useful_radius) || change == 0) return std::nullopt;
    Interval there = look_inside(index, middle)[0];
    const Interval by[] = {there, {-change, change}};
    return evaluate(Op::add, by);
}

void IntervalEvaluator::block(Frame& frame, const Block& source)
{
    for (const Instruction& made : source.instructions) {
        if (left == 0) return;
        --left;
        std::visit([&](const auto& kind) { visit(frame, made, kind); }, made.kind);
    }
}

void IntervalEvaluator::visit(Frame& frame, const Instruction& made, const Operation& operation)
{
    Interval operands[4];
    for (size_t i = 0; i < made.operands.size(); ++i) operands[i] = frame.values[made.operands[i].index];
    frame.values[made.results[0].index] = evaluate(operation.op, {operands, made.operands.size()});
    // x * x is a square
    if (operation.op == Op::mul && made.operands[0] == made.operands[1]) {
        Interval& square = frame.values[made.results[0].index];
        square.minimum = std::max(square.minimum, 0.0);
    }
}

void IntervalEvaluator::visit(Frame& frame, const Instruction& made, const RealConstant& constant)
{
    frame.values[made.results[0].index] =
        std::isnan(constant.value) ? Interval{infinity, -infinity, true} : Interval{constant.value, constant.value};
}

void IntervalEvaluator::visit(Frame& frame, const Instruction& made, const IntConstant& constant)
{
    Value result = made.results[0];
    frame.values[result.index] = integer(frame.function.type(result), constant.bits);
}

void IntervalEvaluator::visit(Frame& frame, const Instruction& made, const BoolConstant& constant)
{
    frame.values[made.results[0].index] = {constant.value ? 1.0 : 0.0, constant.value ? 1.0 : 0.0};
}

void IntervalEvaluator::visit(Frame& frame, const Instruction& made, const ReadInput& read)
{
    frame.values[made.results[0].index] = box ? box->input[static_cast<size_t>(read.input)] : everything(Type::real);
}

void IntervalEvaluator::visit(Frame& frame, const Instruction& made, const ReadParameter& read)
{
    frame.values[made.results[0].index] = box && read.parameter < box->parameters.size()
                                              ? box->parameters[read.parameter]
                                              : everything(frame.function.type(made.results[0]));
}

void IntervalEvaluator::visit(Frame& frame, const Instruction& made, const ReadTable& read)
{
    const Table& table = module.tables[read.table];
    const Interval& index = frame.values[made.operands[0].index];
    const double last = table.size() - 1.0;
    Interval all = nothing;
    auto first_cell = static_cast<size_t>(std::clamp(index.minimum, 0.0, last));
    auto last_cell = static_cast<size_t>(std::clamp(index.maximum, 0.0, last));
    for (size_t i = first_cell; i <= last_cell; ++i) all = join(all, cell(table, i));
    left -= std::min<uint64_t>(left, (last_cell - first_cell) / 16);
    frame.values[made.results[0].index] = all;
}

void IntervalEvaluator::visit(Frame& frame, const Instruction& made, const Call& callee)
{
    std::vector<Interval> arguments;
    for (Value operand : made.operands) arguments.push_back(frame.values[operand.index]);
    std::vector<Interval> results = call(callee.function, arguments);
    for (size_t i = 0; i < results.size(); ++i) frame.values[made.results[i].index] = results[i];
}

void IntervalEvaluator::visit(Frame& frame, const Instruction& made, const PointDerivative&)
{
    frame.values[made.results[0].index] = everything(Type::real); // in no program that passes `verify`
}

void IntervalEvaluator::visit(Frame& frame, const Instruction& made, const If& choice)
{
    const Interval condition = frame.values[made.operands[0].index];
    std::vector<Interval> results(made.results.size(), nothing);
    for (bool taken : {true, false}) {
        if (!condition.contains(taken ? 1 : 0)) continue;
        std::vector<Interval> yields = arm(frame, choice.arms[taken ? 0 : 1], made.operands[0], taken);
        for (size_t i = 0; i < yields.size(); ++i) results[i] = join(results[i], yields[i]);
    }
    for (size_t i = 0; i < results.size(); ++i) frame.values[made.results[i].index] = results[i];
}

std::vector<Interval> IntervalEvaluator::arm(Frame& frame, const Block& source, Value condition, bool taken)
{
    std::vector<Interval> results;
    if (depth >= depth_max) {
        for (Value yield : source.yields) results.push_back(everything(frame.function.type(yield)));
        return results;
    }
    ++depth;
    std::vector<Narrowed> undo;
    if (narrow(frame, condition, taken, undo)) {
        block(frame, source);
        for (Value yield : source.yields) results.push_back(frame.values[yield.index]);
    }
    for (auto narrowed = undo.rbegin(); narrowed != undo.rend(); ++narrowed)
        frame.values[narrowed->value.index] = narrowed->before;
    --depth;
    return results;
}

// Shrinks what the condition compares to the values for which it is as `taken` says; false if there are none.
bool IntervalEvaluator::narrow(Frame& frame, Value condition, bool taken, std::vector<Narrowed>& undo)
{
    std::vector<std::pair<Value, bool>> open{{condition, taken}};
    while (!open.empty()) {
        auto [value, wanted] = open.back();
        open.pop_back();
        const Instruction* made = frame.makers[value.index];
        auto* operation = made ? std::get_if<Operation>(&made->kind) : nullptr;
        if (!operation) continue;
        if (operation->op == Op::lnot) open.emplace_back(made->operands[0], !wanted);
        if (operation->op == (wanted ? Op::land : Op::lor))
            for (Value part : made->operands) open.emplace_back(part, wanted);
        if (!narrow_comparison(frame, *made, wanted, undo)) return false;
    }
    return true;
}

bool IntervalEvaluator::narrow_comparison(Frame& frame, const Instruction& made, bool taken,
                                          std::vector<Narrowed>& undo)
{
    const Op op = std::get<Operation>(made.kind).op;
    const bool is_less = op == Op::lt || op == Op::ilt || op == Op::ult;
    const bool is_less_or_equal = op == Op::le || op == Op::ile || op == Op::ule;
    const bool is_equal = op == Op::eq || op == Op::ieq || op == Op::ueq;
    if (!is_less && !is_less_or_equal && !is_equal) return true;
    const Interval a = frame.values[made.operands[0].index], b = frame.values[made.operands[1].index];
    // A comparison with NaN is false, which then says nothing of the other operand.
    if (!taken && (is_equal || a.may_be_nan || b.may_be_nan)) return true;

    Interval narrow_a = a, narrow_b = b;
    if (taken) narrow_a.may_be_nan = narrow_b.may_be_nan = false;
    const bool a_is_below = taken, both = is_equal;
    if (a_is_below || both) {
        narrow_a.maximum = std::min(a.maximum, b.maximum);
        narrow_b.minimum = std::max(a.minimum, b.minimum);
    }
    if (!a_is_below || both) {
        narrow_a.minimum = std::max(a.minimum, b.minimum);
        narrow_b.maximum = std::min(a.maximum, b.maximum);
    }
    undo.push_back({made.operands[0], a});
    undo.push_back({made.operands[1], b});
    frame.values[made.operands[0].index] = narrow_a;
    frame.values[made.operands[1].index] = narrow_b;
    return !narrow_a.is_empty() && !narrow_b.is_empty();
}

void IntervalEvaluator::visit(Frame& frame, const Instruction& made, const For& loop)
{
    const Block& body = loop.body[0];
    const Interval trips = frame.values[made.operands[0].index];
    std::vector<Interval> carried, results(made.results.size(), nothing);
    for (size_t i = 1; i < made.operands.size(); ++i) carried.push_back(frame.values[made.operands[i].index]);
    ++depth;
    for (double trip = 0;; ++trip) {
        if (trip >= trips.minimum)
            for (size_t i = 0; i < results.size(); ++i) results[i] = join(results[i], carried[i]);
        if (trip >= trips.maximum || left == 0 || depth >= depth_max) break;
        --left;
        frame.values[body.parameters[0].index] = {trip, trip};
        for (size_t i = 0; i < carried.size(); ++i) frame.values[body.parameters[i + 1].index] = carried[i];
        block(frame, body);
        for (size_t i = 0; i < carried.size(); ++i) carried[i] = frame.values[body.yields[i].index];
    }
    if (depth >= depth_max)
        for (size_t i = 0; i < results.size(); ++i) results[i] = everything(frame.function.type(made.results[i]));
    --depth;
    for (size_t i = 0; i < results.size(); ++i) frame.values[made.results[i].index] = results[i];
}

} // namespace haptel::ir
