// Compiled textures on meshes, as a scene puts them there.
#pragma once

#include "runtime/render/renderer.h"
#include "runtime/texture/shading.h"
#include "tests/jit/codegen/samples.h"
#include "tests/support/touch_scenes.h"

#include <string>
#include <utility>
#include <vector>

namespace haptel::test {

using Values = std::vector<std::pair<std::string, std::string>>;

// The texture bound for that surface: its box, its normals.
inline TextureBinding bound_for(const std::shared_ptr<const jit::CompiledProgram>& program, const char* texture,
                                const runtime::Surface& surface, Values values = {}, const std::string& folder = {},
                                double footprint_m = 0, jit::For use = jit::For::hand)
{
    TextureRequest request;
    for (int i = 0; i < 3; ++i) {
        request.box_minimum_m[i] = surface.box_minimum_m[i];
        request.box_maximum_m[i] = surface.box_maximum_m[i];
    }
    request.normal_turn_max_per_m = surface.normal_turn_max_per_m;
    request.uv = runtime::uv_figures(surface);
    request.parameters = std::move(values);
    request.folder = folder;
    request.footprint_m = footprint_m;
    TextureResult result = jit::make_binding(program, texture, request, use);
    INFO(result.diagnostics);
    REQUIRE(result.binding);
    return *result.binding;
}

// A frictionless scene of one textured mesh, 1000 N/m.
inline std::shared_ptr<const runtime::Scene> textured_scene(const runtime::Mesh& mesh,
                                                            const std::shared_ptr<const jit::CompiledProgram>& program,
                                                            const char* texture, Values values = {})
{
    runtime::Scene scene = tests::bare_scene(mesh);
    runtime::SceneObject& object = scene.objects[0];
    object.texture =
        std::make_shared<runtime::TextureSlot>(bound_for(program, texture, *object.surface, std::move(values)));
    return tests::shared(std::move(scene));
}

} // namespace haptel::test
