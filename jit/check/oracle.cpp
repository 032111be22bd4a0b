#include "jit/check/oracle.h"

#include "jit/check/entry_inputs.h"
#include "lang/math/quad.h"

namespace haptel::jit {

namespace {

OracleSample sample_of(InterpretedTexture<ir::Quad>& interpreted, const haptel_point& point)
{
    constexpr int digits = 36;
    const auto results = interpreted.height_gradient(point);
    OracleSample sample;
    sample.height_m = static_cast<double>(results[0].real);
    sample.height_digits = results[0].real.str(digits);
    for (size_t i = 0; i < 3; ++i) {
        sample.gradient[i] = static_cast<double>(results[1 + i].real);
        sample.gradient_digits[i] = results[1 + i].real.str(digits);
    }
    sample.faults = results[4].bits;
    const auto outputs = material_outputs(interpreted.texture, results);
    sample.stiffness_digits = outputs[0].str(digits);
    sample.friction_digits = outputs[1].str(digits);
    return sample;
}

} // namespace

Oracle::Oracle(std::shared_ptr<const CompiledProgram> program, const TextureBinding& binding)
{
    const auto interpreted = std::make_shared<InterpretedTexture<ir::Quad>>(*program, binding);
    // Holds the binding, too, which keeps the pictures that its block points to.
    evaluate = [program, binding, interpreted](const haptel_point& point) { return sample_of(*interpreted, point); };
}

haptel_sample interpret_sample(const CompiledProgram& program, const TextureBinding& binding, const haptel_point& point)
{
    InterpretedTexture<double> interpreted(program, binding);
    const auto results = interpreted.height_gradient(point);
    const auto [stiffness, friction] = material_outputs(interpreted.texture, results);
    return {results[0].real, {results[1].real, results[2].real, results[3].real}, stiffness, friction, results[4].bits};
}

} // namespace haptel::jit
