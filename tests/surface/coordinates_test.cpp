// Where a texture is on a mesh: mesh coordinates, the two-stage maps, three planes; each with its exact gradient.
#include "runtime/texture/shading.h"
#include "runtime/texture/surface_texture.h"
#include "tests/support/tries.h"
#include "tests/surface/textured.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

using namespace haptel;
using namespace haptel::runtime;
using namespace haptel::test;
using glm::dvec2;
using glm::dvec3;
using tests::at;

namespace {

const char* const mapped_source = R"(
texture printed() { return 40um * sinturn(uv.x) * costurn(uv.y) + 20um * sinturn(2.0 * uv.x + uv.y); }
float ripples(vec2 q) { return sinturn(4.0 * q.x) * sinturn(3.0 * q.y); }
texture plane_mapped() { return 50um * ripples(plane_map(p, center, extent)); }
texture sphere_mapped() { return 50um * pole_fade(p, center, extent, 0.3) * ripples(sphere_map(p, center, extent)); }
texture cylinder_mapped() { return 50um * pole_fade(p, center, extent, 0.3) * ripples(cylinder_map(p, center, extent)); }
texture cube_mapped() { return 50um * center_fade(p, center, extent, 0.3) * ripples(cube_map(p, center, extent)); }
texture in_three_planes() { return 50um * triplanar(perlin, p / 6mm, n); }
)";

double printed_m(const dvec2& uv)
{
    return 40e-6 * std::sin(2 * std::numbers::pi * uv.x) * std::cos(2 * std::numbers::pi * uv.y) +
           20e-6 * std::sin(2 * std::numbers::pi * (2 * uv.x + uv.y));
}

dvec2 printed_slope_m(const dvec2& uv) // by u and v
{
    const double w = 2 * std::numbers::pi, shared_part = 20e-6 * w * std::cos(w * (2 * uv.x + uv.y));
    return {40e-6 * w * std::cos(w * uv.x) * std::cos(w * uv.y) + 2 * shared_part,
            -40e-6 * w * std::sin(w * uv.x) * std::sin(w * uv.y) + shared_part};
}

// The plane with uv = map * (x, y) / side + offset.
Mesh drawn_plane(double side_m, uint32_t cells, const glm::dmat2& map, const dvec2& offset)
{
    Mesh mesh = tests::plane_mesh(side_m, cells);
    for (std::size_t i = 0; i < mesh.uv.size(); ++i) mesh.uv[i] = map * dvec2(mesh.positions_m[i] / side_m) + offset;
    return mesh;
}

dvec3 random_weights(std::mt19937_64& random)
{
    std::uniform_real_distribution<double> uniform(0.05, 1);
    const dvec3 w(uniform(random), uniform(random), uniform(random));
    return w / (w.x + w.y + w.z);
}

SurfacePoint point_on(const Surface& surface, uint32_t face, uint32_t side, const dvec3& weights)
{
    SurfacePoint point;
    for (uint32_t i = 0; i < 3; ++i) point.p_m += weights[int(i)] * surface.vertex_m(face, i);
    point.shading = shade(surface, face, side, weights);
    return point;
}

double slope_of(const TextureBinding& binding, const SurfacePoint& point)
{
    return glm::length(tangential(sample_texture(binding, point).gradient, point.shading.normal));
}

} // namespace

TEST_CASE("anchors row 3: a flat map of 0 to 4 tiles has its exact slope, turned, mirrored, sheared or not")
{
    const auto program = compiled(mapped_source);
    const double side_m = 0.04, c = std::cos(0.7), s = std::sin(0.7);
    const std::pair<glm::dmat2, dvec2> maps[] = {
        {glm::dmat2(4), dvec2(2)},                       // 0 .. 4
        {glm::dmat2(-4, 0, 0, 4), dvec2(2)},             // mirrored in u
        {glm::dmat2(0, 4, 4, 0), dvec2(2)},              // mirrored along the diagonal
        {4.0 * glm::dmat2(c, s, -s, c), dvec2(1e3, -7)}, // turned, far away
        {glm::dmat2(4, 0, 2.5, 1), dvec2(0)},            // sheared
        {glm::dmat2(0.01), dvec2(0.5)},                  // almost none
    };
    for (const auto& [map, offset] : maps)
        for (const uint32_t cells : {1u, 7u, 64u}) {
            CAPTURE(cells, map[0][0], map[0][1], offset.x);
            Renderer renderer(textured_scene(drawn_plane(side_m, cells, map, offset), program, "printed"));
            renderer.tick(at(0, 0, 1e-3));
            std::mt19937 random(6);
            std::uniform_real_distribution<double> place_m(-0.019, 0.019), depth_m(0.3e-3, 0.8e-3);
            for (int i = 0; i < 300; ++i) {
                const double x = place_m(random), y = place_m(random), d = depth_m(random);
                const dvec2 uv = map * dvec2(x, y) / side_m + offset;
                const TickResult result = renderer.tick(at(x, y, -d));
                const dvec2 slope = printed_slope_m(uv) * map / side_m; // the chain rule: row times matrix
                CHECK(std::abs(result.height_m - printed_m(uv)) < 1e-13);
                CHECK(std::abs(result.force_n.x + result.force_n.z * slope.x) < 1e-8);
                CHECK(std::abs(result.force_n.y + result.force_n.z * slope.y) < 1e-8);
                CHECK(result.force_n.z > 0.1);
            }
        }
}

TEST_CASE("mesh coordinates may part along an edge: each side has its own picture")
{
    // Two squares side by side that share the edge x = 0 but not its coordinates: the right one is the left one
    // mirrored.
    Mesh mesh;
    mesh.positions_m = {{-0.02, 0, 0}, {0, 0, 0},    {0, 0.02, 0},    {-0.02, 0.02, 0},
                        {0, 0, 0},     {0.02, 0, 0}, {0.02, 0.02, 0}, {0, 0.02, 0}};
    mesh.uv = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {1, 5}, {0, 5}, {0, 6}, {1, 6}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}};
    Renderer renderer(textured_scene(mesh, compiled(mapped_source), "printed"));
    renderer.tick(at(-0.01, 0.01, 1e-3));
    for (double x = -0.0195; x < 0.0195; x += 0.37e-3)
        for (double y = 1e-3; y < 0.019; y += 1.1e-3) {
            const bool right = x > 0;
            const dvec2 uv(right ? 1 - x / 0.02 : 1 + x / 0.02, (right ? 5 : 0) + y / 0.02);
            const TickResult result = renderer.tick(at(x, y, -0.5e-3));
            CHECK(std::abs(result.height_m - printed_m(uv)) < 1e-13);
            CHECK(std::abs(result.force_n.x + result.force_n.z * (right ? -1 : 1) * printed_slope_m(uv).x / 0.02) <
                  1e-8);
        }
}

TEST_CASE("on every shape each map's gradient is that of its height along the surface")
{
    const auto program = compiled(mapped_source);
    std::mt19937_64 random(12);
    int number = 0;
    for (const std::string_view shape : shape_names) {
        if (is_sanitized && ++number % 3 != 0) continue;
        Mesh mesh = *make_shape(shape);
        scale_to_size(mesh, 0.1);
        const auto surface = build_surface(mesh).surface;
        for (const char* texture :
             {"plane_mapped", "sphere_mapped", "cylinder_mapped", "cube_mapped", "in_three_planes", "printed"}) {
            if (std::string_view(texture) == "printed" && surface->uv.empty()) continue;
            CAPTURE(shape, texture);
            const TextureBinding binding = bound_for(program, texture, *surface);
            double steepest = 0, worst = 0;
            int seams = 0;
            for (int i = 0; i < tries(400); ++i) {
                const uint32_t face = uint32_t(random() % surface->faces.size()), side = uint32_t(i % 2);
                const dvec3 w = random_weights(random);
                const TextureSample here = sample_texture(binding, point_on(*surface, face, side, w));
                CHECK(here.faults == 0);
                for (const dvec3& way : {dvec3(1, -1, 0), dvec3(-0.4, -0.6, 1)}) {
                    // A thousandth of the shortest wavelength, 1.5 mm.
                    const dvec3 change = way * (1.5e-6 / glm::distance(point_on(*surface, face, side, w).p_m,
                                                                       point_on(*surface, face, side, w + way).p_m));
                    const SurfacePoint ahead = point_on(*surface, face, side, w + change);
                    const SurfacePoint behind = point_on(*surface, face, side, w - change);
                    const dvec3 step = ahead.p_m - behind.p_m;
                    const double difference =
                        (sample_texture(binding, ahead).height_m - sample_texture(binding, behind).height_m) /
                        glm::length(step);
                    if (std::abs(difference) > 1) { // over a seam of the map
                        ++seams;
                        continue;
                    }
                    // The gradient as the texture says it; a tick takes what is tangential to the shaded normal.
                    haptel_point point{};
                    const SurfacePoint p = point_on(*surface, face, side, w);
                    for (int k = 0; k < 3; ++k) {
                        point.p[k] = p.p_m[k];
                        point.n[k] = p.shading.normal[k];
                        for (int j = 0; j < 3; ++j) point.n_dp[k][j] = p.shading.normal_dp[j][k];
                        for (int a = 0; a < 2; ++a) point.uv_dp[a][k] = p.shading.uv_dp[k][a];
                    }
                    for (int a = 0; a < 2; ++a) point.uv[a] = p.shading.uv[a];
                    haptel_sample sample{};
                    binding.texture->height_gradient(&point, binding.block, &sample);
                    const dvec3 gradient(sample.gradient[0], sample.gradient[1], sample.gradient[2]);
                    worst = std::max(worst, std::abs(glm::dot(gradient, glm::normalize(step)) - difference));
                    steepest = std::max(steepest, glm::length(gradient));
                }
            }
            CHECK(worst < 1e-4 * steepest + 1e-8);
            CHECK(seams <= 2);
            CHECK((steepest > 1e-3 || shape == "plane")); // of the plane the sphere's maps see the equator alone
        }
    }
}

TEST_CASE("bounds of a texture that reads the normal hold on the mesh that it is bound for")
{
    const auto program = compiled(mapped_source);
    for (const std::string_view shape : {"icosphere", "torus", "sphere"}) {
        Mesh mesh = *make_shape(shape);
        scale_to_size(mesh, 0.1);
        const auto surface = build_surface(mesh).surface;
        const TextureBinding binding = bound_for(program, "in_three_planes", *surface, {}, {}, 0, jit::For::figures);
        std::mt19937_64 random(8);
        double steepest = 0, highest = -1, lowest = 1;
        for (int i = 0; i < tries(20000); ++i) {
            const SurfacePoint point =
                point_on(*surface, uint32_t(random() % surface->faces.size()), uint32_t(i % 2), random_weights(random));
            steepest = std::max(steepest, slope_of(binding, point));
            const double h = sample_texture(binding, point).height_m;
            highest = std::max(highest, h);
            lowest = std::min(lowest, h);
        }
        CAPTURE(shape, steepest, binding.facts.slope_max);
        CHECK(steepest <= binding.facts.slope_max);
        CHECK(binding.facts.slope_max < 6 * steepest);
        CHECK((lowest >= binding.facts.height_min_m && highest <= binding.facts.height_max_m));

        // Without that knowledge there is no bound.
        TextureRequest unknown = request_over(0.1);
        CHECK(std::isinf(
            jit::make_binding(program, "in_three_planes", unknown, jit::For::figures).binding->facts.slope_max));
        if (is_sanitized) break; // which takes long to bind them
    }
}

TEST_CASE("bounds of a texture that reads mesh coordinates hold on the mesh that it is bound for, and are near")
{
    const auto program = compiled(mapped_source);
    for (const std::string_view shape : {"plane", "box", "sphere", "torus", "drawn"}) {
        Mesh mesh = shape == "drawn" ? drawn_plane(0.1, 5, glm::dmat2(4, 1, -3, 2), dvec2(7, 0)) : *make_shape(shape);
        scale_to_size(mesh, 0.1);
        const auto surface = build_surface(mesh).surface;
        const TextureBinding binding = bound_for(program, "printed", *surface, {}, {}, 0, jit::For::figures);
        const UvFigures figures = uv_figures(*surface);
        std::mt19937_64 random(8);
        double steepest = 0;
        for (int i = 0; i < tries(20000); ++i) {
            const SurfacePoint point =
                point_on(*surface, uint32_t(random() % surface->faces.size()), uint32_t(i % 2), random_weights(random));
            steepest = std::max(steepest, slope_of(binding, point));
            for (int k = 0; k < 2; ++k) {
                CHECK((point.shading.uv[k] >= figures.minimum[k] && point.shading.uv[k] <= figures.maximum[k]));
                double squares = 0;
                for (int j = 0; j < 3; ++j) {
                    const double partial = point.shading.uv_dp[j][k];
                    CHECK((partial >= figures.dp_minimum[k][j] && partial <= figures.dp_maximum[k][j]));
                    squares += partial * partial;
                }
                CHECK(std::sqrt(squares) <= figures.slope_max_per_m[k]);
            }
        }
        CAPTURE(shape, steepest, binding.facts.slope_max);
        CHECK(steepest <= binding.facts.slope_max);
        // At the poles of the sphere the coordinates crowd together, where no random point comes.
        CHECK(binding.facts.slope_max < (shape == "sphere" ? 40 : 4) * steepest);
        CHECK(std::isinf(
            jit::make_binding(program, "printed", request_over(0.1), jit::For::figures).binding->facts.slope_max));
    }
    const auto ball = build_surface(make_icosphere(2)).surface; // has none
    CHECK((uv_figures(*ball).maximum[0] == 0 && uv_figures(*ball).slope_max_per_m[1] == 0));
    CHECK(bound_for(program, "printed", *ball, {}, {}, 0, jit::For::figures).facts.slope_max == 0);
}
