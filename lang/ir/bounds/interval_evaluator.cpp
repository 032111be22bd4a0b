#include "lang/ir/bounds/interval_evaluator.h"

#include "lang/ir/bounds/smoothness.h"
#include "lang/ir/op_info.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace haptel::ir {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr uint32_t depth_max = 1000; // beyond, nothing is known: recursion stays bounded
constexpr Interval nothing{infinity, -infinity, false};

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

// One of the two is 0, always.
bool is_zero_side(std::span<const Interval> operands)
{
    return std::any_of(operands.begin(), operands.end(),
                       [](const Interval& operand) { return operand.minimum == 0 && operand.maximum == 0; });
}

// Inputs move with p by their Jacobian, of which only bounds are known, and of its own change nothing.
Variation carried_along(const BoundsBox& box, Input first_partial, Span span)
{
    Variation variation = unknown_variation(span);
    variation.smoothness = Smoothness::smooth;
    variation.may_fault = false;
    double squares = 0;
    for (size_t j = 0; j < Variation::directions; ++j) {
        const Interval& partial = box.input[static_cast<size_t>(first_partial) + j];
        variation.gradient[j] = partial;
        const double size = std::max(std::fabs(partial.minimum), std::fabs(partial.maximum));
        squares += size * size;
    }
    variation.slope = std::sqrt(squares) * (1 + 1e-14);
    return variation;
}

Variation variation_of_input(const BoundsBox& box, Input input, Span span)
{
    const auto from = [&](Input first, Input partials, uint32_t stride) {
        const auto component = static_cast<uint32_t>(input) - static_cast<uint32_t>(first);
        return carried_along(box, static_cast<Input>(static_cast<uint32_t>(partials) + stride * component), span);
    };
    if (input <= Input::p_z) return axis(static_cast<size_t>(input));
    if (input <= Input::n_z) {
        Variation normal = from(Input::n_x, Input::n_dp_00, 3);
        normal.slope = std::min(normal.slope, box.normal_turn_max_per_m);
        return normal;
    }
    if (input <= Input::uv_y) {
        Variation coordinate = from(Input::uv_x, Input::uv_dp_00, 3);
        coordinate.slope = std::min(coordinate.slope, box.uv_slope_max_per_m[input == Input::uv_y]);
        return coordinate;
    }
    return {};
}

} // namespace

IntervalEvaluator::IntervalEvaluator(const Module& whole, uint64_t operations)
    : module(whole), limit(operations), makers(whole.functions.size()), dependences(whole)
{
}

std::vector<Interval> IntervalEvaluator::run(uint32_t function, std::span<const Interval> arguments,
                                             const BoundsBox* where)
{
    box = where;
    left = limit;
    depth = 0;
    varying = false;
    return look_inside(function, {{arguments.begin(), arguments.end()}, {}}, {}).values;
}

IntervalEvaluator::Results IntervalEvaluator::run_varying(uint32_t entry, const BoundsBox& where)
{
    box = &where;
    left = limit;
    depth = 0;
    varying = true;
    kinks = 0;
    user.reset();
    undefined_operations.clear();
    believed_functions.clear();
    return look_inside(entry, {}, {});
}

// ---- several values at once

IntervalEvaluator::Results IntervalEvaluator::gather(const Frame& frame, std::span<const Value> values) const
{
    Results results;
    for (Value value : values) results.values.push_back(frame.values[value.index]);
    if (varying)
        for (Value value : values) results.variations.push_back(variation_at(frame, value));
    return results;
}

Variation IntervalEvaluator::variation_at(const Frame& frame, Value value) const
{
    Variation variation = frame.variations[value.index];
    variation.has_tangent = frame.has_tangent[value.index];
    return variation;
}

void IntervalEvaluator::store(Frame& frame, Value value, const Interval& interval, const Variation& variation)
{
    frame.values[value.index] = interval;
    if (varying) frame.variations[value.index] = variation;
}

void IntervalEvaluator::store(Frame& frame, std::span<const Value> values, const Results& results)
{
    for (size_t i = 0; i < values.size(); ++i) frame.values[values[i].index] = results.values[i];
    if (!varying) return;
    for (size_t i = 0; i < values.size(); ++i) frame.variations[values[i].index] = results.variations[i];
}

IntervalEvaluator::Results IntervalEvaluator::nothing_yet(size_t count) const
{
    return {std::vector<Interval>(count, nothing), {}};
}

// Without variations `all` has nothing joined to it yet.
void IntervalEvaluator::join_into(Results& all, const Results& other) const
{
    for (size_t i = 0; i < other.values.size(); ++i) all.values[i] = join(all.values[i], other.values[i]);
    if (!varying) return;
    if (all.variations.empty()) {
        all.variations = other.variations;
        return;
    }
    for (size_t i = 0; i < other.variations.size(); ++i)
        all.variations[i] = join(all.variations[i], other.variations[i]);
}

IntervalEvaluator::Results IntervalEvaluator::unknown(const Function& function, std::span<const Value> values,
                                                      Span cause)
{
    if (varying && !is_trying) note({{}, Undefined::Why::not_looked_at, {}, cause});
    Results results;
    for (Value value : values) results.values.push_back(everything(function.type(value)));
    if (varying) results.variations.assign(values.size(), unknown_variation(cause));
    return results;
}

// What depends on an undecided choice that depends on the point may jump with it.
void IntervalEvaluator::roughen_all(Results& results, const Variation& by, Span where) const
{
    if (!by.is_active) return;
    for (Variation& variation : results.variations) {
        variation.is_active = true;
        variation.kink = 0;
        roughen(variation, std::min(by.smoothness, Smoothness::jump), {where, {}});
    }
}

// ---- one instruction at a time

void IntervalEvaluator::block(Frame& frame, const Block& source)
{
    // What is left unfinished are loops and calls: a straight line is short, and a clamp at its end bounds all before.
    for (const Instruction& made : source.instructions) {
        left -= std::min<uint64_t>(left, 1);
        std::visit([&](const auto& kind) { visit(frame, made, kind); }, made.kind);
    }
}

void IntervalEvaluator::visit(Frame& frame, const Instruction& made, const Operation& operation)
{
    Interval operands[operands_max];
    for (size_t i = 0; i < made.operands.size(); ++i) operands[i] = frame.values[made.operands[i].index];
    const std::span<const Interval> all{operands, made.operands.size()};
    const bool reads_image = op_info(operation.op).operands[0] == 'm';
    Interval result = reads_image ? of_image(operation.op, all) : evaluate(operation.op, all);
    if (varying) note_undefined(made, operation.op, all, result);
    result = sharpened(frame, made, operation.op, result);
    frame.values[made.results[0].index] = result;
    if (varying) frame.variations[made.results[0].index] = variation_of(frame, made, operation.op, all, result);
}

// Of `a` where only it can be chosen, of both where either can; `by`: what the choice depends on, if on the point.
Variation IntervalEvaluator::chosen(Frame& frame, const Instruction& made, bool first, bool second,
                                    const Variation* by) const
{
    const size_t count = made.operands.size();
    const Variation& a = frame.variations[made.operands[count - 2].index];
    const Variation& b = frame.variations[made.operands[count - 1].index];
    Results either{{}, {first && second ? join(a, b) : first ? a : b}};
    if (by && first && second) roughen_all(either, *by, made.span);
    return either.variations[0];
}

Variation IntervalEvaluator::variation_of(Frame& frame, const Instruction& made, Op op,
                                          std::span<const Interval> operands, const Interval& result)
{
    Variation variations[operands_max];
    uint32_t active = 0, differentiated = 0; // the code does not know what these intervals know, and takes part in more
    for (size_t i = 0; i < operands.size(); ++i) {
        variations[i] = variation_at(frame, made.operands[i]);
        if (variations[i].is_active) active |= 1u << i;
        if (variations[i].is_active || variations[i].has_tangent) differentiated |= 1u << i;
    }
    if (differentiated == 0) return {};
    left -= std::min<uint64_t>(left, 3); // what it costs more than a value alone
    const Interval& a = operands[0];
    if (op == Op::select) {
        Variation either = chosen(frame, made, a.contains(1), a.contains(0), &variations[0]);
        if (is_guarded_division(frame, made, op)) {
            either.may_fault = variations[1].may_fault;
            for (Value part : frame.makers[made.operands[2].index]->operands)
                either.may_fault |= frame.variations[part.index].may_fault;
        }
        return either;
    }

    Variation variation;
    Partials partials{};
    if (op == Op::min || op == Op::max) {
        const Interval& b = operands[1];
        const bool a_can = op == Op::min ? a.minimum <= b.maximum : a.maximum >= b.minimum;
        const bool b_can = op == Op::min ? b.minimum <= a.maximum : b.maximum >= a.minimum;
        variation = chosen(frame, made, a_can || !b_can, b_can, nullptr);
        if (a.may_be_nan || b.may_be_nan) // which counts as a tie: the mean of both
            variation.may_fault |= variations[0].may_fault || variations[1].may_fault;
    } else {
        const OpInfo& info = op_info(op);
        const bool of_reals = info.result == 'r' && info.operands.find_first_not_of('r') == std::string_view::npos;
        if (op == Op::spline)
            partials = spline_partials(operands);
        else if (of_reals)
            partials = rules.of(op, operands, differentiated, true);
        variation = chain(op, operands, {variations, operands.size()}, partials, of_reals || op == Op::spline);
        const auto may_fault = [](const Variation& operand) { return operand.may_fault; };
        const bool is_new = std::none_of(variations, variations + operands.size(), may_fault);
        if (variation.may_fault && is_new) note_derivative(made, op, operands, result);
    }
    if (!variation.is_active) return variation;
    if (op == Op::detach) { // the gradient that is returned is another function's, which may bend anyhow
        variation.curvature = infinity;
        variation.hessian.fill({-infinity, infinity});
    }
    const Smoothness own = smoothness_of(op, operands, active, result, partials);
    const bool was_smooth = variation.smoothness == Smoothness::smooth;
    if (own != Smoothness::smooth) variation.wrap = wrap_made_by(op, operands, variations[0]);
    roughen(variation, own, {made.span, op});
    if (own != Smoothness::smooth && variation.kink != 0) variation.kink = 0;
    const bool at_zero = op == Op::abs || is_length(op) || ((op == Op::min || op == Op::max) && is_zero_side(operands));
    if (own == Smoothness::c0 && was_smooth && at_zero) variation.kink = ++kinks, variation.kink_power = 1;
    return variation;
}

void IntervalEvaluator::visit(Frame& frame, const Instruction& made, const RealConstant& constant)
{
    if (varying && !is_trying && !std::isfinite(constant.value)) note({{}, {}, {}, made.span});
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
    const Interval value = box ? box->input[static_cast<size_t>(read.input)] : everything(Type::real);
    store(frame, made.results[0], value, varying ? variation_of_input(*box, read.input, made.span) : Variation{});
}

void IntervalEvaluator::visit(Frame& frame, const Instruction& made, const ReadParameter& read)
{
    if (frame.function.type(made.results[0]) == Type::image) {
        const double index = read.parameter;
        frame.values[made.results[0].index] = {index, index};
        return;
    }
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
    if (!varying) return;
    Variation& variation = frame.variations[made.results[0].index];
    const Variation& of_index = frame.variations[made.operands[0].index];
    variation.is_active = of_index.is_active && first_cell != last_cell;
    if (variation.is_active) roughen(variation, std::min(of_index.smoothness, Smoothness::jump), {made.span, {}});
}

void IntervalEvaluator::visit(Frame& frame, const Instruction& made, const Call& callee)
{
    const Results arguments = gather(frame, made.operands);
    Results results = call(callee.function, arguments, made.span);
    if (varying) pass_faults(callee.function, arguments, results);
    store(frame, made.results, results);
}

void IntervalEvaluator::visit(Frame& frame, const Instruction& made, const PointDerivative&)
{
    store(frame, made.results[0], everything(Type::real), unknown_variation(made.span)); // in no verified program
}

void IntervalEvaluator::visit(Frame& frame, const Instruction& made, const If& choice)
{
    const Interval condition = frame.values[made.operands[0].index];
    Results all = nothing_yet(made.results.size());
    for (bool taken : {true, false}) {
        if (!condition.contains(taken ? 1 : 0)) continue;
        const Results yields = arm(frame, choice.arms[taken ? 0 : 1], made.operands[0], taken, made.span);
        if (!yields.values.empty()) join_into(all, yields);
    }
    const Variation* by = varying ? &frame.variations[made.operands[0].index] : nullptr;
    if (by) all.variations.resize(made.results.size());
    if (by && by->is_active && !condition.is_point()) {
        const std::vector<Smoothness> meets = meeting(frame, made, choice, all);
        for (size_t i = 0; i < meets.size(); ++i) {
            all.variations[i].is_active = true;
            all.variations[i].kink = 0;
            roughen(all.variations[i], meets[i], {made.span, {}});
        }
    }
    store(frame, made.results, all);
}

IntervalEvaluator::Results IntervalEvaluator::arm(Frame& frame, const Block& source, Value condition, bool taken,
                                                  Span span)
{
    if (depth >= depth_max) return unknown(frame.function, source.yields, span);
    ++depth;
    Results results;
    std::vector<Narrowed> undo;
    if (narrow(frame, condition, taken, undo)) {
        block(frame, source);
        results = gather(frame, source.yields);
    }
    for (auto narrowed = undo.rbegin(); narrowed != undo.rend(); ++narrowed)
        frame.values[narrowed->value.index] = narrowed->before;
    --depth;
    return results;
}

void IntervalEvaluator::visit(Frame& frame, const Instruction& made, const For& loop)
{
    const Block& body = loop.body[0];
    const Interval trips = frame.values[made.operands[0].index];
    const std::span<const Value> parameters(body.parameters);
    Results carried = gather(frame, std::span(made.operands).subspan(1)), all = nothing_yet(made.results.size());
    ++depth;
    for (double trip = 0;; ++trip) {
        if (trip >= trips.minimum) join_into(all, carried);
        if (trip >= trips.maximum || left == 0 || depth >= depth_max) break;
        --left;
        store(frame, parameters[0], {trip, trip}, {});
        store(frame, parameters.subspan(1), carried);
        block(frame, body);
        carried = gather(frame, body.yields);
    }
    if (depth >= depth_max || left == 0) all = unknown(frame.function, made.results, made.span);
    --depth;
    if (varying) {
        all.variations.resize(made.results.size());
        if (!trips.is_point()) roughen_all(all, frame.variations[made.operands[0].index], made.span);
    }
    store(frame, made.results, all);
}

} // namespace haptel::ir
