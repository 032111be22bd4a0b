// A texture, a point and a block as the interpreter takes them, for any real type.
#pragma once

#include "jit/texture/texture.h"
#include "lang/abi/outputs.h"
#include "lang/ir/run/interpret.h"

#include <cstring>

namespace haptel::jit {

// ir::Input counts the doubles of haptel_point, then those of haptel_block_head.
inline constexpr size_t point_inputs = sizeof(haptel_point) / sizeof(double);
static_assert(point_inputs == static_cast<size_t>(ir::Input::center_x));

template <typename T>
void set_point(ir::EntryInputs<T>& inputs, const haptel_point& point)
{
    double values[point_inputs];
    std::memcpy(values, &point, sizeof values);
    for (size_t i = 0; i < point_inputs; ++i) inputs.input[i] = T(values[i]);
}

template <typename T>
void set_block(ir::EntryInputs<T>& inputs, const ir::Texture& texture, const void* block)
{
    double head[sizeof(haptel_block_head) / sizeof(double)];
    std::memcpy(head, block, sizeof head);
    for (size_t i = 0; i < std::size(head); ++i) inputs.input[point_inputs + i] = T(head[i]);
    inputs.parameters.clear();
    for (const ir::Parameter& parameter : texture.parameters) {
        const char* place = static_cast<const char*>(block) + parameter.offset;
        ir::Slot<T>& slot = inputs.parameters.emplace_back();
        if (parameter.type == ir::Type::real) {
            double real = 0;
            std::memcpy(&real, place, sizeof real);
            slot.real = T(real);
        } else if (parameter.type == ir::Type::image) {
            std::memcpy(&slot.image, place, sizeof slot.image);
        } else {
            std::memcpy(&slot.bits, place, sizeof slot.bits);
            if (parameter.type == ir::Type::boolean) slot.bits = slot.bits != 0;
        }
    }
}

// Results of a height_gradient entry that are material outputs, component by component of those that it writes.
template <typename Results>
auto material_outputs(const ir::Texture& texture, const Results& results)
{
    return results.subspan(5, output_components(texture.writes));
}

// The texture of a binding of this program.
template <typename T>
struct InterpretedTexture {
    InterpretedTexture(const CompiledProgram& program, const TextureBinding& binding)
        : texture(program.source_of(*program.find(binding.texture->name))), interpreter(program.module())
    {
        set_block(inputs, texture, binding.block);
    }
    std::span<const ir::Slot<T>> run(uint32_t function) { return interpreter.run(function, {}, &inputs); }
    std::span<const ir::Slot<T>> height_gradient(const haptel_point& point)
    {
        set_point(inputs, point);
        return run(texture.height_gradient);
    }

    const ir::Texture& texture;
    ir::Interpreter<T> interpreter;
    ir::EntryInputs<T> inputs;
};

} // namespace haptel::jit
