#include "lang/ir/bounds/interval_evaluator.h"

#include "lang/ir/op_info.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace haptel::ir {
namespace {

// Normals and mesh coordinates move with p by their Jacobian, of which only bounds are known, and of its own change
// nothing.
Variation variation_of_input(const BoundsBox& box, Input input, Span span)
{
    if (input <= Input::p_z) return axis(static_cast<size_t>(input));
    if (input > Input::uv_y) return {};
    const bool is_normal = input <= Input::n_z;
    const size_t component = static_cast<size_t>(input) - static_cast<size_t>(is_normal ? Input::n_x : Input::uv_x);
    const auto partials = static_cast<size_t>(is_normal ? Input::n_dp_00 : Input::uv_dp_00);
    Variation variation = unknown_variation(span);
    variation.continuity = Continuity::smooth;
    variation.may_fault = false;
    std::copy_n(box.input + partials + component * Variation::directions, Variation::directions,
                variation.gradient.begin());
    variation.slope = is_normal ? box.normal_turn_max_per_m : box.uv_slope_max_per_m[component];
    tighten(variation);
    return variation;
}

} // namespace

IntervalEvaluator::IntervalEvaluator(const Module& whole, uint64_t operations)
    : module(whole)
    , limit(operations)
    , structures(whole.functions.size())
    , dependences(whole)
    , activities(whole.functions.size())
{
}

std::vector<Interval> IntervalEvaluator::run(uint32_t function, std::span<const Interval> arguments,
                                             const BoundsBox* where)
{
    box = where;
    left = limit;
    of_calls = 0;
    return values_inside(function, {arguments.begin(), arguments.end()}, {});
}

IntervalEvaluator::Results IntervalEvaluator::run_varying(uint32_t entry, const BoundsBox& where, Sought sought)
{
    box = &where;
    left = limit;
    of_calls = 0;
    varying = true;
    seams.reset();
    with_curvature = sought >= Sought::curvature;
    if (sought == Sought::continuity) seams.emplace();
    noted.undefined.clear();
    noted.believed.clear();
    Results results = look_inside(entry, {}, {});
    for (Variation& variation : results.variations) variation = settled(std::move(variation));
    return results;
}

// ---- several values at once

IntervalEvaluator::Results IntervalEvaluator::take_spare()
{
    if (spare.empty()) return {};
    Results memory = std::move(spare.back());
    spare.pop_back();
    return memory;
}

IntervalEvaluator::Results IntervalEvaluator::gather(const Frame& frame, std::span<const Value> values,
                                                     Results memory) const
{
    memory.values.resize(values.size());
    memory.variations.resize(varying ? values.size() : 0);
    for (size_t i = 0; i < values.size(); ++i) memory.values[i] = frame.values[values[i].index];
    for (size_t i = 0; i < memory.variations.size(); ++i) {
        memory.variations[i] = frame.variations[values[i].index];
        memory.variations[i].has_tangent = frame.tangents.any(values[i]);
    }
    return memory;
}

void IntervalEvaluator::store(Frame& frame, std::span<const Value> values, const Results& results)
{
    for (size_t i = 0; i < values.size(); ++i) frame.values[values[i].index] = results.values[i];
    for (size_t i = 0; i < results.variations.size(); ++i) frame.variations[values[i].index] = results.variations[i];
}

// Without variations `all` has nothing joined to it yet.
void IntervalEvaluator::join_into(Results& all, const Results& other) const
{
    for (size_t i = 0; i < other.values.size(); ++i) all.values[i] = join(all.values[i], other.values[i]);
    if (all.variations.empty())
        all.variations = other.variations;
    else
        for (size_t i = 0; i < other.variations.size(); ++i)
            all.variations[i] = join(all.variations[i], other.variations[i]);
}

IntervalEvaluator::Results IntervalEvaluator::unknown(const Function& function, std::span<const Value> values,
                                                      Span cause)
{
    note({{}, Undefined::Why::not_looked_at, {}, cause});
    Results results;
    for (Value value : values) results.values.push_back(everything(function.type(value)));
    if (varying) results.variations.assign(values.size(), unknown_variation(cause));
    return results;
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

// The box knows the image of each texture parameter.
Interval IntervalEvaluator::of_image(Op op, std::span<const Interval> operands) const
{
    if (operands[0].minimum < 0 || operands[0].is_empty()) return evaluate(op, operands);
    const ImagePart first = ImagePart::of(operands[0].minimum), last = ImagePart::of(operands[0].maximum);
    if (first.parameter != last.parameter) return evaluate(op, operands);
    const bool is_one_channel = first.channel == last.channel;
    if (op == Op::image_channel || op == Op::image_coarser) {
        const auto part = [&](ImagePart of, double by, int32_t any_level) {
            if (op == Op::image_channel)
                return ImagePart{of.parameter, 1 + static_cast<int32_t>(std::clamp(by, 0.0, 3.0)),
                                 is_one_channel ? of.level : any_level};
            of.level = static_cast<int32_t>(std::clamp(of.level + std::max(by, 0.0), 0.0, ImagePart::levels - 1.0));
            return of;
        };
        return {part(first, operands[1].minimum, 0).number(),
                part(last, operands[1].maximum, ImagePart::levels - 1).number()};
    }
    const bool is_known = box && static_cast<size_t>(first.parameter) < box->images.size();
    const SplineImage* image = is_known ? box->images[static_cast<size_t>(first.parameter)] : nullptr;
    if (!image || (op == Op::spline && !operands[3].is_point())) return evaluate(op, operands);
    const auto of_part = [&](const SplineImage& part) {
        if (op == Op::image_width) return exactly(part.view().width);
        if (op == Op::image_height) return exactly(part.view().height);
        return part.bounds(operands[1], operands[2], static_cast<uint32_t>(operands[3].minimum));
    };
    const int32_t coarsest = std::max(image->view().levels - 1, 0);
    const int32_t from = is_one_channel ? std::min(first.level, coarsest) : 0;
    const int32_t to = is_one_channel ? std::min(last.level, coarsest) : coarsest;
    Interval all = no_value;
    for (int32_t channel = first.channel; channel <= last.channel; ++channel)
        for (int32_t level = from; level <= to; ++level) all = join(all, of_part(image->part(channel, level)));
    return all;
}

void IntervalEvaluator::visit(Frame& frame, const Instruction& made, const Operation& operation)
{
    using Why = Undefined::Why;
    const Op op = operation.op;
    const OpInfo& info = op_info(op);
    Interval operands[operands_max];
    for (size_t i = 0; i < made.operands.size(); ++i) operands[i] = frame.values[made.operands[i].index];
    const std::span<const Interval> all{operands, made.operands.size()};
    Interval result = info.operands[0] == 'm' ? of_image(op, all) : evaluate(op, all);
    const bool is_part = frame.structure.is_part_of_result[made.results[0].index];
    if (is_part && info.operands[0] == 'r' && info.result == 'r' && !result.is_finite())
        note_fault(made, op, all,
                   result.may_be_nan && op != Op::div ? Why::domain
                   : holds_pole(op, all)              ? Why::pole
                                                      : Why::overflow);
    result = sharpened(frame, made, op, result);
    frame.values[made.results[0].index] = result;
    if (!varying) return;
    Variation variation = variation_of(frame, made, op, all, result);
    if (seams && variation.number == ValueNumbers::none)
        seams->cross(op, seam_operands(frame, made.operands), result, variation);
    if (op == Op::select) choose_at(made.span, variation);
    frame.variations[made.results[0].index] = std::move(variation);
}

void IntervalEvaluator::visit(Frame& frame, const Instruction& made, const RealConstant& constant)
{
    if (!std::isfinite(constant.value)) note({{}, {}, {}, made.span});
    frame.values[made.results[0].index] = exactly(constant.value);
}

void IntervalEvaluator::visit(Frame& frame, const Instruction& made, const WordConstant& constant)
{
    const Value result = made.results[0];
    frame.values[result.index] = exactly(frame.function.type(result), constant.bits);
}

void IntervalEvaluator::visit(Frame& frame, const Instruction& made, const ReadInput& read)
{
    const Value result = made.results[0];
    frame.values[result.index] = box ? box->input[static_cast<size_t>(read.input)] : everything(Type::real);
    if (!varying) return;
    Variation& variation = frame.variations[result.index];
    variation = variation_of_input(*box, read.input, made.span);
    if (seams) variation.number = seams->numbers.of(ValueNumbers::Other::input, static_cast<uint64_t>(read.input), {});
}

void IntervalEvaluator::visit(Frame& frame, const Instruction& made, const ReadParameter& read)
{
    const Value result = made.results[0];
    const Type type = frame.function.type(result);
    const bool is_known = box && read.parameter < box->parameters.size();
    frame.values[result.index] = type == Type::image ? exactly(ImagePart{static_cast<int32_t>(read.parameter)}.number())
                                 : is_known          ? box->parameters[read.parameter]
                                                     : everything(type);
    if (varying && seams)
        frame.variations[result.index].number = seams->numbers.of(ValueNumbers::Other::parameter, read.parameter, {});
}

void IntervalEvaluator::visit(Frame& frame, const Instruction& made, const ReadTable& read)
{
    const Table& table = module.tables[read.table];
    const CellRanges& ranges = of_cells.try_emplace(read.table, table).first->second;
    const auto cell = [&](double at) { return static_cast<size_t>(std::clamp(at, 0.0, table.size() - 1.0)); };
    const auto cells = [&](const Interval& at) { return ranges.over(cell(at.minimum), cell(at.maximum)); };
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
            [&](auto parts, auto) { return seams->numbers.of(ValueNumbers::Other::table, read.table, parts); },
            [&](auto values) { return cells(values[0]); }, variation);
}

void IntervalEvaluator::visit(Frame& frame, const Instruction& made, const Call& callee)
{
    Results arguments = gather(frame, made.operands, take_spare());
    const auto is_part = [&](Value result) { return frame.structure.is_part_of_result[result.index]; };
    const bool was_compared = std::exchange(is_compared, is_compared || std::ranges::none_of(made.results, is_part));
    Results results = call(callee.function, arguments, made.span);
    is_compared = was_compared;
    if (varying) pass_faults(callee.function, arguments, results);
    for (Variation& variation : results.variations) // what is made by the compiler has no place
        if (variation.continuity != Continuity::smooth && variation.cause.span.end == 0)
            variation.cause = {made.span, {}, module.functions[callee.function].is_library};
    store(frame, made.results, results);
    spare.push_back(std::move(arguments));
}

void IntervalEvaluator::visit(Frame& frame, const Instruction& made, const PointDerivative&)
{
    store(frame, made.results, unknown(frame.function, made.results, made.span)); // in no verified program
}

void IntervalEvaluator::visit(Frame& frame, const Instruction& made, const For& loop)
{
    const Block& body = loop.body[0];
    const Interval trips = frame.values[made.operands[0].index];
    const std::span<const Value> parameters(body.parameters);
    Results carried = gather(frame, std::span(made.operands).subspan(1));
    Results all{std::vector<Interval>(made.results.size(), no_value), {}};
    ++depth;
    for (double trip = 0;; ++trip) {
        if (trip >= trips.minimum) join_into(all, carried);
        if (trip >= trips.maximum || left == 0 || depth >= depth_max) break;
        --left;
        frame.values[parameters[0].index] = exactly(trip);
        store(frame, parameters.subspan(1), carried);
        block(frame, body);
        carried = gather(frame, body.yields, std::move(carried));
    }
    if (depth >= depth_max || left == 0) all = unknown(frame.function, made.results, made.span);
    --depth;
    if (varying) {
        all.variations.resize(made.results.size());
        Variation by = frame.variations[made.operands[0].index];
        by.continuity = std::min(by.continuity, Continuity::jump);
        if (!trips.is_point())
            for (Variation& variation : all.variations) jump_with(by, made.span, variation);
    }
    store(frame, made.results, all);
}

} // namespace haptel::ir
