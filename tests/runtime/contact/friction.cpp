// Coulomb's law as the hand meets it: through an encoder, at any rate, along planes, balls and grooves, for any probe.
#include "runtime/contact/probe_contact.h"
#include "runtime/contact/sphere_contact.h"
#include "tests/runtime/contact/each_probe.h"
#include "tests/runtime/surface/meshes.h"
#include "tests/support/catch.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

using namespace haptel::runtime;
using namespace haptel::test;
using glm::dvec3;

namespace {

constexpr Friction material{0.5, 0.2};
constexpr double depth_m = 1e-3;

// How far the hand's spring is drawn along what it touches and into it.
struct Held {
    dvec3 lag_m{0}, push_m{0};
    double pressed_m = 0; // by all contacts together, each along its own normal
};

Held sum(std::span<const Contact> contacts)
{
    Held held;
    for (const Contact& contact : contacts) {
        held.lag_m += contact.lag_m;
        held.push_m += contact.depth_m * contact.normal;
        held.pressed_m += contact.depth_m;
    }
    return held;
}

// What friction has of what presses: across the whole push.
double ratio(const Held& held)
{
    const dvec3 force = held.push_m + held.lag_m, normal = glm::normalize(held.push_m);
    const double along = glm::dot(force, normal), scale = held.pressed_m / glm::length(held.push_m);
    return glm::length(force - along * normal) / (scale * along);
}

// A hand as the encoder of a device tells it; 0: exactly.
struct Encoder {
    double count_m = 0;
    dvec3 operator()(const dvec3& at) const { return count_m > 0 ? glm::round(at / count_m) * count_m : at; }
};

ProbePose pose(const EachProbe& probe, const dvec3& tip)
{
    return {tip, tip + probe.tail_off_m};
}

// A groove along y whose walls rise at 45 degrees.
Mesh groove()
{
    Mesh mesh;
    mesh.positions_m = {{0, -1, 0}, {0, 1, 0}, {1, 1, 1}, {1, -1, 1}, {-1, 1, 1}, {-1, -1, 1}};
    mesh.triangles = {{0, 3, 2}, {0, 2, 1}, {0, 1, 4}, {0, 4, 5}};
    scale_to_size(mesh, 0.2);
    return mesh;
}

} // namespace

TEST_CASE("sliding is not forgotten between two counts of an encoder, at any rate, by any probe")
{
    const auto surface = surface_of([] {
        Mesh mesh = make_plane();
        scale_to_size(mesh, 0.4);
        return mesh;
    }());
    for (const EachProbe& probe : every_probe)
        for (const double rate_hz : {500.0, 1000.0, 4000.0, 10'000.0})
            for (const double count_m : {0.0, 5e-6, 30e-6, 60e-6})
                for (const double speed_m_per_s : {0.02, 0.1}) {
                    CAPTURE(static_cast<int>(probe.settings.kind), rate_hz, count_m, speed_m_per_s);
                    ProbeContact contact(probe.settings, surface, rate_hz);
                    const Encoder encoder{count_m};
                    const auto go = [&](double x, double z) {
                        return sum(contact.update(pose(probe, encoder({x, 0.0113, probe.above_m + z})), material));
                    };
                    go(0, 5e-3);
                    go(0, -depth_m);
                    double drawn = 0, pressed = 0, most = 0;
                    const double step_m = speed_m_per_s / rate_hz;
                    for (double x = 0; x < 5e-3; x += step_m) {
                        const Held held = go(x, -depth_m);
                        REQUIRE(held.pressed_m > 0);
                        most = std::max(most, ratio(held));
                        if (x < 2e-3) continue;
                        drawn += -held.lag_m.x;
                        pressed += held.pressed_m;
                    }
                    CHECK(std::abs(drawn / pressed - material.dynamic_coefficient) <
                          0.02 * material.dynamic_coefficient);
                    CHECK(most <= material.static_coefficient + 1e-6);
                }
}

TEST_CASE("what slid sticks again where the hand comes back, whether in one step or in many")
{
    const auto surface = surface_of(make_plane());
    for (const EachProbe& probe : every_probe)
        for (const double step_m : {1e-6, 20e-6, 150e-6, 280e-6}) {
            CAPTURE(static_cast<int>(probe.settings.kind), step_m);
            ProbeContact contact(probe.settings, surface);
            const auto go = [&](double x) {
                return sum(contact.update(pose(probe, {x, 0.0113, probe.above_m - depth_m}), material));
            };
            contact.update(pose(probe, {0, 0.0113, probe.above_m + 1e-3}), material);
            double x = 0;
            for (int turn = 0; turn < 4; ++turn) { // to and fro
                const double way_m = turn % 2 == 0 ? step_m : -step_m;
                double most = 0;
                Held held;
                for (double gone = 0; gone < 2e-3; gone += step_m) {
                    held = go(x += way_m);
                    most = std::max(most, ratio(held));
                }
                // The last step before it slips leaves less than one step to the limit.
                CHECK(most <= material.static_coefficient + 1e-6);
                CHECK(most > material.static_coefficient - 1.01 * step_m / depth_m);
                CHECK(std::abs(ratio(held) - material.dynamic_coefficient) < 1e-6);
            }
        }
}

TEST_CASE("a hand that is pressed and trembles by the counts of its encoder does not drift for a minute")
{
    const auto surface = surface_of(make_plane());
    for (const EachProbe& probe : every_probe)
        for (const double count_m : {5e-6, 60e-6})
            for (const double slid_m : {0.0, 2e-3}) { // before it rests
                CAPTURE(static_cast<int>(probe.settings.kind), count_m, slid_m);
                ProbeContact contact(probe.settings, surface);
                const auto go = [&](const dvec3& tip) { return sum(contact.update(pose(probe, tip), material)); };
                go({0, 0.0113, probe.above_m + 1e-3});
                for (int i = 0; i <= 100; ++i) go({slid_m * i / 100, 0.0113, probe.above_m - depth_m});
                std::mt19937 random(5);
                std::uniform_int_distribution<int> count(-1, 1);
                dvec3 second(0), minute(0);
                for (int i = 0; i < 60'000; ++i) {
                    const dvec3 off(count(random), count(random), count(random));
                    const Held held = go(dvec3(slid_m, 0.0113, probe.above_m - depth_m) + count_m * off);
                    CHECK(ratio(held) <= material.static_coefficient + 1e-6);
                    if (i >= 1000 && i < 2000) second += held.lag_m / 1000.0;
                    if (i >= 59'000) minute += held.lag_m / 1000.0;
                }
                CHECK(glm::distance(second, minute) < 0.02 * material.dynamic_coefficient * depth_m);
            }
}

TEST_CASE("round a ball friction has its share of what presses in every tick, whatever the way is made of")
{
    const Friction friction{0.3, 0.3};
    for (const double bump : {0.0, 0.01}) {
        Mesh mesh = make_icosphere(5);
        scale_to_size(mesh, 0.1);
        for (dvec3& p : mesh.positions_m)
            p *= 1 + bump * std::sin(200 * p.x) * std::cos(170 * p.y) * std::sin(190 * p.z);
        const auto surface = surface_of(mesh);
        for (const double radius_m : {ball_m, 15e-6})
            for (const double rate_hz : {500.0, 1000.0, 10'000.0}) {
                CAPTURE(bump, radius_m, rate_hz);
                SphereContact contact(surface, radius_m);
                const auto path = [&](double time_s, double off_m) {
                    const double angle = 2 * time_s;
                    const dvec3 way{0.7 * std::cos(angle), 0.7 * std::sin(angle), 0.714};
                    return (0.05 + off_m + radius_m) * glm::normalize(way);
                };
                contact.update(path(0, 5e-3), friction);
                uint64_t slid = 0;
                for (int i = 0; i < 4 * rate_hz; ++i) {
                    const auto touched = contact.update(path(i / rate_hz, -depth_m), friction);
                    if (i < 0.1 * rate_hz || touched.empty()) continue;
                    const Held held = sum(touched);
                    REQUIRE(ratio(held) <= 0.3 + 1e-6);
                    slid += ratio(held) > 0.3 - 1e-6;
                }
                CHECK(static_cast<double>(slid) > 0.998 * 3.9 * rate_hz);
            }
    }
}

TEST_CASE("in a groove both walls have their friction")
{
    const auto surface = surface_of(groove());
    for (const EachProbe& probe : {every_probe[0], every_probe[1]})
        for (const double rate_hz : {500.0, 10'000.0}) {
            CAPTURE(static_cast<int>(probe.settings.kind), rate_hz);
            ProbeContact contact(probe.settings, surface);
            const double bottom_m = std::sqrt(2) * probe.above_m;
            contact.update(pose(probe, {0, -0.05, bottom_m + 2e-3}), material);
            Held held;
            for (int i = 0; i < 0.05 * rate_hz; ++i)
                held = sum(contact.update(pose(probe, {0, -0.05 + i * 0.1 / rate_hz, bottom_m - depth_m}), material));
            // Each wall bears depth / sqrt(2).
            CHECK(std::abs(glm::length(held.lag_m) - material.dynamic_coefficient * std::sqrt(2) * depth_m) < 1e-9);
        }
}

TEST_CASE("a ball that sticks to a wall is not held above a floor that its hand has gone through")
{
    // Wall x = 0 and floor y = 0, as the ball's centre has them.
    Mesh mesh;
    mesh.positions_m = {{0, 0, -1}, {0, 0, 1}, {0, 1, -1}, {0, 1, 1}, {1, 0, -1}, {1, 0, 1}};
    mesh.triangles = {{0, 1, 3}, {0, 3, 2}, {0, 5, 1}, {0, 4, 5}};
    SphereContact contact(surface_of(mesh), ball_m);
    const auto go = [&](double x, double y) { return contact.update({ball_m + x, ball_m + y, 0.013}, {0.5, 0.5}); };
    go(5e-3, 5e-3);
    go(1e-3, 1e-3);
    go(-0.1e-3, 1e-3);
    for (int i = 0; i < 3; ++i) go(-0.1e-3, -0.3e-3);
    CHECK(glm::distance(contact.proxy_m(), dvec3(ball_m, ball_m, 0.013)) <
          0.22e-3); // the coefficient times what presses, along the push
}
