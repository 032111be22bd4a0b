#include "bench/bumpy_ball.h"

#include "jit/texture/texture.h"
#include "runtime/surface/shapes.h"

#include <cmath>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <utility>

namespace haptel::bench {

using namespace haptel::runtime;

namespace {

constexpr double radius_m = 0.05, bump_m = 1e-3, way_per_tick_m = 1e-4;

// Small waves all round, smooth: facets nearly in one plane, shallow creases.
double bumpy_radius_m(const glm::dvec3& d)
{
    return radius_m + bump_m * std::sin(9 * d.x) * std::sin(9 * d.y) * std::sin(9 * d.z);
}

Mesh with_bumps(Mesh ball, bool drawn)
{
    for (glm::dvec3& p : ball.positions_m) {
        const glm::dvec3 d = glm::normalize(p);
        if (drawn) ball.uv.emplace_back(d.x, d.z); // seen from the side
        p = d * bumpy_radius_m(d);
    }
    return ball;
}

} // namespace

Mesh bumpy_ball(uint32_t subdivisions, bool drawn)
{
    return with_bumps(make_icosphere(subdivisions), drawn);
}

Mesh bumpy_geodesic(uint32_t parts)
{
    return with_bumps(make_geodesic(parts), false);
}

glm::dvec3 place_on_stroke(int tick, double height_m)
{
    const double angle = way_per_tick_m / radius_m * tick, z = 0.7 * std::sin(0.37 * angle);
    const double across = std::sqrt(1 - z * z);
    const glm::dvec3 d(across * std::cos(angle), across * std::sin(angle), z);
    return d * (bumpy_radius_m(d) + height_m);
}

std::shared_ptr<Scene> balls_on_a_grid(const std::shared_ptr<const Surface>& surface, uint64_t objects,
                                       const TextureBinding& texture, const ProbeSettings& probe)
{
    auto scene = std::make_shared<Scene>();
    scene->probe = probe;
    scene->servo.force_rise_s = 0;
    const auto side = static_cast<uint64_t>(std::ceil(std::cbrt(static_cast<double>(objects))));
    for (uint64_t i = 0; i < objects; ++i) {
        SceneObject object;
        object.surface = surface;
        object.texture = std::make_shared<TextureSlot>(texture);
        object.placement.position_m =
            0.15 * glm::dvec3(static_cast<double>(i % side), static_cast<double>(i / side % side),
                              static_cast<double>(i / (side * side)));
        scene->objects.push_back(std::move(object));
    }
    return scene;
}

TextureBinding bound_over_ball(const char* text, const char* name, double footprint_m)
{
    const jit::CompiledTextures compiled = jit::compile_texture(text, jit::servo_options());
    if (!compiled.program) throw std::runtime_error(compiled.rendered());
    compiled.program->optimise(); // as a scene's, soon after
    TextureRequest request;
    for (int i = 0; i < 3; ++i) request.box_minimum_m[i] = -0.06, request.box_maximum_m[i] = 0.06;
    request.footprint_m = footprint_m;
    const TextureResult bound = jit::make_binding(compiled.program, name, request);
    if (!bound.binding) throw std::runtime_error(bound.diagnostics);
    return *bound.binding;
}

} // namespace haptel::bench
