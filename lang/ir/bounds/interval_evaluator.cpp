#include "lang/ir/bounds/interval_evaluator.h"

#include "lang/ir/bounds/continuity.h"
#include "lang/ir/op_info.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace haptel::ir {
namespace {

Interval integer(Type type, uint32_t bits)
{
    double value = type == Type::i32 ? static_cast<double>(static_cast<int32_t>(bits)) : static_cast<double>(bits);
    return {value, value};
}

// Inputs move with p by their Jacobian, of which only bounds are known, and of its own change nothing.
Variation carried_along(const BoundsBox& box, Input first_partial, Span span)
{
    Variation variation = unknown_variation(span);
    variation.continuity = Continuity::smooth;
    variation.may_fault = false;
    double squares = 0;
    for (size_t j = 0; j < Variation::directions; ++j) {
        const Interval& partial = box.input[static_cast<size_t>(first_partial) + j];
        variation.gradient[j] = partial;
        const double size = size_of(partial);
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
    : module(whole)
    , limit(operations)
    , of_cells(whole.tables.size())
    , structures(whole.functions.size())
    , dependences(whole)
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

IntervalEvaluator::Results IntervalEvaluator::run_varying(uint32_t entry, const BoundsBox& where, bool with_class)
{
    box = &where;
    left = limit;
    depth = 0;
    varying = true;
    is_compared = false;
    seams.reset();
    if (with_class) seams.emplace();
    kinks = 0;
    user.reset();
    undefined_operations.clear();
    believed_functions.clear();
    Results results = look_inside(entry, {}, {});
    for (Variation& variation : results.variations) variation = settled(std::move(variation));
    return results;
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
    return {std::vector<Interval>(count, no_value), {}};
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

// What depends on an undecided choice that depends on the point jumps with it.
void IntervalEvaluator::roughen_all(Results& results, const Variation& by, Span where) const
{
    if (!by.is_active) return;
    for (Variation& variation : results.variations) {
        variation.is_active = true;
        variation.kink = 0;
        if (by.continuity <= Continuity::jump) roughen(variation, by.continuity, {where, {}});
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
    const bool is_part = frame.structure.is_part_of_result[made.results[0].index];
    if (varying && is_part) note_undefined(made, operation.op, all, result);
    result = sharpened(frame, made, operation.op, result);
    frame.values[made.results[0].index] = result;
    if (!varying) return;
    Variation variation = variation_of(frame, made, operation.op, all, result);
    if (seams && variation.number == ValueNumbers::none)
        seams->cross(operation.op, seam_operands(frame, made.operands), result, variation);
    if (operation.op == Op::select) variation = chosen_at(std::move(variation), made.span);
    frame.variations[made.results[0].index] = std::move(variation);
}

void IntervalEvaluator::visit(Frame& frame, const Instruction& made, const RealConstant& constant)
{
    if (varying && !is_trying && !std::isfinite(constant.value)) note({{}, {}, {}, made.span});
    frame.values[made.results[0].index] =
        std::isnan(constant.value) ? Interval{infinity, -infinity, true} : Interval{constant.value, constant.value};
}

void IntervalEvaluator::visit(Frame& frame, const Instruction& made, const WordConstant& constant)
{
    Value result = made.results[0];
    frame.values[result.index] = integer(frame.function.type(result), constant.bits);
}

void IntervalEvaluator::visit(Frame& frame, const Instruction& made, const ReadInput& read)
{
    const Interval value = box ? box->input[static_cast<size_t>(read.input)] : everything(Type::real);
    store(frame, made.results[0], value, varying ? variation_of_input(*box, read.input, made.span) : Variation{});
    if (varying && seams)
        frame.variations[made.results[0].index].number =
            seams->numbers.of(ValueNumbers::Other::input, static_cast<uint64_t>(read.input), {});
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
    if (varying && seams)
        frame.variations[made.results[0].index].number =
            seams->numbers.of(ValueNumbers::Other::parameter, read.parameter, {});
}

void IntervalEvaluator::visit(Frame& frame, const Instruction& made, const ReadTable& read)
{
    const Table& table = module.tables[read.table];
    const auto cells = [&](const Interval& index) {
        const double last = table.size() - 1.0;
        const auto first_cell = static_cast<size_t>(std::clamp(index.minimum, 0.0, last));
        const auto last_cell = static_cast<size_t>(std::clamp(index.maximum, 0.0, last));
        if (!of_cells[read.table]) of_cells[read.table].emplace(table);
        return of_cells[read.table]->over(first_cell, last_cell);
    };
    const Interval& index = frame.values[made.operands[0].index];
    const Interval all = cells(index);
    frame.values[made.results[0].index] = all;
    if (!varying) return;
    Variation& variation = frame.variations[made.results[0].index];
    const Variation& of_index = frame.variations[made.operands[0].index];
    variation = {};
    variation.is_active = of_index.is_active && !index.is_point();
    if (variation.is_active) roughen(variation, of_index.continuity, {made.span, {}});
    if (seams)
        seams->cross(
            seam_operands(frame, made.operands), all,
            [&](auto parts) { return seams->numbers.of(ValueNumbers::Other::table, read.table, parts); },
            [&](auto values) { return cells(values[0]); }, [](auto, bool) { return std::nullopt; }, variation);
}

void IntervalEvaluator::visit(Frame& frame, const Instruction& made, const Call& callee)
{
    const Results arguments = gather(frame, made.operands);
    const auto is_part = [&](Value result) { return frame.structure.is_part_of_result[result.index]; };
    const bool is_whole = std::any_of(made.results.begin(), made.results.end(), is_part);
    const bool was_compared = std::exchange(is_compared, is_compared || !is_whole);
    Results results = call(callee.function, arguments, made.span);
    is_compared = was_compared;
    if (varying) pass_faults(callee.function, arguments, results);
    for (Variation& variation : results.variations) // what is made by the compiler has no place
        if (variation.continuity != Continuity::smooth && variation.cause.span.end == 0)
            variation.cause = {made.span, {}, module.functions[callee.function].is_library};
    store(frame, made.results, results);
}

void IntervalEvaluator::visit(Frame& frame, const Instruction& made, const PointDerivative&)
{
    store(frame, made.results[0], everything(Type::real), unknown_variation(made.span)); // in no verified program
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
        if (!trips.is_point()) {
            Variation by = frame.variations[made.operands[0].index];
            by.continuity = std::min(by.continuity, Continuity::jump);
            roughen_all(all, by, made.span);
        }
    }
    store(frame, made.results, all);
}

} // namespace haptel::ir
