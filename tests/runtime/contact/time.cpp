// How long a tick of contact takes, by size of the mesh. Reported, never asserted: run it with contact_test "[.time]".
#include "runtime/contact/sphere_contact.h"
#include "runtime/contact/stylus_contact.h"
#include "runtime/contact/walk_contact.h"

#include "tests/runtime/surface/meshes.h"
#include "tests/support/catch.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

using namespace haptel::runtime;
using namespace haptel::test;
using glm::dvec3;

namespace {

// A stroke over the bumpy sphere at 1 mm per tick, its radius 1 m, `offset` metres from the surface.
std::vector<dvec3> make_stroke(const std::function<double(int)>& offset_m)
{
    std::vector<dvec3> stroke;
    for (int i = 0; i < 200000; ++i) {
        const double angle = 1e-3 * i, height = 0.7 * std::sin(0.37 * angle);
        const dvec3 d(std::cos(angle) * std::sqrt(1 - height * height),
                      std::sin(angle) * std::sqrt(1 - height * height), height);
        stroke.push_back(d * (bumpy_radius(d) + offset_m(i)));
    }
    return stroke;
}

template <class Update>
void report(const char* what, size_t triangles, const std::vector<dvec3>& stroke, Update&& update)
{
    std::vector<double> times_ns;
    for (const dvec3& hand : stroke) {
        const auto begin = std::chrono::steady_clock::now();
        update(hand);
        times_ns.push_back(std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - begin).count());
    }
    std::sort(times_ns.begin(), times_ns.end());
    const auto share = [&](double s) { return times_ns[size_t(s * double(times_ns.size() - 1))]; };
    std::printf("%-32s %8zu triangles: median %5.0f  p99 %5.0f  p99.9 %5.0f ns\n", what, triangles, share(0.5),
                share(0.99), share(0.999));
}

} // namespace

TEST_CASE("time of a tick", "[.time]")
{
    const auto pressed = make_stroke([](int) { return -0.02; });
    const auto hovering = make_stroke([](int) { return 0.05; });
    const auto tapping = make_stroke([](int i) { return (i / 50) % 2 ? 0.05 : -0.02; });
    for (uint32_t subdivisions : {3u, 5u, 7u, 8u}) {
        const auto surface = surface_of(make_bumpy_sphere(subdivisions));
        const size_t triangles = surface->faces.size();
        WalkContact point(surface), rubbing(surface), free(surface), taps(surface);
        StylusContact stylus(surface);
        for (WalkContact* contact : {&point, &rubbing, &free, &taps}) contact->update({0, 0, 1.5});
        stylus.update({0, 0, 1.5}, {0, 0, 1.65});
        report("pressed", triangles, pressed, [&](const dvec3& p) { point.update(p); });
        report("pressed, friction", triangles, pressed, [&](const dvec3& p) { rubbing.update(p, {0.3, 0.2}); });
        report("pressed, stylus", triangles, pressed, [&](const dvec3& p) { stylus.update(p, 1.15 * p); });
        for (const double radius : {0.05, 0.1}) { // a twentieth of the object's radius, and of its diameter
            SphereContact ball(surface, radius), rubbing_ball(surface, radius);
            for (SphereContact* contact : {&ball, &rubbing_ball}) contact->update({0, 0, 1.5});
            const std::string name = "pressed, ball of " + std::to_string(radius).substr(0, 4);
            report(name.c_str(), triangles, pressed, [&](const dvec3& p) { ball.update((1 + radius) * p); });
            report((name + ", friction").c_str(), triangles, pressed,
                   [&](const dvec3& p) { rubbing_ball.update((1 + radius) * p, {0.3, 0.2}); });
        }
        report("hovering", triangles, hovering, [&](const dvec3& p) { free.update(p); });
        report("tapping", triangles, tapping, [&](const dvec3& p) { taps.update(p); });
    }
}
