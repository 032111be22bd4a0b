// Scenes of many objects and of objects that move: who is felt, who is left alone, and that nothing slips through.
#include "runtime/render/renderer.h"
#include "runtime/render/sleep_queue.h"
#include "runtime/scene/motion.h"
#include "tests/support/catch.h"
#include "tests/support/lambda_texture.h"
#include "tests/support/touch_scenes.h"
#include "tests/support/tries.h"

#include <atomic>
#include <cmath>
#include <numbers>
#include <random>
#include <thread>
#include <vector>

using namespace haptel;
using namespace haptel::runtime;
using namespace haptel::tests;

namespace {

// Any function of time.
class ScriptedMotion final : public Motion {
public:
    explicit ScriptedMotion(std::function<std::optional<Placement>(double)> script) : script_(std::move(script)) {}
    std::optional<Placement> at(double time_s) const noexcept override { return script_(time_s); }

private:
    std::function<std::optional<Placement>(double)> script_;
};

std::shared_ptr<const Motion> moved_by(std::function<glm::dvec3(double)> position_m)
{
    return std::make_shared<ScriptedMotion>([position_m = std::move(position_m)](double time_s) {
        return std::optional(Placement{glm::dmat3(1), position_m(time_s)});
    });
}

// Balls of 2 cm on a grid of 5 cm.
Scene field_of_balls(int count, double friction = 0.2)
{
    Mesh ball = make_icosphere(3);
    scale_to_size(ball, 0.02);
    Scene scene = bare_scene(ball);
    const SceneObject first = scene.objects[0];
    scene.objects.clear();
    const int side = static_cast<int>(std::ceil(std::sqrt(count)));
    for (int i = 0; i < count; ++i) {
        scene.objects.push_back(first);
        scene.objects.back().texture = std::make_shared<TextureSlot>();
        scene.objects.back().placement.position_m = {0.05 * (i % side), 0.05 * (i / side), 0};
        scene.objects.back().material.static_friction = scene.objects.back().material.dynamic_friction = friction;
    }
    return scene;
}

// Strolls through the field, at times slowly, at times across it in one tick.
std::vector<DevicePose> wild_walk(int ticks, double side_m, double step_max_m)
{
    std::mt19937 random(5);
    std::uniform_real_distribution<double> uniform(0, 1);
    std::vector<DevicePose> poses;
    glm::dvec3 place(0.02, 0.02, 0.02), goal = place;
    double step_m = 1e-4;
    for (int i = 0; i < ticks; ++i) {
        if (i % 100 == 0) {
            goal = {side_m * uniform(random), side_m * uniform(random), 0.03 * (uniform(random) - 0.5)};
            step_m = std::min(step_max_m, std::pow(10.0, -5 + 4 * uniform(random)));
        }
        const glm::dvec3 way = goal - place;
        const double length = glm::length(way);
        place = length <= step_m ? goal : place + way * (step_m / length);
        poses.push_back({place, place + glm::dvec3(0, 0, 0.1)});
    }
    return poses;
}

} // namespace

TEST_CASE("an object that moves meets the hand as the hand would meet it")
{
    Mesh ball = make_icosphere(3);
    scale_to_size(ball, 0.02);
    for (const double speed_m_per_s : {0.01, 1.0, 100.0}) { // the last crosses the ball within a tick
        Scene still = bare_scene(ball), moving = bare_scene(ball);
        for (Scene* scene : {&still, &moving}) scene->objects[0].material = {1000, 5, 0.3, 0.2};
        const auto place = [&](double time_s) {
            return glm::dvec3(0.003, 0.001, 0.02 * std::cos(speed_m_per_s / 0.02 * time_s));
        };
        moving.objects[0].motion = moved_by([&](double time_s) { return -place(time_s); });
        Renderer hand_moves(shared(std::move(still))), object_moves(shared(std::move(moving)));
        int contacts = 0;
        for (int i = 0; i < 3000; ++i) {
            const glm::dvec3 hand = place(i * 1e-3);
            const TickResult expected = hand_moves.tick(at(hand.x, hand.y, hand.z)),
                             found = object_moves.tick(at(0, 0, 0));
            CHECK(glm::length(found.force_n - expected.force_n) < 1e-7 * (1 + glm::length(expected.force_n)));
            CHECK(found.contacts == expected.contacts);
            contacts += static_cast<int>(found.contacts);
        }
        CHECK(contacts > 500);
    }
}

TEST_CASE("a plate that turns under a resting hand drags it with sliding friction, and with no force through the axis")
{
    Scene scene = bare_scene(plane_mesh());
    scene.objects[0].material = {1000, 0, 0.4, 0.25};
    scene.objects[0].motion = std::make_shared<SteadyMotion>(Placement{}, SteadyMotion::Figures{{0, 0, 2}, 3.0, {}, 0});
    Renderer renderer(shared(std::move(scene)));
    TickResult last;
    for (int i = 0; i < 4000; ++i) last = renderer.tick(at(0.02, 0, i == 0 ? 1e-3 : -1e-3));
    // Depth 1 mm: 1 N along z, a quarter of it along the way of the plate, which at +x moves toward +y.
    CHECK(std::abs(last.force_n.z - 1) < 1e-9);
    CHECK(std::abs(glm::length(glm::dvec2(last.force_n)) - 0.25) < 1e-9);
    CHECK(last.force_n.y > 0.24);
}

TEST_CASE("a swinging object is where its figures say, at any time, and comes back")
{
    const Placement start{glm::dmat3(1), {1, 2, 3}};
    const SteadyMotion motion(start, {{1, 0, 0}, std::numbers::pi / 2, {0.1, 0, 0}, 0.5});
    const Placement later = *motion.at(0.5); // a quarter period of the swing, an eighth of a turn
    CHECK(glm::length(later.position_m - glm::dvec3(1.1, 2, 3)) < 1e-15);
    CHECK(glm::length(later.rotation * glm::dvec3(0, 1, 0) - glm::dvec3(0, std::sqrt(0.5), std::sqrt(0.5))) < 1e-15);
    const Placement much_later = *motion.at(4e6); // a million periods and turns
    CHECK(glm::length(much_later.position_m - start.position_m) < 1e-9);
    CHECK(glm::length(much_later.rotation * glm::dvec3(0, 1, 0) - glm::dvec3(0, 1, 0)) < 1e-8);
}

TEST_CASE("a placement that is none is refused or passed over, and the object stays")
{
    LivePlacement live({});
    CHECK(live.publish({glm::dmat3(1), {0, std::nan(""), 0}}).find("not finite") != std::string::npos);
    CHECK(live.publish({glm::dmat3(2), {}}).find("unit vectors") != std::string::npos);
    glm::dmat3 mirrored(1);
    mirrored[0][0] = -1;
    CHECK(live.publish({mirrored, {}}).find("right-handed") != std::string::npos);
    CHECK(live.at(0)->position_m == glm::dvec3(0));
    CHECK(live.publish({glm::dmat3(1), {0, 0, 1}}).empty());
    CHECK(live.at(0)->position_m == glm::dvec3(0, 0, 1));

    Scene scene = bare_scene(plane_mesh());
    scene.objects[0].motion = std::make_shared<ScriptedMotion>([](double time_s) -> std::optional<Placement> {
        const int tick = static_cast<int>(std::lround(time_s * 1000));
        if (tick % 3 == 1) return std::nullopt;
        if (tick % 3 == 2) return Placement{glm::dmat3(std::nan("")), {}};
        return Placement{};
    });
    Renderer renderer(shared(std::move(scene)));
    renderer.tick(at(0, 0, 1e-3));
    for (int i = 0; i < 100; ++i) CHECK(std::abs(renderer.tick(at(0, 0, -1e-3)).force_n.z - 1) < 1e-9);
}

TEST_CASE("two threads: a live placement is read whole or not at all")
{
    LivePlacement live({});
    std::atomic<bool> done{false};
    bool all_taken = true; // the test framework knows one thread
    std::thread writer([&] {
        for (int i = 1; i < 20000; ++i) all_taken = live.publish({glm::dmat3(1), glm::dvec3(i)}).empty() && all_taken;
        done = true;
    });
    double last = 0;
    while (!done) {
        const auto now = live.at(0);
        if (!now) continue;
        CHECK(now->position_m.x == now->position_m.y);
        CHECK(now->position_m.x == now->position_m.z);
        CHECK(now->position_m.x >= last);
        last = now->position_m.x;
    }
    writer.join();
    CHECK(all_taken);
    CHECK(live.at(0)->position_m == glm::dvec3(19999));
}

TEST_CASE("objects out of reach are left alone, and nobody feels it")
{
    for (const ProbeKind probe : {ProbeKind::point, ProbeKind::sphere, ProbeKind::stylus}) {
        const bool is_sphere = probe == ProbeKind::sphere;
        const double friction = is_sphere ? 0 : 0.2;
        Scene lazy = field_of_balls(49, friction), eager = field_of_balls(49, friction);
        lazy.probe = eager.probe = {probe, 0.1, is_sphere ? 0.004 : 0.0};
        eager.servo.skips.objects = false;
        Renderer sleeping(shared(std::move(lazy))), watching(shared(std::move(eager)));
        int contacts = 0;
        const int ticks = test::tries(60'000);
        for (const DevicePose& pose : wild_walk(ticks, 0.3, is_sphere ? 5e-4 : 0.1)) {
            const TickResult expected = watching.tick(pose), found = sleeping.tick(pose);
            // A ball goes in steps as long as it knows its surroundings, until it moves too little to be felt.
            if (is_sphere)
                REQUIRE(glm::length(found.force_n - expected.force_n) < 1e-4);
            else
                REQUIRE(found.force_n == expected.force_n);
            REQUIRE(found.contacts == expected.contacts);
            contacts += static_cast<int>(found.contacts);
        }
        CHECK(contacts > test::tries(1000));
        CHECK(sleeping.skipped().objects > 40ull * ticks);
        CHECK(watching.skipped().objects == 0);
    }
}

TEST_CASE("a ball feels what it lies on at its radius, and both walls of a corner")
{
    constexpr double r = 0.01, stiffness = 1000;
    Scene scene = bare_scene(plane_mesh());
    Scene wall = bare_scene(plane_mesh());
    // The second plane stands upright at x = 0.02 and faces -x.
    wall.objects[0].placement = {glm::dmat3(glm::dvec3(0, 0, 1), glm::dvec3(0, 1, 0), glm::dvec3(-1, 0, 0)),
                                 {0.02, 0, 0}};
    scene.objects.push_back(wall.objects[0]);
    scene.probe = {ProbeKind::sphere, 0.1, r};
    Renderer renderer(shared(std::move(scene)));
    renderer.tick(at(0, 0, 0.03));
    for (int i = 0; i < 3; ++i) {
        const TickResult on_plane = renderer.tick(at(0, 0, r - 0.002));
        CHECK(glm::length(on_plane.force_n - glm::dvec3(0, 0, 0.002 * stiffness)) < 1e-7);
        CHECK(std::abs(on_plane.depth_m - 0.002) < 1e-10);
    }
    for (int i = 0; i < 3; ++i) renderer.tick(at(0.005, 0, r - 0.002));
    TickResult in_corner;
    for (int i = 0; i < 3; ++i) in_corner = renderer.tick(at(0.02 - r + 0.001, 0, r - 0.003));
    CHECK(in_corner.contacts == 2);
    CHECK(glm::length(in_corner.force_n - stiffness * glm::dvec3(-0.001, 0, 0.003)) < 1e-7);
}

TEST_CASE("a texture published to an object out of reach is there when the hand comes, and the old one is freed")
{
    Scene scene = field_of_balls(9);
    const auto slot = scene.objects[8].texture;
    Renderer renderer(shared(std::move(scene)));
    for (int i = 0; i < 100; ++i) renderer.tick(at(0, 0, 0.02)), renderer.between_ticks();
    std::vector<std::weak_ptr<const void>> published;
    for (int i = 0; i < 20; ++i) {
        const auto flat = [](const haptel_point&, glm::dvec3& gradient) {
            gradient = glm::dvec3(0);
            return -1e-4;
        };
        TextureBinding texture = lambda_texture(flat, -1e-4, 0);
        published.push_back(texture.owner);
        CHECK(slot->publish(std::move(texture)).empty());
        for (int tick = 0; tick < 100; ++tick) renderer.tick(at(0, 0, 0.02)), renderer.between_ticks();
    }
    CHECK(std::ranges::count_if(published, [](const auto& owner) { return !owner.expired(); }) <= 2);
    TickResult felt;
    for (int i = 0; i <= 300; ++i)
        felt = renderer.tick(at(0.1, 0.1, 0.02 - 1e-5 * std::min(i, 150) - 1e-4 * std::max(0, i - 215)));
    CHECK(felt.contacts == 1);
    CHECK(std::abs(felt.height_m + 1e-4) < 1e-15);
}

TEST_CASE("whoever the hand may have reached is awake")
{
    constexpr double anywhere = std::numeric_limits<double>::infinity();
    SleepQueue queue({{{}, anywhere}, {{}, anywhere}, {{}, anywhere}});
    const auto go = [&](double way_m) { queue.go(way_m, {}, {}, 1e-6); };
    CHECK(queue.awake() == std::vector<uint32_t>{0, 1, 2});
    queue.sleep(1, 0.5);
    queue.sleep(0, 0.2);
    CHECK(queue.awake() == std::vector<uint32_t>{2});
    go(0.1);
    go(0.05);
    CHECK(queue.awake().size() == 1);
    go(0.05);
    CHECK(queue.awake() == std::vector<uint32_t>{0, 2});
    go(0.3);
    CHECK(queue.awake() == std::vector<uint32_t>{0, 1, 2});
    queue.sleep(2, 10);
    go(anywhere);
    CHECK(queue.awake().size() == 3);
}

TEST_CASE("who turns is looked at before the whole gap is gone, who is at rest is not")
{
    constexpr double anywhere = std::numeric_limits<double>::infinity();
    SleepQueue queue({{.radius_m = anywhere}, {.radius_m = anywhere, .turns = true}});
    queue.sleep(0, 1);
    queue.sleep(1, 1);
    const auto go = [&](double way_m) { queue.go(way_m, {}, {}, 1e-6); };
    go(0.89);
    CHECK(queue.awake().empty());
    go(0.05);
    CHECK(queue.awake() == std::vector<uint32_t>{1});
    go(0.05999);
    CHECK(queue.awake() == std::vector<uint32_t>{1});
    go(0.00001);
    CHECK(queue.awake() == std::vector<uint32_t>{0, 1});
}

TEST_CASE("who is still far away when the hand has gone far sleeps on, and wakes before the hand is there")
{
    SleepQueue queue({{{1, 0, 0}, 0.1}});
    queue.go(0, {}, {}, 1e-3);
    REQUIRE(queue.awake().empty());
    double x = 0;
    for (int i = 0; i < 1000; ++i) { // to and fro: 10 m of way
        x = i % 2 * 0.01;
        queue.go(0.01, {x, 0, 0}, {x, 1, 0}, 1e-3);
        REQUIRE(queue.awake().empty());
    }
    for (; queue.awake().empty() && x < 1; x += 0.01) queue.go(0.01, {x, 0, 0}, {x, 1, 0}, 1e-3);
    CHECK(x < 0.9 + 0.02);
    CHECK(x > 0.8);
    // A tail that reaches farther than the tip counts, and so does the shaft between.
    SleepQueue beside({{{0, 0.5, 0}, 0.1}});
    beside.go(0, {-0.15, 0, 0}, {-0.15, 1, 0}, 1e-3);
    REQUIRE(beside.awake().empty());
    beside.go(0.06, {-0.06, 0, 0}, {0.06, 1, 0}, 1e-3);
    CHECK(beside.awake().size() == 1);
}
