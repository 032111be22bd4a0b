// What the hand feels of a plain wall: its normal alone, from zero on.
#include "runtime/render/renderer.h"
#include "tests/anchors/geodesic.h"
#include "tests/support/catch.h"
#include "tests/support/lambda_texture.h"
#include "tests/support/touch_scenes.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <utility>

using namespace haptel;
using namespace haptel::runtime;
using namespace haptel::test;
using namespace haptel::tests;
using glm::dvec3;

namespace {

// About an axis that is none of the coordinates'.
glm::dmat3 turned(double angle)
{
    const dvec3 axis = glm::normalize(dvec3(1, 2, 3));
    glm::dmat3 rotation;
    for (int j = 0; j < 3; ++j) { // Rodrigues
        dvec3 e(0);
        e[j] = 1;
        rotation[j] = std::cos(angle) * e + std::sin(angle) * glm::cross(axis, e) +
                      (1 - std::cos(angle)) * glm::dot(axis, e) * axis;
    }
    return rotation;
}

struct Probe {
    std::string name;
    ProbeSettings settings;
};
const Probe probes[] = {{"point", {ProbeKind::point, 0, 0}},
                        {"sphere", {ProbeKind::sphere, 0, 5e-3}},
                        {"stylus", {ProbeKind::stylus, 0.1, 0}}};

// A square plate of 1 m with its normal along `normal`, which a frictionless probe strokes wildly.
class Plate {
public:
    enum class Turned { as_a_whole, by_its_vertices };

    Plate(const Probe& probe, uint32_t cells, Turned how) : probe_(probe)
    {
        Mesh mesh = plane_mesh(1, cells);
        if (how == Turned::by_its_vertices)
            for (dvec3& p : mesh.positions_m) p = rotation_ * p;
        Scene scene = bare_scene(mesh);
        scene.probe = probe.settings;
        if (how == Turned::as_a_whole) scene.objects[0].placement.rotation = rotation_;
        vertex_spacing_m_ = Lattice::vertex_spacing * scene.objects[0].surface->lattice.unit_m;
        renderer_.emplace(shared(std::move(scene)));
        tick(0, 0, -1e-3);
    }

    // The largest tangential over the normal force of many ticks, of a micrometre up to step_max_m.
    double stroke(double step_max_m)
    {
        std::mt19937_64 random(7);
        std::uniform_real_distribution<double> place_m(-0.45, 0.45), step(-6, std::log10(step_max_m)), depth(-5, -2);
        double x = 0, y = 0, worst = 0;
        for (int i = 0; i < 4000; ++i) {
            const double to_x = place_m(random) - x, to_y = place_m(random) - y, depth_m = std::pow(10, depth(random));
            const double share = std::min(1.0, std::pow(10, step(random)) / std::hypot(to_x, to_y));
            x += share * to_x;
            y += share * to_y;
            const dvec3 force = tick(x, y, depth_m);
            const double along_n = glm::dot(force, normal_);
            REQUIRE(std::abs(along_n - spring_n_per_m * depth_m) < 1e-7);
            worst = std::max(worst, glm::length(force - along_n * normal_) / along_n);
        }
        return worst;
    }

    double vertex_spacing_m() const { return vertex_spacing_m_; }

private:
    dvec3 tick(double x, double y, double depth_m)
    {
        const dvec3 tip = rotation_ * dvec3(x, y, probe_.settings.radius_m - depth_m);
        return renderer_->tick({tip, tip + 0.1 * normal_}).force_n;
    }

    Probe probe_;
    glm::dmat3 rotation_ = turned(0.7);
    dvec3 normal_ = rotation_ * dvec3(0, 0, 1);
    std::optional<Renderer> renderer_;
    double vertex_spacing_m_ = 0;
};

} // namespace

TEST_CASE("anchors row 4: a frictionless plane gives no tangential force at any speed")
{
    for (const Probe& probe : probes)
        for (const uint32_t cells : {1u, 7u, 64u, 256u}) {
            CAPTURE(probe.name, cells);
            // A ball among many triangles goes three radii a tick and no farther.
            const double step_max_m = probe.settings.radius_m > 0 ? 3 * probe.settings.radius_m : 1;
            CHECK(Plate(probe, cells, Plate::Turned::as_a_whole).stroke(step_max_m) <= 1e-9);
            // Vertices off the plane by rounding to their lattice tilt its facets by this much.
            Plate rounded(probe, cells, Plate::Turned::by_its_vertices);
            CHECK(rounded.stroke(step_max_m) <= std::max(1e-9, 2 * cells * rounded.vertex_spacing_m()));
        }
}

TEST_CASE("anchors row 5: the first contact is below 1.001 mN at 1 um approach, and no later micrometre adds more")
{
    constexpr double approach_m = 1e-6;
    // A smooth surface that rises while the hand gets deeper is so much harder (runtime/force/foot.cpp).
    constexpr double harder = 1.7;
    Mesh bumpy = BumpySphere::mesh(19), box = make_box({0.04, 0.06, 0.08});
    scale_to_size(bumpy, 0.1);
    struct Case {
        std::string name;
        Mesh mesh;
        dvec3 above, toward; // from where, and the unit way
        bool textured = false, smooth = false;
    };
    const dvec3 corner(0.02, 0.03, 0.04);
    const Case cases[] = {
        {"plane", plane_mesh(0.1, 9), {0.0123, 0.0071, 0}, {0, 0, -1}},
        {"plane, on an edge", plane_mesh(0.1, 8), {0, 0.0071, 0}, {0, 0, -1}},
        {"plane, on a vertex", plane_mesh(0.1, 8), {0, 0, 0}, {0, 0, -1}},
        {"plane, textured", plane_mesh(0.1, 9), {0.00025, 0.0071, 0}, {0, 0, -1}, true},
        {"edge of a box", box, {0.02, 0.001, 0.04}, -glm::normalize(dvec3(1, 0, 1))},
        {"corner of a box", box, corner, -glm::normalize(corner)},
        {"bumpy sphere", bumpy, 0.05 * glm::normalize(dvec3(1, 2, 3)), -glm::normalize(dvec3(1, 2, 3)), false, true}};
    for (const Probe& probe : probes)
        for (const Case& c : cases)
            for (const double phase : {0.01, 0.5, 0.99}) { // where between two ticks the surface is
                CAPTURE(probe.name, c.name, phase);
                Scene scene = bare_scene(c.mesh, c.textured ? sine_texture(60e-6, 1e-3) : TextureBinding{});
                scene.probe = probe.settings;
                scene.objects[0].material = Material{};
                scene.objects[0].material.stiffness_n_per_m = spring_n_per_m;
                Renderer renderer(shared(std::move(scene)));
                double before_n = 0;
                bool touched = false;
                for (int i = 0; before_n < 0.05; ++i) {
                    REQUIRE(i < 8000);
                    const double way_m = (i + phase) * approach_m - probe.settings.radius_m - 2e-3;
                    const dvec3 tip = c.above + way_m * c.toward;
                    const double force_n = glm::length(renderer.tick({tip, tip - 0.1 * c.toward}).force_n);
                    // The way, and damping: 1 N s/m at 1 mm/s, which sets in over the first millimetre. Later the
                    // shaded normal is not quite at a right angle to what friction holds.
                    REQUIRE(force_n - before_n <= (touched ? 1.01e-3 : 1.001e-3) * (c.smooth ? harder : 1));
                    touched = force_n > 0;
                    before_n = force_n;
                }
            }
}
