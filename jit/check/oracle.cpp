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
    for (const auto& output : material_outputs(interpreted.texture, results))
        sample.output_digits.push_back(output.real.str(digits));
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
    haptel_sample sample = blank_sample;
    sample.height_m = results[0].real;
    for (size_t i = 0; i < 3; ++i) sample.gradient[i] = results[1 + i].real;
    sample.faults = results[4].bits;
    const auto outputs = material_outputs(interpreted.texture, results);
    for_each_output(interpreted.texture.writes, [&](const OutputInfo& output, size_t first) {
        for (size_t i = 0; i < output.components; ++i) components_of(sample, output)[i] = outputs[first + i].real;
    });
    return sample;
}

} // namespace haptel::jit
