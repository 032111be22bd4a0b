// The smooth surface for which facets stand: its force is that of one potential, and near that of the true shape.
#include "runtime/force/foot.h"
#include "runtime/render/renderer.h"
#include "tests/runtime/surface/meshes.h"
#include "tests/support/catch.h"
#include "tests/support/lambda_texture.h"
#include "tests/support/touch_scenes.h"
#include "tests/support/tries.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

using namespace haptel;
using namespace haptel::runtime;
using namespace haptel::test;
using namespace haptel::tests;
using glm::dvec3;

namespace {

constexpr double pi = 3.14159265358979323846;
constexpr double stiffness = 1000; // N/m
constexpr double size_m = 0.1, ball_m = size_m / 2;

Mesh ball_of(uint32_t subdivisions)
{
    Mesh mesh = make_icosphere(subdivisions);
    scale_to_size(mesh, size_m);
    return mesh;
}

// Up to 2 `amplitude_m` high, of a wavelength of some 3 mm.
TextureBinding solid_texture(double amplitude_m)
{
    return lambda_texture(
        [=](const haptel_point& at, dvec3& gradient) {
            const double a = 2000 * at.p[0] + 1300 * at.p[1], b = 1700 * at.p[2];
            gradient = amplitude_m * dvec3(2000 * std::cos(a) * std::cos(b), 1300 * std::cos(a) * std::cos(b),
                                           -1700 * std::sin(a) * std::sin(b));
            return amplitude_m * std::sin(a) * std::cos(b);
        },
        -amplitude_m, amplitude_m, HAPTEL_READS_POINT);
}

// A closed path below one place of the surface.
struct Path {
    dvec3 from, normal, along, across;
    double width_m, breadth_m, depth_m, swing_m;
    int swings;

    dvec3 at(double turns) const
    {
        const double a = 2 * pi * turns;
        return from + width_m * std::cos(a) * along + breadth_m * std::sin(a) * across -
               (depth_m + swing_m * std::sin(swings * a + 1)) * normal;
    }
};

// Random ones, to a tenth of the size deep, from a tenth of an edge to thirty wide.
Path random_path(const Surface& surface, double edge_m, std::mt19937_64& random)
{
    const auto uniform = [&](double from, double to) {
        return std::uniform_real_distribution<double>(from, to)(random);
    };
    const auto between = [&](double from, double to) { return std::exp(uniform(std::log(from), std::log(to))); };
    const auto face = static_cast<uint32_t>(uniform(0, static_cast<double>(surface.faces.size())));
    Path path;
    path.from = (surface.vertex_m(face, 0) + surface.vertex_m(face, 1) + surface.vertex_m(face, 2)) / 3.0;
    path.normal = surface.facet_normal(face);
    path.along = glm::normalize(surface.vertex_m(face, 1) - surface.vertex_m(face, 0));
    path.across = glm::cross(path.normal, path.along);
    path.width_m = std::min(0.3 * size_m, edge_m * between(0.1, 30));
    path.breadth_m = uniform(0.3, 1) * path.width_m;
    path.depth_m = between(1e-3, 0.05) * size_m;
    path.swing_m = uniform(0.2, 0.9) * path.depth_m;
    path.swings = 1 + static_cast<int>(uniform(0, 3));
    return path;
}

double edge_of(const Surface& surface)
{
    double sum = 0;
    for (uint32_t face = 0; face < surface.faces.size(); ++face)
        sum += glm::distance(surface.vertex_m(face, 0), surface.vertex_m(face, 1));
    return sum / static_cast<double>(surface.faces.size());
}

struct Work {
    double given_j = 0, pressed_j = 0;
};

// On the second time round: what contact remembers has settled.
Work work_once_round(const std::shared_ptr<const Scene>& scene, const Path& path, int steps)
{
    Renderer renderer(scene);
    const double above_m = scene->probe.radius_m + 0.05 * size_m;
    const auto pose = [&](const dvec3& p) {
        DevicePose held{p, p};
        if (scene->probe.has_tail()) held.tail_m = p + 0.1 * path.normal;
        return held;
    };
    renderer.tick(pose(path.from + above_m * path.normal));
    Work work;
    dvec3 before_m(0), before_n(0);
    for (int i = 0; i <= 2 * steps; ++i) {
        const dvec3 at_m = path.at(static_cast<double>(i) / steps) + scene->probe.radius_m * path.normal;
        const TickResult tick = renderer.tick(pose(at_m));
        if (i > steps) work.given_j += glm::dot(0.5 * (tick.force_n + before_n), at_m - before_m);
        work.pressed_j = std::max(work.pressed_j, 0.5 * stiffness * tick.depth_m * tick.depth_m);
        before_m = at_m;
        before_n = tick.force_n;
    }
    return work;
}

// Over what was pressed in; of finer and finer steps the first that is below what is allowed, or the finest.
double share_given(const std::shared_ptr<const Scene>& scene, const Path& path, double allowed)
{
    double share = 0;
    for (int steps = 1000; steps < 3'000'000; steps *= 2) {
        const Work work = work_once_round(scene, path, steps);
        share = work.pressed_j > 0 ? std::fabs(work.given_j) / work.pressed_j : 0;
        if (share < allowed) break;
    }
    return share;
}

} // namespace

TEST_CASE("on balls of triangles closed paths give no energy")
{
    const ProbeSettings point, ball{ProbeKind::sphere, 0.15, 2.5e-3}, stylus{ProbeKind::stylus, 0.15, 0};
    for (const ProbeSettings& probe : {point, ball, stylus})
        for (const double texture_m : {0.0, 25e-6}) {
            double allowed = 1e-1;
            for (const uint32_t subdivisions : {2u, 3u, 4u, 5u}) {
                allowed /= 10;
                Scene scene =
                    bare_scene(ball_of(subdivisions), texture_m > 0 ? solid_texture(texture_m) : TextureBinding());
                scene.probe = probe;
                const auto touched = shared(std::move(scene));
                const Surface& surface = *touched->objects[0].surface;
                const double edge_m = edge_of(surface);
                std::mt19937_64 random(7);
                for (int i = 0; i < tries(20); ++i) {
                    const Path path = random_path(surface, edge_m, random);
                    CAPTURE(int(probe.kind), texture_m, subdivisions, i, path.width_m, path.depth_m, path.swing_m);
                    CHECK(share_given(touched, path, allowed) < allowed);
                }
            }
        }
}
