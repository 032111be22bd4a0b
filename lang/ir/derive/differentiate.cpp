#include "lang/ir/derive/differentiate.h"

#include "lang/abi/outputs.h"
#include "lang/ir/derive/derivative_emitter.h"

#include <algorithm>

namespace haptel::ir {
namespace {

Seeds first_argument_seeds(const Function& function)
{
    const size_t size = function.first_argument_size;
    Seeds seeds(function.parameters.size(), std::vector<Seed>(size, Seed::none));
    for (size_t p = 0; p < size; ++p)
        if (function.type(function.parameters[p]) == Type::real) seeds[p][p] = Seed::unit;
    return seeds;
}

// What facts say of a partial derivative with respect to one component of the first argument.
Facts facts_of_partial(const Facts& of)
{
    Facts partial;
    partial.slope = of.curvature;
    if (of.slope) partial.value_minimum = -*of.slope, partial.value_maximum = *of.slope;
    if (of.continuity) partial.continuity = lowered(*of.continuity);
    partial.proven = of.proven;
    return partial;
}

// HAPTEL_READS_* of what an entry reads.
uint32_t inputs_read(const Block& block)
{
    uint32_t bits = 0;
    for_each_instruction(block, [&](const Instruction& made) {
        const auto* read = std::get_if<ReadInput>(&made.kind);
        if (!read) return;
        const Input input = read->input;
        bits |= input <= Input::p_z            ? HAPTEL_READS_POINT
                : input <= Input::n_z          ? HAPTEL_READS_NORMAL
                : input <= Input::uv_y         ? HAPTEL_READS_UV
                : input == Input::time         ? HAPTEL_READS_TIME
                : input <= Input::n_dp_22      ? HAPTEL_READS_NORMAL
                : input <= Input::uv_dp_12     ? HAPTEL_READS_UV
                : input <= Input::velocity_z   ? HAPTEL_READS_VELOCITY
                : input == Input::normal_force ? HAPTEL_READS_NORMAL_FORCE
                : input == Input::tool_radius  ? HAPTEL_READS_TOOL_RADIUS
                : input <= Input::bitangent_z  ? HAPTEL_READS_TANGENT
                : input == Input::curvature    ? HAPTEL_READS_CURVATURE
                : input <= Input::center_z     ? HAPTEL_READS_CENTER
                : input <= Input::extent_z     ? HAPTEL_READS_EXTENT
                                               : HAPTEL_READS_FOOTPRINT;
    });
    return bits;
}

std::string pattern_of(const Seeds& seeds) // "1..,.t.": a letter per parameter and direction
{
    std::string pattern;
    for (const std::vector<Seed>& row : seeds) {
        if (!pattern.empty()) pattern += ',';
        for (Seed seed : row) pattern += ".1t"[static_cast<size_t>(seed)];
    }
    return " [" + pattern + "]";
}

} // namespace

std::optional<CallPlan> Differentiator::plan(const Instruction& call, const Activity& activity,
                                             PointDerivatives point_derivatives)
{
    const uint32_t callee = std::get<Call>(call.kind).function;
    const PointUse& use = point_uses.of(callee);
    const bool resolves = point_derivatives == PointDerivatives::resolved && use.asks;
    const bool is_tangent_wanted =
        std::ranges::any_of(call.results, [&](Value result) { return activity.any(result); });
    const Dependence& depends = (resolves ? point_uses.dependences : dependences).of(callee);
    CallPlan plan;
    for (size_t p = 0; p < call.operands.size(); ++p) {
        const auto reads_it = [&](const std::vector<bool>& row) { return row[p]; };
        const bool is_needed =
            (is_tangent_wanted && std::ranges::any_of(depends, reads_it)) || (resolves && use.parameters[p]);
        if (is_needed && activity.any(call.operands[p])) plan.columns.push_back(p);
    }
    if (plan.columns.empty() && !resolves) return std::nullopt;
    plan.by_jacobian = plan.columns.size() <= activity.directions() && !use.asks;
    const size_t directions = plan.by_jacobian ? plan.columns.size() : activity.directions();
    Seeds seeds(call.operands.size(), std::vector<Seed>(directions, Seed::none));
    for (size_t column = 0; column < plan.columns.size(); ++column) {
        const size_t p = plan.columns[column];
        for (size_t d = 0; d < directions; ++d)
            if (plan.by_jacobian ? d == column : activity(call.operands[p], d))
                seeds[p][d] = plan.by_jacobian ? Seed::unit : Seed::given;
    }
    plan.request = {callee, std::move(seeds), resolves ? PointDerivatives::resolved : PointDerivatives::vary,
                    is_tangent_wanted};
    return plan;
}

Derivative Differentiator::derivative(const DerivativeRequest& request)
{
    if (auto known = memo.find(request); known != memo.end()) return known->second;

    const auto& [index, seeds, point_derivatives, tangents_wanted] = request;
    const Function source = module.functions[index]; // a copy: the module grows meanwhile
    const bool resolves = point_derivatives == PointDerivatives::resolved;
    const size_t directions = resolves ? axes : seeds.empty() ? 0 : seeds[0].size();
    Activity activity(source.value_types.size(), directions);
    for (size_t p = 0; p < seeds.size(); ++p)
        for (size_t d = 0; d < directions; ++d)
            if (seeds[p][d] != Seed::none) activity.set(source.parameters[p], d);
    if (resolves) {
        propagate(source, point_uses.dependences, input_is_active, activity);
        const std::vector<bool> is_needed = point_uses.needed(source, tangents_wanted);
        for (uint32_t value = 0; value < is_needed.size(); ++value)
            if (!is_needed[value]) activity.clear({value});
    } else {
        propagate(source, dependences, nullptr, activity);
    }

    const bool is_jacobian = !resolves && directions > 0 && seeds == first_argument_seeds(source);
    const std::string name = std::string(tangents_wanted ? "d " : "") + (resolves ? "resolved " : "") + source.name;
    const bool is_told_by_name = is_jacobian || (resolves && seeds.empty());
    DerivativeEmitter emitter(module, is_told_by_name ? name : name + pattern_of(seeds), source, activity, *this,
                              point_derivatives);
    emitter.begin(seeds);
    emitter.emit(source.body);

    Derivative made;
    const std::vector<Value> results = emitter.results(tangents_wanted, made.exists);
    if (is_jacobian && !source.facts.empty()) {
        std::vector<Facts>& facts = emitter.builder.function().facts;
        facts.resize(source.body.yields.size());
        for (size_t r = 0; r < source.facts.size(); ++r)
            facts.insert(facts.end(), std::count(made.exists[r].begin(), made.exists[r].end(), true),
                         facts_of_partial(source.facts[r]));
    }
    made.function = emitter.builder.finish(results);
    return memo.emplace(request, made).first->second;
}

Derivative Differentiator::jacobian(uint32_t function)
{
    return derivative(function, first_argument_seeds(module.functions[function]));
}

void Differentiator::make_entries(Texture& texture)
{
    if (point_uses.of(texture.body).asks)
        texture.body = derivative({texture.body, {}, PointDerivatives::resolved, false}).function;
    texture.height = entry(texture, By::nothing, texture.name + " height");
    texture.height_gradient = entry(texture, By::point, texture.name + " height and gradient");
    texture.reads = inputs_read(module.functions[texture.height].body) |
                    inputs_read(module.functions[texture.height_gradient].body);
}

uint32_t Differentiator::parameter_gradient(const Texture& texture, std::span<const uint32_t> parameters)
{
    Texture alone = texture;
    alone.writes = 0;
    return entry(alone, By::parameters, texture.name + " height by parameters", parameters);
}

// By nothing: of the height alone; else of its gradient and the material outputs too.
uint32_t Differentiator::entry(const Texture& texture, By by, const std::string& name,
                               std::span<const uint32_t> parameters)
{
    const Function source = module.functions[texture.body];
    const size_t directions = by == By::nothing ? 0 : axes;
    Activity activity(source.value_types.size(), directions);
    propagate(source, dependences, by == By::point ? input_is_active : nullptr, activity, parameters);
    DerivativeEmitter emitter(module, name, source, activity, *this, PointDerivatives::vary);
    emitter.emit(source.body);

    Builder& builder = emitter.builder;
    builder.span = source.body.instructions.empty() ? Span{} : source.body.instructions.back().span;
    const auto is_finite = [&](Value value) { return builder.operation(Op::is_finite, {value}); };
    const auto both = [&](Value a, Value b) { return builder.operation(Op::land, {a, b}); };
    const auto either = [&](Value a, Value b) { // of u32, through signed words
        const Value x = builder.operation(Op::u_as_i, {a}), y = builder.operation(Op::u_as_i, {b});
        return builder.operation(Op::i_as_u, {builder.operation(Op::ior, {x, y})});
    };
    const auto select = [&](Value condition, Value a, Value b) {
        return builder.operation(Op::select, {condition, a, b});
    };
    const auto fault_unless = [&](Value is_fine, uint32_t fault) {
        const Value none = builder.u32(0);
        return select(is_fine, none, builder.u32(fault));
    };

    const std::span<const Value> yields(source.body.yields);
    const Value zero = builder.real(0), height = emitter.primal(yields[0]), height_is_fine = is_finite(height);
    std::vector<Value> results{select(height_is_fine, height, zero)};
    const Value height_fault = fault_unless(height_is_fine, HAPTEL_FAULT_HEIGHT_NOT_FINITE);
    if (directions == 0) {
        results.push_back(height_fault);
        return builder.finish(results);
    }

    std::vector<Value> gradient;
    Value gradient_is_fine = builder.boolean(true);
    for (size_t d = 0; d < directions; ++d) {
        gradient.push_back(emitter.tangent(yields[0], d).value_or(zero));
        gradient_is_fine = both(gradient_is_fine, is_finite(gradient.back()));
    }
    const Value all_fine = both(height_is_fine, gradient_is_fine);
    for (Value component : gradient) results.push_back(select(all_fine, component, zero));
    Value faults = either(height_fault, fault_unless(gradient_is_fine, HAPTEL_FAULT_GRADIENT_NOT_FINITE));

    // An output that is not finite, and a scale below 0, is what it is where nobody assigns it, and a fault: a scale
    // that would pull where a surface pushes is no scale.
    std::vector<Value> outputs;
    for_each_output(texture.writes, [&](const OutputInfo& output, size_t first) {
        Value is_fine{};
        for (size_t i = 0; i < output.components; ++i) {
            const Value component = emitter.primal(yields[1 + first + i]), is_number = is_finite(component);
            is_fine = i == 0 ? is_number : both(is_fine, is_number);
            if (output.is_never_negative)
                is_fine = both(is_fine, builder.operation(Op::le, {builder.real(0), component}));
        }
        for (size_t i = 0; i < output.components; ++i)
            outputs.push_back(select(is_fine, emitter.primal(yields[1 + first + i]), builder.real(output.value)));
        faults = either(faults, fault_unless(is_fine, HAPTEL_FAULT_OUTPUT_NOT_FINITE));
    });
    results.push_back(faults);
    results.insert(results.end(), outputs.begin(), outputs.end());
    results.push_back(height_fault);
    return builder.finish(results);
}

} // namespace haptel::ir
