// Objects that move and are out of reach: what a tick looks at does not grow with them, and nobody feels it.
#include "runtime/render/renderer.h"
#include "runtime/scene/motion.h"
#include "runtime/servo/allocation_count.h"
#include "tests/runtime/contact/wild_motion.h"
#include "tests/support/catch.h"
#include "tests/support/touch_scenes.h"
#include "tests/support/tries.h"

#include <atomic>
#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <utility>
#include <vector>

using namespace haptel;
using namespace haptel::runtime;
using namespace haptel::tests;
using glm::dvec3;

namespace {

// As another one, and counts how often it is asked where it is.
class Counted final : public Motion {
public:
    Counted(const Motion& motion, std::atomic<int>& asked) : motion_(motion), asked_(asked) {}
    std::optional<Placement> at(double time_s) const noexcept override { return ++asked_, motion_.at(time_s); }
    std::optional<MotionBounds> bounds(const dvec3& centre_m, double radius_m) const noexcept override
    {
        return motion_.bounds(centre_m, radius_m);
    }

private:
    const Motion& motion_;
    std::atomic<int>& asked_;
};

struct Felt {
    std::vector<TickResult> ticks;
    SkippedStages skipped;
    int contacts = 0;
    uint64_t allocated = 0; // in ticks and while one scene took over from another
};

// Another scene takes the place of the first where there is one.
Felt feel(const std::vector<Scene>& scenes, const std::vector<DevicePose>& hand, const Skips& skips)
{
    const auto with_skips = [&](Scene scene) {
        scene.servo.skips = skips;
        return shared(std::move(scene));
    };
    auto scene = with_skips(scenes[0]);
    auto renderer = std::make_unique<Renderer>(scene);
    Felt felt;
    for (std::size_t i = 0; i < hand.size(); ++i) {
        if (scenes.size() > 1 && i % 1000 == 999) {
            const auto next = with_skips(scenes[(i / 1000 + 1) % scenes.size()]);
            auto other = std::make_unique<Renderer>(next, HandSettings(), *scene);
            const uint64_t before = allocations_of_this_thread();
            other->take_over(*renderer);
            felt.allocated += allocations_of_this_thread() - before;
            scene = next;
            renderer = std::move(other);
        }
        const uint64_t before = allocations_of_this_thread();
        const TickResult tick = renderer->tick(hand[i]);
        renderer->between_ticks();
        felt.allocated += allocations_of_this_thread() - before;
        felt.ticks.push_back(tick);
        felt.contacts += static_cast<int>(tick.contacts);
    }
    felt.skipped = renderer->skipped();
    return felt;
}

// The number of the first tick that feels different; that of all ticks if none does.
std::size_t first_difference(const Felt& a, const Felt& b)
{
    for (std::size_t i = 0; i < a.ticks.size(); ++i) {
        const TickResult &x = a.ticks[i], &y = b.ticks[i];
        if (x.unlimited_force_n != y.unlimited_force_n || x.unlimited_torque_n_m != y.unlimited_torque_n_m ||
            x.force_n != y.force_n || x.grip_force_n != y.grip_force_n || x.depth_m != y.depth_m ||
            x.contacts != y.contacts)
            return i;
    }
    return a.ticks.size();
}

} // namespace

TEST_CASE("a tick does not grow with the objects that move far away")
{
    Scene scene = bare_scene(plane_mesh());
    const auto ball = build_surface(shape("icosphere", 0.01)).surface;
    const SteadyMotion::Figures turning{{0, 1, 2}, 3.0, {0.01, 0, 0}, 2};
    std::atomic<int> asked{0};
    std::vector<std::unique_ptr<SteadyMotion>> motions;
    for (int i = 0; i < 1000; ++i) {
        SceneObject object = scene.objects[0];
        object.surface = ball;
        object.placement.position_m = {0.02 * (i % 40), 0.02 * (i / 40), 0.5};
        motions.push_back(std::make_unique<SteadyMotion>(object.placement, turning));
        object.motion = std::make_shared<Counted>(*motions.back(), asked);
        scene.objects.push_back(std::move(object));
    }
    for (const ProbeKind kind : {ProbeKind::point, ProbeKind::sphere, ProbeKind::stylus, ProbeKind::gripper}) {
        CAPTURE(int(kind));
        scene.probe = {kind, 0.1, kind == ProbeKind::sphere ? 2e-3 : 0.0};
        Renderer renderer(shared(scene));
        const auto tick = [&](int i) {
            const dvec3 tip(0.01 * std::sin(i * 0.01), 0, -1e-3);
            renderer.tick({tip, tip + dvec3(0, 0, 0.1)});
        };
        tick(0);
        asked = 0;
        const uint64_t skipped = renderer.skipped().objects;
        for (int i = 1; i <= 600; ++i) tick(i);
        CHECK(asked < 2 * 600);
        CHECK(renderer.skipped().objects - skipped > 998 * 600);
    }
}

TEST_CASE("an object that goes nobody knows where is left alone while it is far away, wherever it comes from")
{
    Scene scene = bare_scene(shape("icosphere", 0.01));
    scene.objects[0].motion = std::make_shared<Unforeseen>(
        [](double time_s) { return Placement{glm::dmat3(1), {0, 0, 0.5 + 0.497 * std::cos(10 * time_s)}}; });
    Renderer renderer(shared(std::move(scene)));
    int contacts = 0;
    for (int i = 0; i < 5000; ++i) contacts += static_cast<int>(renderer.tick(at(1e-4, 2e-4, 0)).contacts);
    CHECK(contacts > 100);
    CHECK(renderer.skipped().objects > 3000);
}

TEST_CASE("objects that move and are left alone change no bit of what is felt")
{
    for (const ProbeKind kind : {ProbeKind::point, ProbeKind::sphere, ProbeKind::stylus, ProbeKind::gripper})
        for (unsigned seed = 1; seed <= (test::is_sanitized ? 1 : 2); ++seed) {
            CAPTURE(int(kind), seed);
            Scene scene = moving_field(seed);
            scene.probe = {kind, kind == ProbeKind::gripper ? 0.03 : 0.1, kind == ProbeKind::sphere ? 3e-3 : 0.0};
            const std::vector<DevicePose> hand = wild_hand(seed, test::tries(10'000), scene.probe);
            const Felt all = feel({scene}, hand, {});
            CHECK(all.contacts > test::tries(300));
            CHECK(all.skipped.objects > 20 * hand.size());
            const Felt looked_at = feel({scene}, hand, {.objects = false});
            CHECK(looked_at.skipped.objects == 0);
            CHECK(first_difference(all, looked_at) == hand.size());
            CHECK(first_difference(all, feel({scene}, hand, {false, false, false, false})) == hand.size());

            Scene other = moving_field(seed);
            other.probe = scene.probe;
            for (std::size_t i = 0; i < other.objects.size(); i += 3) other.objects[i].motion = nullptr;
            const Felt swapped = feel({scene, other}, hand, {});
            CHECK(all.allocated + swapped.allocated == 0);
            CHECK(first_difference(swapped, feel({scene, other}, hand, {.objects = false})) == hand.size());
        }
}

TEST_CASE("who turns far in a tick is met on the straight way that the hand takes as it sees it")
{
    // A rod of a metre whose ends pass just before the hand: between two ticks the way cuts the circle short. And a
    // box that makes half a turn in a tick that is late: the way leads through it.
    const Mesh rod = make_box({1, 4e-3, 4e-3});
    const auto turning = [](const Mesh& mesh, double spin_rad_per_s) {
        Scene scene = bare_scene(mesh);
        scene.objects[0].motion =
            std::make_shared<SteadyMotion>(Placement(), SteadyMotion::Figures{{0, 0, 1}, spin_rad_per_s, {}, 0});
        return scene;
    };
    const std::vector<DevicePose> before_the_end(3000, at(0.50004, 0, 0));
    std::vector<DevicePose> late(10, at(0.1, 1e-4, 2e-4));
    late[1].periods = 314;
    for (const auto& [scene, hand] :
         {std::pair(turning(rod, 49), before_the_end), std::pair(turning(shape("box", 0.01), 10), late)}) {
        const Felt looked_at = feel({scene}, hand, {.objects = false}), all = feel({scene}, hand, {});
        CHECK(looked_at.contacts > 0);
        CHECK(first_difference(all, looked_at) == hand.size());
    }
}

TEST_CASE("the damping of an object that turns is the same whether or not it was watched before it was touched")
{
    for (const double rate_hz : {1000.0, 20'000.0}) {
        Scene foreseen = bare_scene(shape("box", 0.02));
        foreseen.servo.rate_hz = rate_hz;
        foreseen.objects[0].material.damping_n_s_per_m = 5;
        const SteadyMotion steady({}, {{0, 0, 1}, 4.0, {0, 0, 0.01}, 3});
        foreseen.objects[0].motion = std::make_shared<SteadyMotion>(steady);
        Scene unforeseen = foreseen;
        unforeseen.objects[0].motion = std::make_shared<Unforeseen>([&](double time_s) { return *steady.at(time_s); });
        const auto a_scene = shared(std::move(foreseen)), b_scene = shared(std::move(unforeseen));
        auto a = std::make_unique<Renderer>(a_scene), b = std::make_unique<Renderer>(b_scene);
        const auto renew = [](std::unique_ptr<Renderer>& renderer, const std::shared_ptr<const Scene>& scene) {
            auto next = std::make_unique<Renderer>(scene, HandSettings(), *scene);
            next->take_over(*renderer);
            renderer = std::move(next);
        };
        const int ticks = static_cast<int>(2 * rate_hz);
        double furthest_n = 0;
        int contacts = 0;
        for (int i = 0; i < ticks; ++i) {
            const double t = i / rate_hz;
            DevicePose pose = at(0.002, 0.001, 0.03 + 0.03 * std::cos(20 * t));
            if (i % 170 == 0) pose.tip_m.x = std::nan(""); // it is taken to rest when it comes back
            if (i % 50 == 0) renew(a, a_scene), renew(b, b_scene);
            const TickResult x = a->tick(pose), y = b->tick(pose);
            furthest_n = std::max(furthest_n, glm::distance(x.force_n, y.force_n));
            contacts += static_cast<int>(x.contacts);
        }
        CHECK(contacts > ticks / 10);
        CHECK(furthest_n < 1e-3);
        if (rate_hz == 1000) CHECK(furthest_n < 1e-5);
    }
}

TEST_CASE("the bounds of a steady motion hold the object at any time, and how a place at rest seems to move")
{
    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform(-1, 1);
    const auto vector = [&](double size) { return size * dvec3(uniform(random), uniform(random), uniform(random)); };
    for (int i = 0; i < 200; ++i) {
        const Placement start{turn_about(vector(1), 3 * uniform(random)), vector(0.5)};
        const SteadyMotion motion(start,
                                  {vector(3), i % 5 ? 20 * uniform(random) : 0, vector(0.1), 5 * uniform(random)});
        const dvec3 centre = vector(i % 2 ? 0.3 : 0.01);
        const double radius = 0.05 * std::abs(uniform(random));
        const auto bounds = motion.bounds(centre, radius);
        REQUIRE(bounds);
        for (int k = 0; k < 100; ++k) {
            const double time_s = 10 * std::abs(uniform(random)), later_s = time_s + 0.05 * std::abs(uniform(random));
            const Placement now = *motion.at(time_s), later = *motion.at(later_s);
            REQUIRE(glm::distance(now.to_world(centre), bounds->centre_m) + radius <= bounds->radius_m);
            const dvec3 place = vector(2);
            const double seems_m = glm::distance(now.to_object(place), later.to_object(place));
            REQUIRE(seems_m <= bounds->sway_m + bounds->turn_rad_per_s * (later_s - time_s) *
                                                    (glm::distance(place, bounds->centre_m) + bounds->radius_m));
        }
    }
}
