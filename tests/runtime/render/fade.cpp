// A scene in the place of another one: how the old force goes and the new one comes.
#include "tests/runtime/render/swap_stage.h"
#include "tests/support/catch.h"

#include <cmath>
#include <limits>
#include <utility>

using namespace haptel;
using namespace haptel::runtime;
using namespace haptel::tests;

TEST_CASE("another stiffness comes by a ramp, and time goes on")
{
    const auto scene = shared(plane_scene());
    Stage stage(scene);
    stage.press(1e-3, 1);
    stage.press(-1e-3, 200);
    Scene stiffer = same_as(*scene);
    stiffer.objects[0].material.stiffness_n_per_m = 3000;
    stage.slot.publish(shared(std::move(stiffer)));
    for (int i = 0; i < 200; ++i) {
        const TickResult result = stage.press(-1e-3, 1);
        CHECK(std::abs(result.time_s - (201 + i) * 1e-3) < 1e-12);
        CHECK(std::abs(result.force_n.z - (1 + 2 * std::min(1.0, i / 100.0))) < 1e-8);
    }
}

TEST_CASE("the force between a gripper's fingers fades out with the scene that it is of, and the new one's rises")
{
    Mesh box = make_box();
    scale_to_size(box, 0.02);
    Scene first = bare_scene(box);
    first.probe.kind = ProbeKind::gripper;
    first.servo.force_rise_s = rise_s;
    Scene without = first, stiffer = first;
    without.objects[0].placement.position_m = {0, 0, -0.5};
    stiffer.objects[0].material.stiffness_n_per_m = 3000;
    const auto fingers = [](double apart_m) { return DevicePose{{-apart_m, 0, 0}, {apart_m, 0, 0}}; };
    const auto scene = shared(std::move(first));
    const auto stage = [&] { // 1 mm deep each, 1 N
        Stage begun(scene);
        begun.tick(fingers(0.02));
        for (int i = 0; i < 200; ++i) begun.tick(fingers(0.009));
        return begun.tick(fingers(0.009)).grip_force_n;
    };
    CHECK(std::abs(stage() - 1) < 1e-8);
    for (const auto& [next, force_n] : {std::pair<const Scene*, double>{&without, 0}, {&stiffer, 3}}) {
        Stage swapped(scene);
        swapped.tick(fingers(0.02));
        for (int i = 0; i < 200; ++i) swapped.tick(fingers(0.009));
        swapped.slot.publish(shared(same_as(*next)));
        for (int i = 0; i < 200; ++i) {
            const double risen = std::min(1.0, i / 100.0);
            CHECK(std::abs(swapped.tick(fingers(0.009)).grip_force_n - (risen * force_n + 1 - risen)) < 1e-8);
        }
    }
    // An interruption ends it.
    Stage interrupted(scene);
    interrupted.tick(fingers(0.02));
    for (int i = 0; i < 200; ++i) interrupted.tick(fingers(0.009));
    interrupted.slot.publish(shared(same_as(without)));
    CHECK(interrupted.tick(fingers(0.009)).grip_force_n > 0.9);
    DevicePose anew = fingers(0.009);
    anew.interrupted = true;
    CHECK(interrupted.tick(anew).grip_force_n == 0);
}

TEST_CASE("an interruption ends what fades out of the scene before, torque and force alike")
{
    Scene first = plane_scene();
    first.probe = {ProbeKind::stylus, 0.1};
    const auto scene = shared(std::move(first));
    Scene without = same_as(*scene);
    without.objects[0].placement.position_m = {0, 0, -0.5};
    Stage stage(scene);
    const auto leaning = [](double z) { return DevicePose{{0, 0, z}, {0.06, 0, z + 0.08}}; };
    stage.tick(leaning(1e-3));
    for (int i = 0; i < 200; ++i) stage.tick(leaning(-1e-3));
    stage.slot.publish(shared(std::move(without)));
    CHECK(glm::length(stage.tick(leaning(-1e-3)).torque_n_m) > 0.01);
    DevicePose anew = leaning(-1e-3);
    anew.interrupted = true;
    const TickResult result = stage.tick(anew);
    CHECK(result.force_n == glm::dvec3(0));
    CHECK(result.torque_n_m == glm::dvec3(0));
}

TEST_CASE("whatever a new scene holds, the force changes no faster than by the ramp")
{
    const auto scene = shared(plane_scene());
    Scene without = plane_scene(), higher = same_as(*scene), finer = plane_scene(), other = same_as(*scene);
    without.objects[0].placement.position_m = {0, 0, -0.5};  // another plane, far away
    higher.objects[0].placement.position_m = {0, 0, 0.9e-3}; // the same one, nudged
    finer.objects[0].surface = build_surface(plane_mesh(0.1, 7)).surface;
    other.probe = {ProbeKind::sphere, 0.1, 1e-3};
    const struct {
        const Scene* next;
        double force_n;
    } cases[] = {{&without, 0}, {&higher, 1.9}, {&finer, 1}, {&other, 2}};
    for (const auto& swap : cases) {
        Stage stage(scene);
        stage.press(1e-3, 1);
        double last_n = stage.press(-1e-3, 200).force_n.z;
        stage.slot.publish(shared(*swap.next));
        for (int i = 0; i < 300; ++i) {
            const double force_n = stage.press(-1e-3, 1).force_n.z;
            CHECK(std::abs(force_n - last_n) <= std::abs(swap.force_n - 1) * 1e-3 / rise_s + 1e-6);
            last_n = force_n;
        }
        CAPTURE(swap.force_n);
        CHECK(std::abs(last_n - swap.force_n) < 2e-2); // put down from 10 um above where it was, then the same
    }
}

TEST_CASE("what a scene that is gone leaves on the hand gives no more than its springs held")
{
    // Work of the forces sent, each held for a tick, on a hand that leaves where nothing is any more.
    const auto gone = [](const Scene& scene) {
        Scene without = same_as(scene);
        without.objects[0].surface = build_surface(plane_mesh(0.1, 3)).surface;
        without.objects[0].placement.position_m = {0, 0, -0.5};
        return without;
    };
    for (const double stiffness : {300.0, 800.0, 3000.0})
        for (const double limit_n : {7.0, 1.5})
            for (const double m_per_s : {0.001, 0.02, 0.1, 0.3, 1.0, 10.0})
                for (const int swaps : {1, 50}) {
                    Scene first = plane_scene(stiffness);
                    first.servo.force_limit_n = limit_n;
                    const auto scene = shared(first);
                    Stage stage(scene);
                    stage.press(1e-3, 1);
                    double z = -2e-3, last_n = stage.press(z, 200).force_n.z;
                    const double held_j = last_n * last_n / (2 * stiffness);
                    double given_j = 0;
                    for (int i = 0; i < 400; ++i) {
                        if (i < swaps) stage.slot.publish(shared(gone(*scene)));
                        z += m_per_s * 1e-3;
                        const double force_n = stage.press(z, 1).force_n.z;
                        CHECK(force_n >= 0);
                        CHECK(force_n <= last_n);
                        given_j += force_n * m_per_s * 1e-3;
                        last_n = force_n;
                    }
                    CAPTURE(stiffness, limit_n, m_per_s, swaps);
                    CHECK(given_j <= held_j * (1 + 1e-3));
                    if (m_per_s == 0.1 && swaps == 1 && stiffness == 800) CHECK(given_j > 0.7 * held_j); // no step
                }
}

TEST_CASE("what presses a gripper open or turns a stylus is gone when the hand has given way to it")
{
    Mesh box = make_box();
    scale_to_size(box, 0.02);
    Scene held = bare_scene(box);
    held.probe.kind = ProbeKind::gripper;
    held.servo.force_rise_s = rise_s;
    Scene without = held;
    without.objects[0].placement.position_m = {0, 0, -0.5};
    const auto fingers = [](double apart_m) { return DevicePose{{-apart_m, 0, 0}, {apart_m, 0, 0}}; };
    Stage gripper(shared(std::move(held)));
    gripper.tick(fingers(0.02));
    for (int i = 0; i < 200; ++i) gripper.tick(fingers(0.009)); // 1 mm and 1 N each: 0.5 mJ at 1000 N/m, twice
    gripper.slot.publish(shared(std::move(without)));
    double given_j = 0;
    for (int i = 1; i <= 60; ++i)
        given_j += gripper.tick(fingers(0.009 + 0.05e-3 * i)).grip_force_n * 0.1e-3; // both fingers
    CHECK(given_j <= 1e-3);
    CHECK(given_j > 0.7e-3);
    CHECK(gripper.tick(fingers(0.012)).grip_force_n == 0);

    Scene first = plane_scene();
    first.probe = {ProbeKind::stylus, 0.1};
    const auto scene = shared(std::move(first));
    Scene empty = same_as(*scene);
    empty.objects[0].placement.position_m = {0, 0, -0.5};
    Stage stylus(scene);
    const auto leaning = [](double angle, double z) { // about its grip, which stays where it is
        const glm::dvec3 grip(0.06, 0, z + 0.08), along = 0.1 * glm::dvec3(std::sin(angle), 0, std::cos(angle));
        return DevicePose{grip - along, grip};
    };
    const double lean = std::acos(0.8);
    stylus.tick(leaning(lean, 1e-3));
    TickResult before;
    for (int i = 0; i < 200; ++i) before = stylus.tick(leaning(lean, -1e-3)); // 1 mm and 1 N
    REQUIRE(glm::length(before.torque_n_m) > 0.01);
    const double turn = before.torque_n_m.y > 0 ? 1e-4 : -1e-4; // the way the torque pushes
    stylus.slot.publish(shared(std::move(empty)));
    given_j = 0;
    for (int i = 1; i <= 300; ++i)
        given_j += glm::length(stylus.tick(leaning(lean + turn * i, -1e-3)).torque_n_m) * 1e-4;
    CHECK(given_j <= 0.5e-3);
    CHECK(given_j > 0.2e-3);
}

TEST_CASE("a scene that jumps waits for a small force where it says so, and one that does not jump does not")
{
    Scene first = plane_scene();
    first.servo.wait_for_small_force_n = 0.5;
    const auto scene = shared(std::move(first));
    Stage stage(scene);
    stage.press(1e-3, 300);
    stage.press(-1e-3, 300);
    Scene little = same_as(*scene), much = same_as(*scene);
    little.objects[0].material.stiffness_n_per_m = 1300;
    much.objects[0].material.stiffness_n_per_m = 4000;
    stage.slot.publish(shared(std::move(little)));
    CHECK_FALSE(stage.press(-1e-3, 1).waiting);
    CHECK(std::abs(stage.press(-1e-3, 200).force_n.z - 1.3) < 1e-8);
    stage.slot.publish(shared(std::move(much)));
    for (int i = 0; i < 300; ++i) { // what was on the hand fades out
        const TickResult result = stage.press(-1e-3, 1);
        CHECK(result.waiting);
        CHECK(std::abs(result.force_n.z - 1.3 * std::max(0.0, 1 - i / 100.0)) < 1e-8);
    }
    CHECK_FALSE(stage.press(-0.1e-3, 1).waiting);
    stage.press(-0.1e-3, 100);
    CHECK(std::abs(stage.press(-1e-3, 1).force_n.z - 4) < 1e-8);
}

TEST_CASE("the force between a gripper's fingers is waited for like any other")
{
    Mesh box = make_box();
    scale_to_size(box, 0.02);
    Scene first = bare_scene(box);
    first.probe.kind = ProbeKind::gripper;
    first.servo.force_rise_s = rise_s;
    first.servo.wait_for_small_force_n = 0.5;
    const auto fingers = [](double apart_m) { return DevicePose{{-apart_m, 0, 0}, {apart_m, 0, 0}}; };
    Scene little = first, much = first;
    little.objects[0].material.stiffness_n_per_m = 1300;
    much.objects[0].material.stiffness_n_per_m = 4000;
    Stage stage(shared(std::move(first)));
    const auto squeeze = [&](double apart_m, int ticks) {
        TickResult result;
        for (int i = 0; i < ticks; ++i) result = stage.tick(fingers(apart_m));
        return result;
    };
    squeeze(0.02, 200);
    CHECK(std::abs(squeeze(0.009, 200).grip_force_n - 1) < 1e-8);
    DevicePose anew = fingers(0.009);
    anew.interrupted = true;
    CHECK(stage.tick(anew).waiting);
    CHECK(squeeze(0.009, 300).grip_force_n == 0);
    CHECK_FALSE(squeeze(0.0096, 1).waiting); // 0.4 N
    squeeze(0.0096, 100);
    CHECK(std::abs(squeeze(0.009, 1).grip_force_n - 1) < 1e-8);

    stage.slot.publish(shared(same_as(little)));
    CHECK_FALSE(squeeze(0.009, 1).waiting);
    CHECK(std::abs(squeeze(0.009, 200).grip_force_n - 1.3) < 1e-8);
    stage.slot.publish(shared(same_as(much)));
    CHECK(squeeze(0.009, 1).waiting);
    CHECK(squeeze(0.009, 300).grip_force_n == 0);
}

TEST_CASE("a hand without a force on it is left alone by the fade")
{
    const auto scene = shared(plane_scene());
    Stage stage(scene);
    stage.press(1e-3, 1);
    stage.press(-1e-3, 200);
    stage.tick(at(std::numeric_limits<double>::quiet_NaN(), 0, 0));
    stage.slot.publish(shared(same_as(*scene)));
    for (int i = 0; i < 150; ++i) // rises as after any interruption; on the surface as before
        CHECK(std::abs(stage.press(-1e-3, 1).force_n.z - std::min(1.0, i / 100.0)) < 1e-8);
}
