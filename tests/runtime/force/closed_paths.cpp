// Closed paths of the hand: the force of round meshes gives no energy on them.
#include "runtime/render/renderer.h"
#include "tests/runtime/contact/long_run.h"
#include "tests/support/catch.h"
#include "tests/support/lambda_texture.h"
#include "tests/support/touch_scenes.h"
#include "tests/support/tries.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>
#include <string>
#include <vector>

using namespace haptel;
using namespace haptel::runtime;
using namespace haptel::test;
using namespace haptel::tests;
using glm::dvec3;

namespace {

constexpr double across_m = 0.1;

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
        const double a = 2 * std::numbers::pi * turns;
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
    path.width_m = std::min(0.3 * across_m, edge_m * between(0.1, 30));
    path.breadth_m = uniform(0.3, 1) * path.width_m;
    path.depth_m = between(1e-3, 0.05) * across_m;
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
    double given_j = 0;
    double pressed_j = 0; // by the depth of the tip, or by the hand on its way, if that is more, as of a shaft
    double deepest_m = 0;
    bool steps = false; // the force, by more than a thousandth of what presses and 50 times as fast as that does
};

// On the second time round: what contact remembers has settled. A stylus turns a little on its way.
Work work_once_round(const std::shared_ptr<const Scene>& scene, const Path& path, int steps)
{
    Renderer renderer(scene);
    const double above_m = scene->probe.radius_m + 0.05 * across_m;
    const auto pose = [&](const dvec3& tip_m, double turns) {
        DevicePose held{tip_m, tip_m};
        if (!scene->probe.has_tail()) return held;
        const double a = 2 * std::numbers::pi * turns;
        held.tail_m += 0.1 * glm::normalize(path.normal + 0.01 * std::sin(2 * a) * path.along +
                                            0.015 * std::cos(3 * a) * path.across);
        return held;
    };
    renderer.tick(pose(path.from + above_m * path.normal, 0));
    Work work;
    double least_j = 0, most_j = 0;
    DevicePose before;
    TickResult felt;
    for (int i = 0; i <= 2 * steps; ++i) {
        const double turns = static_cast<double>(i) / steps;
        const DevicePose held = pose(path.at(turns) + scene->probe.radius_m * path.normal, turns);
        const TickResult tick = renderer.tick(held);
        if (i > steps) {
            const dvec3 from_m = before.tail_m - before.tip_m, to_m = held.tail_m - held.tip_m,
                        way_m = held.tip_m - before.tip_m;
            dvec3 turned_rad(0);
            if (scene->probe.has_tail()) turned_rad = glm::cross(from_m, to_m) / glm::dot(from_m, from_m);
            // The grip is the tail.
            const dvec3 grip_m = scene->probe.has_tail() ? held.tail_m - before.tail_m : way_m;
            work.given_j += 0.5 * (glm::dot(felt.force_n + tick.force_n, grip_m) +
                                   glm::dot(felt.torque_n_m + tick.torque_n_m, turned_rad));
            least_j = std::min(least_j, work.given_j);
            most_j = std::max(most_j, work.given_j);
            const double step_n = glm::distance(tick.force_n, felt.force_n),
                         hand_m = std::max(glm::length(way_m), glm::length(grip_m));
            work.steps |= step_n > spring_n_per_m * std::max(50 * hand_m, 1e-3 * work.deepest_m);
        }
        work.deepest_m = std::max(work.deepest_m, tick.depth_m);
        before = held;
        felt = tick;
    }
    work.pressed_j = std::max(0.5 * spring_n_per_m * work.deepest_m * work.deepest_m, most_j - least_j);
    return work;
}

// Over what was pressed in; of finer and finer steps the first that is below what is allowed, or the finest.
double share_given(const std::shared_ptr<const Scene>& scene, const Path& path, double allowed)
{
    double share = 0;
    for (int steps = 1000; steps < 8'000'000; steps *= 2) {
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
                Scene scene = bare_scene(ball_mesh(subdivisions, across_m),
                                         texture_m > 0 ? solid_texture(texture_m) : TextureBinding());
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

TEST_CASE("in hollow balls of triangles closed paths give no energy")
{
    // A ball rests on several facets there (runtime/render/smooth_rows.h).
    for (const ProbeSettings& probe : {ProbeSettings{}, ProbeSettings{ProbeKind::sphere, 0.15, 5e-3}}) {
        double allowed = 1e-2;
        for (const uint32_t subdivisions : {3u, 4u}) {
            allowed /= 10;
            Scene scene = bare_scene(ball_mesh(subdivisions, across_m), solid_texture(25e-6));
            scene.probe = probe;
            const auto touched = shared(std::move(scene));
            const Surface& surface = *touched->objects[0].surface;
            const double edge_m = edge_of(surface);
            std::mt19937_64 random(17);
            for (int i = 0; i < tries(20); ++i) {
                Path path = random_path(surface, edge_m, random);
                path.normal = -path.normal;
                CAPTURE(int(probe.kind), subdivisions, i, path.width_m, path.depth_m, path.swing_m);
                CHECK(share_given(touched, path, allowed) < allowed);
            }
        }
    }
}

TEST_CASE("in hollow balls not much wider than a ball with a texture closed paths give no energy")
{
    // There the flat facets are felt, too: the place goes on them the farther, the less deep the hand is.
    Scene scene = bare_scene(ball_mesh(3, 0.02), solid_texture(50e-6));
    scene.probe = {ProbeKind::sphere, 0.15, 6e-3};
    const auto touched = shared(std::move(scene));
    const Surface& surface = *touched->objects[0].surface;
    std::mt19937_64 random(5);
    for (int i = 0; i < tries(20); ++i) {
        Path path = random_path(surface, 2e-3, random);
        path.normal = -path.normal;
        path.depth_m = 0.2e-3 * (1 + i % 5);
        path.swing_m = 0.5 * path.depth_m;
        CAPTURE(i, path.width_m, path.depth_m);
        const Work work = work_once_round(touched, path, 20'000);
        CHECK(std::fabs(work.given_j) < 1e-4 * work.pressed_j);
    }
}

TEST_CASE("across the hole of a ring a stylus on its tip and its shaft gives less than a hundredth on closed paths")
{
    // Both hold it together: where a texture lets the tip go deeper, the shaft turns about where it rests.
    for (const double texture_m : {0.0, 50e-6}) {
        Scene scene = bare_scene(shape("torus", across_m), texture_m > 0 ? solid_texture(texture_m) : TextureBinding());
        scene.probe = {ProbeKind::stylus, 0.15, 0};
        const auto touched = shared(std::move(scene));
        const Surface& surface = *touched->objects[0].surface;
        const double edge_m = edge_of(surface);
        std::mt19937_64 random(19);
        for (int i = 0; i < tries(20);) {
            Path path = random_path(surface, edge_m, random);
            // From here it goes up by the other side.
            if (glm::length(glm::dvec2(path.from)) > 0.23 * across_m || path.from.z < 0.01 * across_m) continue;
            path.width_m = std::min(path.width_m, 2e-3);
            path.depth_m = std::min(path.depth_m, 2e-3);
            path.swing_m = 0.5 * path.depth_m;
            CAPTURE(texture_m, i, path.width_m, path.depth_m);
            const Work work = work_once_round(touched, path, 20'000);
            CHECK(std::fabs(work.given_j) < 1e-2 * work.pressed_j);
            ++i;
        }
    }
}

namespace {

// A ball on both flanks, which hold it together (runtime/render/held_together.h).
void check_in_valley(double height_m, uint32_t cells, double allowed)
{
    Mesh valley = plane_mesh(0.04, cells);
    for (dvec3& p : valley.positions_m)
        p.z = height_m * (1 + 0.3 * std::sin(p.y / 0.006)) * (1 - std::cos(p.x * std::numbers::pi / 0.01));
    for (const double texture_m : {0.0, 25e-6}) {
        Scene scene = bare_scene(valley, texture_m > 0 ? solid_texture(texture_m) : TextureBinding());
        scene.probe = ProbeSettings{ProbeKind::sphere, 0.15, 4e-3};
        const auto touched = shared(std::move(scene));
        std::mt19937_64 random(3);
        const auto uniform = [&](double from, double to) {
            return std::uniform_real_distribution<double>(from, to)(random);
        };
        for (int i = 0; i < tries(20); ++i) {
            Path path;
            path.from = dvec3(uniform(-1e-3, 1e-3), 0, 1e-3);
            path.from.y = uniform(-5e-3, 5e-3);
            path.normal = dvec3(0, 0, 1);
            path.along = dvec3(1, 0, 0);
            path.across = dvec3(0, 1, 0);
            path.width_m = uniform(0.2e-3, 2e-3);
            path.breadth_m = uniform(0.2e-3, 4e-3);
            path.depth_m = uniform(0.3e-3, 2e-3);
            path.swing_m = uniform(0.2, 0.9) * path.depth_m;
            path.swings = 1 + i % 3;
            CAPTURE(texture_m, i, path.width_m, path.breadth_m, path.depth_m, path.swing_m);
            const Work work = work_once_round(touched, path, 20'000);
            CHECK(std::fabs(work.given_j) < (texture_m > 0 ? 1e-2 : allowed) * work.pressed_j);
        }
    }
}

} // namespace

TEST_CASE("in a smooth valley narrower than the ball closed paths give less than a thousandth, textured a hundredth")
{
    check_in_valley(0.005, 160, 4e-4);
}

TEST_CASE("in a smooth valley of few facets closed paths give less than two thousandths, textured a hundredth")
{
    check_in_valley(0.005, 60, 2e-3);
}

TEST_CASE("in a smooth valley whose flanks are nearer to each other than a right angle closed paths give as little")
{
    check_in_valley(0.012, 160, 1e-3);
}

namespace {

struct Given {
    std::vector<double> share; // of each path: of what was pressed in; less than 0: taken

    double quantile(double q, double sign) const
    {
        std::vector<double> sorted;
        for (const double one : share) sorted.push_back(sign == 0 ? std::fabs(one) : sign * one);
        std::sort(sorted.begin(), sorted.end());
        return sorted.empty() ? 0 : sorted[static_cast<std::size_t>(q * static_cast<double>(sorted.size() - 1))];
    }
};

// Edges at which the smooth surface ends: creases, and borders.
using Edges = std::vector<std::array<dvec3, 2>>;

Edges creases_of(const Surface& surface)
{
    Edges creases;
    for (uint32_t face = 0; face < surface.faces.size(); ++face)
        for (uint32_t edge = 0; edge < 3; ++edge) {
            const Face& here = surface.faces[face];
            const SideEdge link = here.link[edge][0];
            const Face& there = surface.faces[link.face()];
            std::array<uint32_t, 2> mine{here.fan_or_part[edge][0], here.fan_or_part[next(edge)][0]},
                other{there.fan_or_part[link.edge()][link.side()], there.fan_or_part[next(link.edge())][link.side()]};
            if (here.vertex[edge] != there.vertex[link.edge()]) std::swap(other[0], other[1]);
            if (link.face() == face || mine != other)
                creases.push_back({surface.vertex_m(face, edge), surface.vertex_m(face, next(edge))});
        }
    return creases;
}

// Whether the proxy may come to one of them, straight above the hand.
bool meets(const Edges& edges, const Path& path, double radius_m)
{
    const double reach_m = 1.5 * (path.depth_m + path.swing_m) + radius_m;
    for (int i = 0; i < 64; ++i) {
        const dvec3 hand = path.at(i / 64.0);
        for (const auto& [from, to] : edges) {
            const dvec3 way = to - from;
            const double along = std::clamp(glm::dot(hand - from, way) / glm::dot(way, way), 0.0, 1.0);
            if (glm::distance(hand, from + along * way) < reach_m) return true;
        }
    }
    return false;
}

struct Settled {
    double share = 0;    // of what was pressed in
    bool counts = false; // it touches, and goes no deeper than a tenth of the size
    bool steps = false;  // the force, however small the steps of the hand: the proxy jumps
};

// Finer and finer, until it has twice changed by less than a tenth or is less than `enough`.
Settled share_settled(const std::shared_ptr<const Scene>& scene, const Path& path, double enough)
{
    double before = 0;
    int settled = 0;
    for (int steps = 1000;; steps *= 2) {
        const Work work = work_once_round(scene, path, steps);
        if (!(work.deepest_m > 0 && work.deepest_m < 0.1 * across_m)) return {};
        const double share = work.given_j / work.pressed_j;
        settled = std::fabs(share - before) < 0.1 * std::fabs(share) ? settled + 1 : 0;
        if (std::fabs(share) < enough || ((settled >= 2 || work.steps) && steps > 100'000) || steps > 5'000'000)
            return {share, true, std::fabs(share) >= enough && work.steps};
        before = share;
    }
}

} // namespace

// Away from creases. HAPTEL_TEST_MESHES: files, parted by colons. HAPTEL_TEST_PATHS: of each mesh, probe and texture
// [300].
TEST_CASE("closed paths give no energy: long run", "[.long]")
{
    std::vector<NamedMesh> meshes;
    for (const uint32_t subdivisions : {2u, 3u, 4u, 5u})
        meshes.push_back(
            {"ball of " + std::to_string(20u << 2 * subdivisions) + " triangles", ball_mesh(subdivisions, across_m)});
    Mesh ellipsoid = make_icosphere(4);
    for (dvec3& p : ellipsoid.positions_m) p *= dvec3(1, 0.7, 0.5);
    meshes.push_back({"ellipsoid of 5120 triangles", ellipsoid});
    meshes.push_back({"torus", shape("torus", across_m)});
    const std::size_t round = meshes.size();
    for (NamedMesh& mesh : meshes_of_environment())
        if (mesh.name.find("far away") == std::string::npos) meshes.push_back(std::move(mesh));
    const auto paths = static_cast<int>(number_of_environment("HAPTEL_TEST_PATHS", 300));

    for (std::size_t m = 0; m < meshes.size(); ++m) {
        scale_to_size(meshes[m].mesh, across_m);
        for (const ProbeSettings& probe : {ProbeSettings{}, ProbeSettings{ProbeKind::sphere, 0.15, 2.5e-3},
                                           ProbeSettings{ProbeKind::stylus, 0.15, 0}})
            for (const double texture_m : {0.0, 5e-6, 100e-6})
                for (const ForceShading shading : {ForceShading::smooth, ForceShading::paper}) {
                    if (shading == ForceShading::paper && texture_m > 0) continue;
                    Scene scene =
                        bare_scene(meshes[m].mesh, texture_m > 0 ? solid_texture(texture_m / 2) : TextureBinding());
                    scene.probe = probe;
                    scene.servo.force.shading = shading;
                    const auto touched = shared(std::move(scene));
                    const Surface& surface = *touched->objects[0].surface;
                    const Edges creases = creases_of(surface);
                    const double edge_m = edge_of(surface);
                    std::mt19937_64 random(7);
                    Given smooth, stepping;
                    std::vector<std::pair<double, Path>> above;
                    for (int i = 0, drawn = 0; i < paths && drawn < 100 * paths; ++drawn) {
                        const Path path = random_path(surface, edge_m, random);
                        if (meets(creases, path, probe.radius_m)) continue;
                        const Settled found = share_settled(touched, path, 5e-6);
                        if (!found.counts) continue;
                        ++i;
                        (found.steps ? stepping : smooth).share.push_back(found.share);
                        const double most = found.steps ? found.share : std::fabs(found.share); // jumps take energy
                        if (most > 1e-3 && shading == ForceShading::smooth) above.emplace_back(found.share, path);
                    }
                    std::printf("%s, %s, texture of %.0f um, %s:\n", meshes[m].name.c_str(),
                                probe.kind == ProbeKind::point    ? "point"
                                : probe.kind == ProbeKind::sphere ? "ball"
                                                                  : "stylus",
                                1e6 * texture_m,
                                std::string(force_shading_names[static_cast<std::size_t>(shading)]).c_str());
                    for (const Given* given : {&smooth, &stepping})
                        if (!given->share.empty())
                            std::printf("  %zu paths %s: |work| median %.0e p99 %.0e, given most %.0e, taken most "
                                        "%.0e\n",
                                        given->share.size(),
                                        given == &smooth ? "without a step" : "on which the force steps",
                                        given->quantile(0.5, 0), given->quantile(0.99, 0), given->quantile(1, 1),
                                        given->quantile(1, -1));
                    for (const auto& [share, path] : above)
                        std::printf("    %.0e at (%.2f %.2f %.2f) mm, %.2f mm deep, %.2f mm wide\n", share,
                                    1e3 * path.from.x, 1e3 * path.from.y, 1e3 * path.from.z,
                                    1e3 * (path.depth_m + path.swing_m), 1e3 * path.width_m);
                    std::fflush(stdout);
                    if (shading == ForceShading::paper) continue;
                    const double allowed = m < 4 ? std::pow(10.0, -2.0 - static_cast<double>(m)) : 1e-3;
                    if (m < round) CHECK(smooth.quantile(0.99, 0) < allowed);
                }
    }
}
