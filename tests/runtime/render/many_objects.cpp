// Ten thousand objects: how many of them a tick looks at, when a scene begins, far later, and when another one takes
// its place; and that nobody feels which of them it does not.
#include "runtime/render/renderer.h"
#include "runtime/render/sleep_queue.h"
#include "runtime/servo/allocation_count.h"
#include "tests/runtime/contact/wild_motion.h"
#include "tests/support/catch.h"
#include "tests/support/touch_scenes.h"
#include "tests/support/tries.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <random>
#include <utility>
#include <vector>

using namespace haptel;
using namespace haptel::runtime;
using namespace haptel::tests;
using glm::dvec3;

namespace {

constexpr int side = 100; // objects in a row, and rows
constexpr double spacing_m = 0.005;

Scene field_of_boxes(double size_m = 0.004)
{
    Scene scene = bare_scene(shape("box", size_m));
    const SceneObject first = scene.objects[0];
    scene.objects.clear();
    for (int i = 0; i < side * side; ++i) {
        SceneObject& object = scene.objects.emplace_back(first);
        object.placement.position_m = {spacing_m * (i % side), spacing_m * (i / side), 0};
        object.texture = std::make_shared<TextureSlot>();
    }
    return scene;
}

// Round the middle of the field, above it: how far it goes in a tick is what those near are counted by.
DevicePose round_the_middle(int tick, double step_m)
{
    const double angle = tick * step_m / 0.05;
    const dvec3 tip(0.25 + 0.05 * std::cos(angle), 0.25 + 0.05 * std::sin(angle), 0.01);
    return {tip, tip + dvec3(0, 0, 0.1)};
}

uint64_t looked_at(Renderer& renderer, const DevicePose& pose)
{
    const uint64_t before = renderer.work().objects;
    renderer.tick(pose);
    return renderer.work().objects - before;
}

// Who lies nearer to the hand than a step of 2 mm times eight, on a field with a box every 5 mm: no more than that
// many, and many times fewer than there are.
constexpr uint64_t near_by = 100;

} // namespace

TEST_CASE("a hand that travels far never looks at all objects in one tick")
{
    for (const ProbeKind kind : {ProbeKind::point, ProbeKind::stylus}) {
        Scene scene = field_of_boxes();
        scene.probe.kind = kind;
        Renderer renderer(shared(std::move(scene)));
        constexpr double step_m = 0.002;
        uint64_t most = 0;
        for (int i = 0; i * step_m < test::tries(205); ++i)
            most = std::max(most, looked_at(renderer, round_the_middle(i, step_m)));
        CHECK(most < near_by);
    }
}

TEST_CASE("the first tick of a scene looks at those near the hand alone, be they at rest or moving")
{
    for (const ProbeKind kind : {ProbeKind::point, ProbeKind::sphere, ProbeKind::stylus, ProbeKind::gripper}) {
        for (const bool moving : {false, true}) {
            CAPTURE(int(kind), moving);
            Scene scene = field_of_boxes();
            scene.probe = {kind, 0.1, kind == ProbeKind::sphere ? 2e-3 : 0.0};
            if (moving)
                for (SceneObject& object : scene.objects)
                    object.motion = std::make_shared<SteadyMotion>(
                        object.placement, SteadyMotion::Figures{{0, 0, 1}, 1, {0, 0, 1e-3}, 1});
            Renderer renderer(shared(std::move(scene)));
            CHECK(looked_at(renderer, round_the_middle(0, 0)) < near_by);
        }
    }
}

TEST_CASE("groups are compared with the hand before those in them, whether it begins near or far away")
{
    std::vector<BoundingSphere> balls;
    for (int i = 0; i < side * side; ++i)
        balls.push_back({{spacing_m * (i % side), spacing_m * (i / side), 0}, 0.002, i % 3 == 0});
    for (const double z : {0.01, 10.0}) {
        SleepQueue queue(balls);
        queue.go(0, {0.25, 0.25, z}, {0.25, 0.25, z + 0.1}, 1e-3);
        CHECK(queue.awake().empty());
        CHECK(queue.compared() < 400); // of a quadtree of balls: some at each of its 14 levels
        CHECK(queue.compared() >= 2);
    }
}

TEST_CASE("what is compared with a hand that has been everywhere grows with the depth of the tree alone")
{
    // A cube of balls that lie close together: so many times as many on each side, and the hand in the middle again.
    const auto compared = [](int across) {
        std::vector<BoundingSphere> balls;
        for (int i = 0; i < across * across * across; ++i)
            balls.push_back({0.006 * dvec3(i % across, i / across % across, i / (across * across)), 0.002});
        const double side_m = 0.006 * (across - 1);
        SleepQueue queue(balls);
        std::mt19937 random(9);
        std::uniform_real_distribution<double> uniform(-0.5, 0.5);
        dvec3 hand(0);
        uint64_t before = 0;
        constexpr double step_m = 5e-4, near_m = 8 * step_m;
        constexpr int from = 4000, until = 8000; // ticks
        for (int tick = 0; tick < until;) {
            // From one place to the next, at last within a centimetre round the middle.
            const double room_m = tick < from - 500 ? side_m : 0.01;
            const dvec3 place = dvec3(side_m / 2) + room_m * dvec3(uniform(random), uniform(random), uniform(random));
            const auto steps = static_cast<int>(glm::distance(hand, place) / step_m) + 1;
            const dvec3 step = (place - hand) / double(steps);
            for (int i = 0; i < steps; ++i, ++tick) {
                hand += step;
                queue.go(glm::length(step), hand, hand, near_m);
                const std::vector<uint32_t> awake = queue.awake();
                if (tick % 100 == 0) // whoever may be met in this tick is awake
                    for (uint32_t ball = 0; ball < balls.size(); ++ball)
                        if (gap_m(balls[ball], hand, hand) <= 0)
                            REQUIRE(std::binary_search(awake.begin(), awake.end(), ball));
                for (const uint32_t ball : awake)
                    if (const double gap = gap_m(balls[ball], hand, hand); gap > near_m) queue.sleep(ball, gap);
                if (tick == from) before = queue.compared();
            }
        }
        return queue.compared() - before;
    };
    const uint64_t few = compared(8), many = compared(32);
    CAPTURE(few, many);
    CHECK(few > 1000);
    CHECK(many < 2 * few); // of 64 times as many: 15 levels of the tree and not 9
}

TEST_CASE("the tail of a pose is nothing to a probe that has none")
{
    // It lies along all boxes of a row.
    for (const ProbeKind kind : {ProbeKind::point, ProbeKind::sphere}) {
        Scene scene = field_of_boxes();
        scene.probe = {kind, 0.1, kind == ProbeKind::sphere ? 2e-3 : 0.0};
        const auto field = shared(std::move(scene));
        Renderer with(field), without(field);
        for (int i = 0; i < 500; ++i) {
            DevicePose pose = at(0.25 + 1e-5 * i, 0.25, 0.006);
            const uint64_t looked = looked_at(without, pose);
            pose.tail_m = pose.tip_m + dvec3(0.2 * std::sin(0.1 * i), 0.2, 0);
            CHECK(looked_at(with, pose) == looked);
        }
    }
}

TEST_CASE("objects that go nobody knows where are compared with the hand in the first tick, and no more than that")
{
    Scene scene = field_of_boxes();
    for (SceneObject& object : scene.objects) object.motion = std::make_shared<LivePlacement>(object.placement);
    Renderer renderer(shared(std::move(scene)));
    CHECK(looked_at(renderer, round_the_middle(0, 0)) < near_by);
}

TEST_CASE("a scene that takes the place of another looks at those near the hand alone")
{
    // The same surfaces, and other ones: a hand that touches nothing, and one that is pressed into a box.
    for (const bool same : {true, false})
        for (const double z : {0.01, 0.001}) {
            if (test::is_sanitized && same == (z < 0.002)) continue;
            CAPTURE(same, z);
            const auto first = shared(field_of_boxes());
            Scene next = same ? *first : field_of_boxes(0.0041);
            for (SceneObject& object : next.objects) object.texture = std::make_shared<TextureSlot>();
            const auto second = shared(std::move(next));
            Renderer before(first);
            for (const double height : {0.01, 0.003, z}) before.tick(at(0.25, 0.25, height));
            Renderer after(second, {}, *first);
            const uint64_t until_then = before.work().objects, allocated = allocations_of_this_thread();
            after.take_over(before);
            CHECK(after.work().objects - until_then < near_by);
            CHECK(allocations_of_this_thread() == allocated);
            CHECK(looked_at(after, at(0.25, 0.25, z)) < near_by);
            CHECK(after.tick(at(0.25, 0.25, z)).contacts == (z < 0.002 ? 1u : 0u));
        }
}

// The hand is pressed 1 mm into a box, and the nearest others are 3 mm away from it, farther than it is held off that
// one. Each is looked at where the hand is, and not from each place where the first one may have held it.
TEST_CASE("what a swap does for who is near, but farther than the hand is held off, is asked once")
{
    const auto first = shared(field_of_boxes());
    Scene other = field_of_boxes(0.0041);
    other.objects.pop_back(); // objects of another number are not told apart: all may have held the hand
    Renderer before(first);
    for (const double height : {0.01, 0.003, 0.001}) before.tick(at(0.25, 0.25, height));
    REQUIRE(before.tick(at(0.25, 0.25, 0.001)).contacts == 1);
    Renderer after(shared(std::move(other)), {}, *first);
    const ContactWork until_then = before.work();
    after.take_over(before);
    const uint64_t objects = after.work().objects - until_then.objects;
    CAPTURE(objects, after.work().sweeps - until_then.sweeps);
    CHECK(objects >= 5);
    CHECK(after.work().sweeps - until_then.sweeps <= objects + 8);
    CHECK(after.tick(at(0.25, 0.25, 0.001)).contacts == 1);
}

TEST_CASE("a tick that is so late that objects turn far looks at those that turn, and at nobody else")
{
    Scene scene = field_of_boxes();
    for (std::size_t i = 0; i < scene.objects.size(); i += 100)
        scene.objects[i].motion =
            std::make_shared<SteadyMotion>(scene.objects[i].placement, SteadyMotion::Figures{{0, 0, 1}, 5, {}, 0});
    Renderer renderer(shared(std::move(scene)));
    for (int i = 0; i < 3; ++i) renderer.tick(round_the_middle(0, 0));
    DevicePose late = round_the_middle(0, 0);
    late.periods = 100;
    const uint64_t looked = looked_at(renderer, late);
    CHECK(looked >= 100);
    CHECK(looked < 100 + near_by);
}

TEST_CASE("whom a tick does not look at is not felt: from the first tick on, in any scene, wherever the hand begins")
{
    // Boxes and balls by chance, from far apart to into each other; hands that begin within, beside and far from them,
    // jump, and go through several of them in one tick; and scenes that take each other's place meanwhile.
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(-1, 1);
    const auto vector = [&](double size) { return size * dvec3(uniform(random), uniform(random), uniform(random)); };
    const std::shared_ptr<const Surface> surfaces[] = {build_surface(shape("box", 0.02)).surface,
                                                       build_surface(shape("icosphere", 0.03)).surface};
    uint64_t contacts = 0, spared = 0;
    for (int round = 0; round < test::tries(40); ++round) {
        const double room_m = std::pow(10.0, 0.7 * uniform(random) - 0.6);
        const auto kind = static_cast<ProbeKind>(round % 4);
        if (kind == ProbeKind::sphere) continue; // what it knows of its surroundings is felt, by less than 1e-4 N
        const auto make = [&] {
            Scene scene = bare_scene(shape("box", 0.02));
            const SceneObject first = scene.objects[0];
            scene.objects.clear();
            for (int i = 0; i < 60; ++i) {
                SceneObject& object = scene.objects.emplace_back(first);
                object.surface = surfaces[i % 2];
                object.placement = {turn_about(vector(1), 3 * uniform(random)), vector(room_m)};
                object.texture = std::make_shared<TextureSlot>();
                object.material = {1000, 1, 0.3, 0.2};
                if (i % 9 == 4) object.effects.magnet = {0.5, 0.01};
                if (i % 9 == 5)
                    object.effects.vibration = {0.3, 40, {0, 0, 1}}, object.effects.vibration_reach_m = 0.02;
                if (i % 9 == 7) object.motion = std::make_shared<LivePlacement>(object.placement);
                if (i % 9 == 8)
                    object.motion = std::make_shared<SteadyMotion>(
                        object.placement, SteadyMotion::Figures{vector(1) + dvec3(0, 0, 2), 3, vector(0.01), 2});
            }
            scene.probe = {kind, 0.1, 0.0};
            return scene;
        };
        const Scene first = make();
        Scene second = first, third = make(); // some objects of the second lie elsewhere
        for (std::size_t i = 0; i < second.objects.size(); i += 4)
            if (!second.objects[i].motion) second.objects[i].placement.position_m += vector(i % 8 ? 5e-4 : 0.05);
        std::vector<DevicePose> hand;
        dvec3 place = vector(room_m), along = glm::normalize(vector(1) + dvec3(0, 0, 1.5));
        for (int i = 0; i < 600; ++i) {
            if (i % 150 == 149) place = vector(room_m);
            const double step_m = i / 100 % 2 ? 3e-3 : 3e-4;
            place += step_m * (0.3 * vector(1) - glm::normalize(place - 0.3 * vector(room_m)));
            hand.push_back({place, place + 0.1 * along});
        }
        const auto felt = [&](bool leaves_alone) {
            std::vector<std::shared_ptr<const Scene>> scenes;
            for (Scene scene : {first, second, third}) {
                scene.servo.skips.objects = leaves_alone;
                scenes.push_back(shared(std::move(scene)));
            }
            auto renderer = std::make_unique<Renderer>(scenes[0]);
            std::vector<TickResult> ticks;
            for (std::size_t i = 0; i < hand.size(); ++i) {
                if (i % 100 == 99) {
                    const std::size_t now = i / 100;
                    auto next = std::make_unique<Renderer>(scenes[(now + 1) % 3], HandSettings(), *scenes[now % 3]);
                    next->take_over(*renderer);
                    renderer = std::move(next);
                }
                ticks.push_back(renderer->tick(hand[i]));
                contacts += ticks.back().contacts;
            }
            spared += renderer->skipped().objects;
            return ticks;
        };
        const std::vector<TickResult> lazy = felt(true), eager = felt(false);
        std::optional<std::size_t> different;
        for (std::size_t i = 0; i < hand.size() && !different; ++i)
            if (lazy[i].unlimited_force_n != eager[i].unlimited_force_n ||
                lazy[i].unlimited_torque_n_m != eager[i].unlimited_torque_n_m || lazy[i].force_n != eager[i].force_n ||
                lazy[i].grip_force_n != eager[i].grip_force_n || lazy[i].contacts != eager[i].contacts)
                different = i;
        CAPTURE(round, room_m, different.value_or(0));
        CHECK(!different);
    }
    CHECK(contacts > test::tries(5000u));
    CHECK(spared > test::tries(300'000u));
}
