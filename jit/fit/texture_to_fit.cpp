#include "jit/fit/texture_to_fit.h"

#include "jit/fit/determined.h"

#include <algorithm>
#include <cstring>

namespace haptel::jit {

namespace {

double value_in(const haptel_texture& texture, uint32_t index, const void* block)
{
    const haptel_parameter& parameter = texture.parameters[index];
    const char* place = static_cast<const char*>(block) + parameter.offset;
    if (parameter.type == HAPTEL_FLOAT) {
        double real = 0;
        std::memcpy(&real, place, sizeof real);
        return real;
    }
    uint32_t bits = 0;
    std::memcpy(&bits, place, sizeof bits);
    return parameter.type == HAPTEL_INT ? static_cast<int32_t>(bits) : static_cast<double>(bits);
}

} // namespace

TextureToFit::TextureToFit(const std::shared_ptr<const CompiledProgram>& program, const FitRequest& request,
                           double width_m, double height_m)
{
    TextureRequest wanted;
    wanted.parameters = request.parameters;
    const double sides_m[2] = {width_m, height_m};
    for (int axis = 0; axis < 2; ++axis) {
        wanted.box_minimum_m[axis] = -sides_m[axis] / 2;
        wanted.box_maximum_m[axis] = sides_m[axis] / 2;
    }
    TextureResult bound = make_binding(program, request.texture, wanted, For::figures);
    if (!bound.binding) {
        why = std::move(bound.diagnostics);
        return;
    }
    binding = std::move(bound.binding);
    std::vector<std::string> given;
    for (const auto& [name, value] : request.parameters) given.push_back(name);
    looked_for.emplace(*binding, given);
    if (looked_for->reals.empty() && looked_for->wholes.empty()) {
        why = "there is nothing to look for: the texture has no parameter that is free and has a range";
        return;
    }
    made.emplace(program, request.texture, looked_for->real_parameters());
    why = made->error();
}

FitResult TextureToFit::result(std::span<const Found> all, Misfit& misfit)
{
    FitResult result;
    const haptel_texture& texture = made->texture();
    const void* block = looked_for->block(all.front().guess);
    for (uint32_t i = 0; i < texture.parameter_count; ++i) {
        const haptel_parameter& parameter = texture.parameters[i];
        if (parameter.type == HAPTEL_IMAGE) continue;
        const bool is_free = std::ranges::count(looked_for->reals, i, &RealUnknown::parameter) +
                                 std::ranges::count(looked_for->wholes, i, &WholeUnknown::parameter) >
                             0;
        result.parameters.push_back({parameter.name, i, value_in(texture, i, block), is_free});
    }
    result.error = all.front().misfit;
    result.of_all = all.front().misfit / misfit.scale();
    result.undetermined = undetermined(*looked_for, misfit, texture, all);
    return result;
}

} // namespace haptel::jit
