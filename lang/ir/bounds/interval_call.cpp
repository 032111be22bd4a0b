// Calls: what a function's facts say of its results, and what its body does.
#include "lang/ir/bounds/interval_evaluator.h"
#include "lang/ir/cost.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace haptel::ir {
namespace {

constexpr uint64_t short_body = 16; // instructions
// What a call counts besides its arguments, its results and what is done inside, in operations. With an argument and a
// result it takes as long as three; where it varies it counts as so many that a hostile program of hardly more than
// calls is evaluated three times, not five.
constexpr uint64_t operations_of_call = 1, operations_of_varying_call = 6;

Interval declared_value(const Facts& facts, bool may_be_nan)
{
    if (!facts.value_minimum || !facts.value_maximum) return {-infinity, infinity, true};
    return {*facts.value_minimum, *facts.value_maximum, may_be_nan};
}

// How far the first argument's box reaches from its middle; infinite between integers, which have nothing there.
double reach_of(const Function& function, const IntervalEvaluator::Results& arguments)
{
    double square = 0;
    for (uint32_t i = 0; i < function.first_argument_size; ++i) {
        const Interval& argument = arguments.values[i];
        if (function.type(function.parameters[i]) != Type::real && !argument.is_point()) return infinity;
        const double at = argument.minimum / 2 + argument.maximum / 2;
        const double reach = std::max(argument.maximum - at, at - argument.minimum);
        square += reach * reach;
    }
    return std::sqrt(square) * (1 + 1e-14);
}

bool are_apart(std::span<const Interval> a, std::span<const Interval> b)
{
    for (size_t i = 0; i < a.size(); ++i)
        if (!a[i].is_empty() && !a[i].may_be_nan && (a[i].maximum < b[i].minimum || b[i].maximum < a[i].minimum))
            return true;
    return false;
}

// What a body does, over all of a box, although its facts exclude it.
std::optional<FalseFact::What> contradicted_by(const IntervalEvaluator::Results& found,
                                               const IntervalEvaluator::Results& declared, size_t result)
{
    using What = FalseFact::What;
    if (are_apart({&found.values[result], 1}, {&declared.values[result], 1})) return What::value;
    if (found.variations.empty() || found.variations[result].continuity < Continuity::c1) return std::nullopt;
    const Variation &by_body = found.variations[result], &by_facts = declared.variations[result];
    if (are_apart(by_body.gradient, by_facts.gradient)) return What::slope;
    if (are_apart(by_body.hessian, by_facts.hessian)) return What::curvature;
    return std::nullopt;
}

// Whether facts cover every gradient that code computes of these arguments. Of infinite ones they say nothing, nor of
// how the result varies with others than the first, even where they move by 0.
bool tells_derivative(const Function& function, const IntervalEvaluator::Results& arguments, bool are_finite)
{
    const std::span<const Variation> all(arguments.variations);
    const auto stays = [](const Variation& argument) { return argument.has_tangent && !argument.is_active; };
    return (are_finite || std::ranges::none_of(all, &Variation::has_tangent)) &&
           std::ranges::none_of(all.subspan(function.first_argument_size), stays);
}

// Rather than only step from one value to another, as the number of a cell does.
bool moves(const Variation& argument)
{
    return argument.is_active && !(argument.slope == 0 && argument.curvature == 0);
}

// By the chain rule: of the first argument by the facts, of the others, where they move too, as found (`by_others`;
// null: not looked for). Of how it bends by both, only the class is known. Others that step add to the class alone.
Variation by_facts(const Function& function, const Facts& facts, const IntervalEvaluator::Results& arguments,
                   const Variation* by_others)
{
    const std::span<const Variation> all(arguments.variations);
    const auto first = all.first(function.first_argument_size), others = all.subspan(first.size());
    Variation variation = chain(facts, first);
    if (std::ranges::any_of(others, &Variation::is_active)) {
        const bool is_of_first_alone = std::ranges::none_of(others, moves);
        const Variation of_first = std::exchange(variation, is_of_first_alone ? variation : unknown_variation({}));
        if (by_others && !is_of_first_alone) {
            for (size_t j = 0; j < variation.gradient.size(); ++j)
                variation.gradient[j] = add(of_first.gradient[j], by_others->gradient[j]);
            variation.slope = (of_first.slope + by_others->slope) * (1 + 1e-15);
        }
        variation.continuity = facts.continuity.value_or(Continuity::unknown);
        roughen(variation, of_first.continuity, of_first.cause);
        for (const Variation& other : others)
            if (other.is_active) roughen(variation, other.continuity, other.cause);
    }
    if (!facts.continuity && variation.is_active) variation.continuity = Continuity::unknown;
    return variation;
}

} // namespace

const Activity& IntervalEvaluator::tangents_of(uint32_t index, std::span<const Variation> arguments)
{
    const Function& function = module.functions[index];
    std::vector<bool> given;
    for (const Variation& argument : arguments) given.push_back(argument.has_tangent);
    const auto [known, is_new] = activities[index].try_emplace(given, function.value_types.size(), 1);
    Activity& activity = known->second;
    if (!is_new) return activity;
    for (size_t p = 0; p < given.size(); ++p)
        if (given[p]) activity.set(function.parameters[p], 0);
    propagate(function, dependences, [](Input input, size_t) { return input <= Input::uv_y; }, activity);
    return activity;
}

IntervalEvaluator::Results IntervalEvaluator::look_inside(uint32_t index, const Results& arguments, Span span)
{
    const Function& function = module.functions[index];
    if (depth >= depth_max || left == 0) return unknown(function, function.body.yields, span);
    ++depth;
    of_calls += varying ? operations_of_varying_call : operations_of_call;
    of_calls += function.parameters.size() + function.body.yields.size();
    const size_t count = function.value_types.size();
    Results memory = take_spare();
    memory.values.assign(count, no_value);
    memory.variations.assign(varying ? count : 0, Variation{});
    Frame frame{function, std::move(memory.values), std::move(memory.variations), structure_of(index),
                varying ? tangents_of(index, arguments.variations) : no_tangents};
    store(frame, function.parameters, arguments);
    const std::optional<Span> outside = user;
    if (function.is_library && !user) user = span;
    block(frame, function.body);
    user = outside;
    --depth;
    Results results = gather(frame, function.body.yields);
    spare.push_back({std::move(frame.values), std::move(frame.variations)});
    if (function.is_library)
        for (Variation& variation : results.variations) variation.cause = {span, {}, true}, variation.kink = 0;
    return results;
}

bool IntervalEvaluator::is_short(uint32_t index)
{
    const auto [known, is_new] = short_functions.try_emplace(index, false);
    const auto is_proven = [](const Facts& facts) { return facts.proven; };
    if (is_new)
        known->second = std::ranges::all_of(module.functions[index].facts, is_proven) &&
                        instructions_reached(module, index) <= short_body;
    return known->second;
}

std::vector<Interval> IntervalEvaluator::values_inside(uint32_t index, std::vector<Interval> arguments, Span span)
{
    const bool was_varying = std::exchange(varying, false);
    std::vector<Interval> values = look_inside(index, {std::move(arguments), {}}, span).values;
    varying = was_varying;
    return values;
}

// What the body does with its first argument held still; no variations where no other argument moves.
IntervalEvaluator::Results IntervalEvaluator::by_other_arguments(uint32_t index, const Results& arguments, Span span)
{
    const Function& function = module.functions[index];
    const auto others = std::span(arguments.variations).subspan(function.first_argument_size);
    const auto first = std::span(arguments.variations).first(function.first_argument_size);
    const auto has_slope = [](const Facts& facts) { return facts.slope.has_value(); };
    if (std::ranges::none_of(function.facts, has_slope) || std::ranges::none_of(others, moves) ||
        std::ranges::none_of(first, &Variation::is_active))
        return {};
    Results held = arguments;
    std::fill_n(held.variations.begin(), first.size(), Variation{});
    return look_inside(index, held, span);
}

// A gradient that is no number stays one behind a function that is flat there: code multiplies it by the function's
// derivative, which is 0.
void IntervalEvaluator::pass_faults(uint32_t index, const Results& arguments, Results& results)
{
    const Dependence& depends = dependences.of(index);
    for (size_t r = 0; r < results.variations.size(); ++r)
        for (size_t p = 0; p < arguments.variations.size(); ++p)
            results.variations[r].may_fault |= depends[r][p] && arguments.variations[p].may_fault;
}

// Facts speak of arguments that are numbers. An argument without bounds counts as some number; what comes of an
// infinite one is left open, as NaN is.
IntervalEvaluator::Results IntervalEvaluator::call(uint32_t index, const Results& arguments, Span span)
{
    const Function& function = module.functions[index];
    bool may_be_nan = false, is_a_number = true, are_finite = true;
    for (const Interval& argument : arguments.values) {
        may_be_nan |= argument.may_be_nan;
        is_a_number &= !argument.is_empty();
        are_finite &= argument.is_finite();
    }
    const size_t count = function.body.yields.size();
    if (!is_a_number || function.facts.empty()) return look_inside(index, arguments, span);
    if (may_be_nan) return call_beside_nan(index, arguments, span);

    const double reach = reach_of(function, arguments);
    bool is_narrow = false; // as seen from a wave of it: natural evaluation says more than the facts do
    Results declared;
    const Results others = varying ? by_other_arguments(index, arguments, span) : Results{};
    bool is_all_told = function.facts.size() >= count; // nothing is left to find out inside
    const bool is_derivative_told = varying && tells_derivative(function, arguments, are_finite);
    for (size_t r = 0; r < count; ++r) {
        const Facts facts = r < function.facts.size() ? function.facts[r] : Facts{};
        declared.values.push_back(declared_value(facts, !are_finite));
        const bool says_something = facts.value_minimum || facts.slope || facts.curvature || facts.continuity;
        if (varying && says_something && !facts.proven) noted.believed.insert(index);
        is_all_told &= facts.value_minimum && facts.value_maximum && facts.slope;
        const Interval& value = declared.values.back();
        is_narrow |= facts.slope && *facts.slope * reach < (value.maximum - value.minimum) / 2;
        if (!varying) continue;
        Variation& variation = declared.variations.emplace_back(
            by_facts(function, facts, arguments, others.variations.empty() ? nullptr : &others.variations[r]));
        variation.may_fault |= !is_derivative_told;
        is_all_told &= is_derivative_told;
        if (variation.is_active && variation.cause.span.end == 0) variation.cause = {span, {}, function.is_library};
        is_all_told &= !variation.is_active || (facts.continuity && variation.curvature < infinity);
    }
    if (seams && varying) cross_call(function, index, arguments, declared, span);
    // One value alone is looked at, too, and what is no dearer than its proven facts: where a ramp is level they do not
    // say so.
    if (is_all_told && !is_narrow && reach > 0 && !is_short(index)) return declared;

    Results results = look_inside(index, arguments, span);
    for (size_t r = 0; r < count; ++r) {
        const bool may_be_false = r < function.facts.size() && !function.facts[r].proven;
        if (const auto what = may_be_false ? contradicted_by(results, declared, r) : std::nullopt) {
            noted.contradicted.try_emplace({index, *what}, FalseFact{function.facts[r], *what, results.values[r]});
            continue; // the body is what runs
        }
        results.values[r] = intersect(results.values[r], declared.values[r]);
        if (varying) results.variations[r] = intersect(declared.variations[r], results.variations[r]);
    }
    if (is_narrow) sharpen_by_slope(index, arguments, reach, results);
    return results;
}

// Where arguments cross a seam results are of the arguments on both sides.
void IntervalEvaluator::cross_call(const Function& function, uint32_t index, const Results& arguments, Results& results,
                                   Span span)
{
    std::vector<Seams::Operand> operands;
    for (size_t p = 0; p < arguments.values.size(); ++p)
        operands.push_back(
            seams->operand(arguments.variations[p], arguments.values[p], function.type(function.parameters[p])));
    for (size_t r = 0; r < results.values.size(); ++r)
        seams->cross(
            operands, results.values[r],
            [&](auto parts, auto) {
                return seams->numbers.of(ValueNumbers::Other::call, uint64_t{index} << 32 | r, parts);
            },
            [&](auto values) { return values_inside(index, {values.begin(), values.end()}, span)[r]; },
            results.variations[r]);
}

// Facts hold of the numbers that arguments may be; of what is not a number the body alone tells.
IntervalEvaluator::Results IntervalEvaluator::call_beside_nan(uint32_t index, const Results& arguments, Span span)
{
    Results numbers = arguments;
    for (Interval& argument : numbers.values) argument.may_be_nan = false;
    Results all = call(index, numbers, span);
    for (size_t i = 0; i < arguments.values.size(); ++i) {
        if (!arguments.values[i].may_be_nan) continue;
        Results beside = arguments;
        beside.values[i] = no_number;
        const Results there = look_inside(index, beside, span);
        for (size_t r = 0; r < there.values.size(); ++r) {
            all.values[r] = join(all.values[r], there.values[r]);
            if (!varying) continue;
            if (!there.values[r].is_empty()) all.variations[r] = join(all.variations[r], there.variations[r]);
            all.variations[r].may_fault |= there.variations[r].may_fault;
        }
    }
    return all;
}

// |f(x) - f(middle)| <= slope |x - middle|, where nothing jumps on the way.
void IntervalEvaluator::sharpen_by_slope(uint32_t index, const Results& arguments, double reach, Results& results)
{
    const Function& function = module.functions[index];
    const auto is_lipschitz = [](const Facts& facts) {
        return facts.slope && facts.continuity && *facts.continuity >= Continuity::c0;
    };
    if (std::ranges::none_of(function.facts, is_lipschitz)) return;
    std::vector<Interval> middle = arguments.values;
    for (uint32_t i = 0; i < function.first_argument_size; ++i)
        middle[i] = exactly(middle[i].minimum / 2 + middle[i].maximum / 2);
    const std::vector<Interval> there = values_inside(index, std::move(middle), {});
    for (size_t r = 0; r < std::min(function.facts.size(), results.values.size()); ++r) {
        if (!is_lipschitz(function.facts[r])) continue;
        const double change = *function.facts[r].slope * reach * (1 + 1e-14);
        results.values[r] = intersect(results.values[r], add(there[r], {-change, change}));
    }
}

} // namespace haptel::ir
