#include "jit/check/oracle.h"

#include "jit/check/entry_inputs.h"
#include "lang/math/quad.h"

namespace haptel::jit {

namespace {

const ir::Texture& source_of(const CompiledProgram& program, const TextureBinding& binding)
{
    return program.source_of(*program.find(binding.texture->name));
}

} // namespace

struct Oracle::Machine {
    Machine(std::shared_ptr<const CompiledProgram> whole, const TextureBinding& bound)
        : program(std::move(whole))
        , binding(bound)
        , texture(source_of(*program, binding))
        , interpreter(program->module())
    {
        set_block(inputs, texture, binding.block);
    }

    const std::shared_ptr<const CompiledProgram> program;
    const TextureBinding binding; // keeps the pictures that its block points to
    const ir::Texture& texture;
    ir::Interpreter<ir::Quad> interpreter;
    ir::EntryInputs<ir::Quad> inputs;
};

Oracle::Oracle(std::shared_ptr<const CompiledProgram> program, const TextureBinding& binding)
    : machine(std::make_unique<Machine>(std::move(program), binding))
{
}

Oracle::~Oracle() = default;

OracleSample Oracle::sample(const haptel_point& point)
{
    constexpr int digits = 36;
    set_point(machine->inputs, point);
    const auto results = machine->interpreter.run(machine->texture.height_gradient, {}, &machine->inputs);
    OracleSample sample;
    sample.height_m = static_cast<double>(results[0].real);
    sample.height_digits = results[0].real.str(digits);
    for (size_t i = 0; i < 3; ++i) {
        sample.gradient[i] = static_cast<double>(results[1 + i].real);
        sample.gradient_digits[i] = results[1 + i].real.str(digits);
    }
    sample.faults = results[4].bits;
    const auto outputs = material_outputs(machine->texture, results);
    sample.stiffness_digits = outputs[0].str(digits);
    sample.friction_digits = outputs[1].str(digits);
    return sample;
}

haptel_sample interpret_sample(const CompiledProgram& program, const TextureBinding& binding, const haptel_point& point)
{
    const ir::Texture& texture = source_of(program, binding);
    ir::EntryInputs<double> inputs;
    set_block(inputs, texture, binding.block);
    set_point(inputs, point);
    ir::Interpreter<double> interpreter(program.module());
    const auto results = interpreter.run(texture.height_gradient, {}, &inputs);
    const auto [stiffness, friction] = material_outputs(texture, results);
    return {results[0].real, {results[1].real, results[2].real, results[3].real}, stiffness, friction, results[4].bits};
}

} // namespace haptel::jit
