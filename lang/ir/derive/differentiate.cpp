#include "lang/ir/derive/differentiate.h"

#include "lang/abi/abi.h"
#include "lang/ir/derive/derivative_emitter.h"
#include "lang/ir/derive/point_derivative.h"

#include <algorithm>
#include <map>

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
        bits |= input <= Input::p_z        ? HAPTEL_READS_POINT
                : input <= Input::n_z      ? HAPTEL_READS_NORMAL
                : input <= Input::uv_y     ? HAPTEL_READS_UV
                : input == Input::time     ? HAPTEL_READS_TIME
                : input <= Input::n_dp_22  ? HAPTEL_READS_NORMAL
                : input <= Input::uv_dp_12 ? HAPTEL_READS_UV
                : input <= Input::center_z ? HAPTEL_READS_CENTER
                : input <= Input::extent_z ? HAPTEL_READS_EXTENT
                                           : HAPTEL_READS_FOOTPRINT;
    });
    return bits;
}

// "Or" of u32, through signed words.
Value either(Builder& builder, Value a, Value b)
{
    const Value bits =
        builder.operation(Op::ior, {builder.operation(Op::u_as_i, {a}), builder.operation(Op::u_as_i, {b})});
    return builder.operation(Op::i_as_u, {bits});
}

// Appends what the body yields behind the height, 1 and a fault where that is not finite or below 0: a scale that would
// pull where a surface pushes is no scale. The faults end `results`.
void material_outputs(Builder& builder, const DerivativeEmitter& emitter, std::span<const Value> yields,
                      std::vector<Value>& results)
{
    const size_t faults = results.size() - 1;
    for (Value yield : yields.subspan(1)) {
        const Value output = emitter.primal(yield);
        const Value is_fine = builder.operation(Op::land, {builder.operation(Op::is_finite, {output}),
                                                           builder.operation(Op::le, {builder.real(0), output})});
        results.push_back(builder.operation(Op::select, {is_fine, output, builder.real(1)}));
        const Value fault =
            builder.operation(Op::select, {is_fine, builder.u32(0), builder.u32(HAPTEL_FAULT_OUTPUT_NOT_FINITE)});
        results[faults] = either(builder, results[faults], fault);
    }
}

} // namespace

std::string pattern_of(const Seeds& seeds)
{
    std::string pattern;
    for (const std::vector<Seed>& row : seeds) {
        if (!pattern.empty()) pattern += ',';
        for (Seed seed : row) pattern += seed == Seed::none ? '.' : seed == Seed::unit ? '1' : 't';
    }
    return pattern;
}

struct Differentiator::Memo final : Callees {
    Memo(Module& module, Differentiator& owner) : differentiator(owner), dependences(module), resolver(module, owner) {}

    CallPlan plan(const Instruction& call, const Activity& activity) override
    {
        const uint32_t callee = std::get<Call>(call.kind).function;
        return plan_call(call, dependences.of(callee), activity, resolver.asks(callee));
    }
    Derivative derivative(uint32_t callee, const CallPlan& plan) override
    {
        return differentiator.derivative(callee, plan.seeds);
    }
    bool resolves_point_derivatives() const override { return false; }

    Differentiator& differentiator;
    std::map<std::pair<uint32_t, Seeds>, Derivative> derivatives;
    Dependences dependences;
    PointDerivativeResolver resolver;
};

Differentiator::Differentiator(Module& whole) : module(whole), memo(std::make_unique<Memo>(whole, *this)) {}

Differentiator::~Differentiator() = default;

Derivative Differentiator::derivative(uint32_t function, const Seeds& seeds)
{
    const auto key = std::make_pair(function, seeds);
    if (auto known = memo->derivatives.find(key); known != memo->derivatives.end()) return known->second;

    const Function source = module.functions[function]; // a copy: the module grows meanwhile
    const size_t directions = seeds.empty() ? 0 : seeds[0].size();
    Activity activity(source.value_types.size(), directions);
    for (size_t p = 0; p < seeds.size(); ++p)
        for (size_t d = 0; d < directions; ++d)
            if (seeds[p][d] != Seed::none) activity.set(source.parameters[p], d);
    propagate(source, memo->dependences, nullptr, activity);

    DerivativeEmitter emitter(source, activity, *memo);
    emitter.prepare(source.body);

    const bool is_jacobian = directions > 0 && seeds == first_argument_seeds(source);
    Builder builder(module, "d " + source.name + (is_jacobian ? "" : " [" + pattern_of(seeds) + "]"));
    emitter.begin(builder, seeds);
    for (size_t p = 0; p < seeds.size(); ++p)
        for (size_t d = 0; d < directions; ++d)
            if (seeds[p][d] == Seed::unit) emitter.set_tangent(builder, source.parameters[p], d, builder.real(1));
    emitter.emit(builder, source.body);

    Derivative made;
    const std::vector<Value> results = emitter.results(true, made.exists);
    if (is_jacobian && !source.facts.empty()) {
        std::vector<Facts>& facts = builder.function().facts;
        facts.resize(source.body.yields.size());
        for (size_t r = 0; r < source.facts.size(); ++r)
            facts.insert(facts.end(), std::count(made.exists[r].begin(), made.exists[r].end(), true),
                         facts_of_partial(source.facts[r]));
    }
    made.function = builder.finish(results);
    return memo->derivatives.emplace(key, made).first->second;
}

Derivative Differentiator::jacobian(uint32_t function)
{
    return derivative(function, first_argument_seeds(module.functions[function]));
}

void Differentiator::make_entries(Texture& texture)
{
    texture.body = memo->resolver.resolved_entry(texture.body);
    const Function source = module.functions[texture.body];
    auto make = [&](size_t directions, const std::string& name) {
        Activity activity(source.value_types.size(), directions);
        propagate(source, memo->dependences, input_is_active, activity);
        DerivativeEmitter emitter(source, activity, *memo);
        emitter.prepare(source.body);

        Builder builder(module, name);
        emitter.emit(builder, source.body);
        builder.span = source.body.instructions.empty() ? Span{} : source.body.instructions.back().span;
        const Value zero = builder.real(0), height = emitter.primal(source.body.yields[0]);
        const Value height_is_fine = builder.operation(Op::is_finite, {height});
        std::vector<Value> results{builder.operation(Op::select, {height_is_fine, height, zero})};
        const Value height_fault = builder.operation(
            Op::select, {height_is_fine, builder.u32(0), builder.u32(HAPTEL_FAULT_HEIGHT_NOT_FINITE)});
        Value faults = height_fault;

        if (directions > 0) {
            std::vector<Value> gradient;
            Value gradient_is_fine = builder.boolean(true);
            for (size_t d = 0; d < directions; ++d) {
                const Tangent& tangent = emitter.tangent(source.body.yields[0], d);
                gradient.push_back(tangent ? *tangent : zero);
                Value is_fine = builder.operation(Op::is_finite, {gradient.back()});
                gradient_is_fine = builder.operation(Op::land, {gradient_is_fine, is_fine});
            }
            Value all_fine = builder.operation(Op::land, {height_is_fine, gradient_is_fine});
            for (Value component : gradient)
                results.push_back(builder.operation(Op::select, {all_fine, component, zero}));
            Value gradient_fault = builder.operation(
                Op::select, {gradient_is_fine, builder.u32(0), builder.u32(HAPTEL_FAULT_GRADIENT_NOT_FINITE)});
            faults = either(builder, faults, gradient_fault);
        }
        results.push_back(faults);
        if (directions > 0) {
            material_outputs(builder, emitter, source.body.yields, results);
            results.push_back(height_fault);
        }
        return builder.finish(results);
    };
    texture.height = make(0, texture.name + " height");
    texture.height_gradient = make(axes, texture.name + " height and gradient");
    texture.reads = inputs_read(module.functions[texture.height].body) |
                    inputs_read(module.functions[texture.height_gradient].body);
}

} // namespace haptel::ir
