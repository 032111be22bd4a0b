// Objects that are one to the probe: what the hand feels of each is what it feels where each is touched by itself.
#include "runtime/contact/end_contact.h"
#include "runtime/render/body.h"
#include "runtime/render/renderer.h"
#include "runtime/render/renderer_slot.h"
#include "runtime/servo/allocation_count.h"
#include "runtime/surface/collision.h"
#include "runtime/surface/corner.h"
#include "runtime/texture/shading.h"
#include "tests/support/catch.h"
#include "tests/support/lambda_texture.h"
#include "tests/support/touch_scenes.h"
#include "tests/support/tries.h"

#include <algorithm>
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

// Powers of two and 3-4-5 turns, so that no vertex is rounded, in whichever space.
constexpr double half_box_m = 5.0 / 512;
constexpr double apart_m = 1.0 / 16;
const dvec3 middle_m[3] = {{-apart_m, 1.0 / 128, 0}, {0, -apart_m, 0}, {apart_m, 0, 1.0 / 256}};

// Three boxes that do not meet, with all that objects may have: the second swings, the last is turned.
Scene three_boxes(double friction_share = 1)
{
    Mesh box = make_box();
    scale_to_size(box, 2 * half_box_m);
    Scene scene = bare_scene(box);
    const auto add = [&](const glm::dmat3& rotation, double stiffness_n_per_m, double damping_n_s_per_m,
                         double friction, TextureBinding texture) -> SceneObject& {
        SceneObject object = scene.objects.front();
        object.placement = {rotation, middle_m[scene.objects.size() - 1]};
        friction *= friction_share; // at rest and sliding alike: a proxy remembers sliding until its next touch
        object.material = {stiffness_n_per_m, damping_n_s_per_m, friction, friction};
        object.texture = std::make_shared<TextureSlot>(std::move(texture));
        return scene.objects.emplace_back(object);
    };
    SceneObject& first = add(glm::dmat3(1), 300, 0.5, 0.3, sine_texture(20e-6, 2e-3));
    first.effects.magnet = {0.2, 3e-3};
    first.effects.vibration = {0.1, 60, {0.6, 0, 0.8}};
    SceneObject& second = add(glm::dmat3(1), 100, 0.1, 0.2, {});
    SteadyMotion::Figures figures;
    figures.swing_m = {0, 0, 1e-3};
    figures.swing_hz = 3;
    second.motion = std::make_shared<SteadyMotion>(second.placement, figures);
    const auto rough = [](const haptel_point& at, haptel_sample& sample) {
        sample.height_m = 1e-5 * at.n[2] + 2e-3 * at.p[0];
        for (int i = 0; i < 3; ++i) sample.gradient[i] = 1e-5 * at.n_dp[2][i] + (i == 0 ? 2e-3 : 0);
        sample.friction_scale = 1 + 10 * at.p[1];
        sample.stiffness_scale = 1 - 10 * at.p[2];
    };
    SceneObject& last = add(glm::dmat3(dvec3(0, 0.6, 0.8), dvec3(0, -0.8, 0.6), dvec3(1, 0, 0)), 200, 0.2, 0.5,
                            sample_lambda(rough, -1e-4, 1e-4));
    last.effects.damping_n_s_per_m = 0.5;
    last.effects.damping_reach_m = 5e-3;
    scene.objects.erase(scene.objects.begin());
    scene.servo.force_rise_s = 0.02;
    return scene;
}

// What joining makes of surfaces that do not meet.
std::shared_ptr<const Surface> joined_surface(const Scene& scene, const std::vector<uint32_t>& objects)
{
    const auto corner_m = [&](uint32_t number, uint32_t face, uint32_t corner) {
        return scene.objects[number].placement.to_world(scene.objects[number].surface->vertex_m(face, corner));
    };
    Mesh mesh;
    for (const uint32_t number : objects)
        for (uint32_t face = 0; face < scene.objects[number].surface->faces.size(); ++face) {
            const auto first = static_cast<uint32_t>(mesh.positions_m.size());
            for (uint32_t corner = 0; corner < 3; ++corner) mesh.positions_m.push_back(corner_m(number, face, corner));
            mesh.triangles.push_back({first, first + 1, first + 2});
        }
    const auto surface = std::const_pointer_cast<Surface>(build_surface(mesh).surface);
    for (uint32_t face = 0; face < surface->faces.size(); ++face) {
        const dvec3 centre_m = surface->vertex_m(face, 0) + surface->vertex_m(face, 1) + surface->vertex_m(face, 2);
        double least_m = std::numeric_limits<double>::infinity();
        Origin nearest;
        for (uint32_t part = 0; part < objects.size(); ++part)
            for (uint32_t own = 0; own < scene.objects[objects[part]].surface->faces.size(); ++own) {
                const double away_m =
                    glm::distance(centre_m, corner_m(objects[part], own, 0) + corner_m(objects[part], own, 1) +
                                                corner_m(objects[part], own, 2));
                if (away_m < least_m) least_m = away_m, nearest = {part, own};
            }
        REQUIRE(least_m < 1e-12);
        surface->origins.push_back(nearest);
    }
    return surface;
}

// The first and the last as one; their order as parts is another than in the scene.
Scene joined(Scene scene)
{
    const std::vector<uint32_t> objects = {2, 0};
    scene.joined.push_back({joined_surface(scene, objects), objects});
    return scene;
}

// Jumps, strolls and presses in the ball around one box, in no way near another, and round it to its top; then the
// same at the next one.
class VisitingHand {
public:
    VisitingHand(uint64_t seed, double step_max_m) : random_(seed), step_max_m_(step_max_m) {}

    dvec3 next()
    {
        if (left_-- == 0) {
            habit_ = static_cast<int>(random_() % 3);
            left_ = 40; // all hands alike, so that they go together
            target_m_ = in_ball();
            if (++habits_ % 8 == 0) habit_ = 3, left_ = 400;
        }
        const dvec3 before_m = hand_m_;
        switch (habit_) {
        case 0: hand_m_ = in_ball(); break;
        case 1: hand_m_ += 3e-4 * in_ball() / ball_m; break;
        case 2: hand_m_ += 0.03 * (target_m_ - hand_m_) + 1e-5 * in_ball() / ball_m; break;
        default: // over a ball around the box to its top, to rest there; then over there
            if (left_ > 200)
                hand_m_ = ball_m * glm::normalize(hand_m_ + dvec3(0, 0, 0.03 * ball_m));
            else
                hand_m_ = {0, 0, ball_m};
            if (left_ == 100) at_ = (at_ + 1) % 3;
        }
        const double step_m = glm::distance(hand_m_, before_m);
        if (step_m > step_max_m_) hand_m_ = before_m + step_max_m_ / step_m * (hand_m_ - before_m);
        if (glm::length(hand_m_) > ball_m) hand_m_ *= ball_m / glm::length(hand_m_);
        return middle_m[at_] + hand_m_;
    }
    // Above one of the boxes, where nothing is touched any more.
    bool leaves() const { return habit_ == 3 && left_ < 100; }
    int at() const { return at_; }

    static constexpr double ball_m = 2.2 * half_box_m;

private:
    dvec3 in_ball()
    {
        std::uniform_real_distribution<double> uniform(-1, 1);
        for (;;) {
            const dvec3 place(uniform(random_), uniform(random_), uniform(random_));
            if (glm::length(place) < 1) return ball_m * place;
        }
    }

    std::mt19937_64 random_;
    double step_max_m_;
    dvec3 hand_m_{0, 0, ball_m}, target_m_{0};
    int habit_ = 3, left_ = 10, habits_ = 0, at_ = 0;
};

} // namespace

TEST_CASE("joined objects that do not meet are felt as each by itself, by any probe and hand")
{
    // Fingers push against each other; their sum is small beside them. A stylus has a radius that goes with its
    // object's size: in which of two ticks it slides off an edge may depend on it. A ball goes by steps of what it has
    // seen around it, until it moves too little to be felt.
    const struct {
        ProbeKind kind;
        double friction_share, step_max_m, tolerance_n;
    } probes[] = {{ProbeKind::point, 0, 1, 1e-9},      {ProbeKind::point, 1, 2e-4, 1e-9},
                  {ProbeKind::gripper, 1, 2e-4, 1e-8}, {ProbeKind::sphere, 0, 2e-4, 1e-4},
                  {ProbeKind::stylus, 0, 2e-4, 0.01},  {ProbeKind::stylus, 1, 2e-4, 0.01}};
    for (const auto& probe : probes) {
        if (haptel::test::is_sanitized && probe.kind != ProbeKind::sphere && probe.friction_share == 0) continue;
        CAPTURE(static_cast<int>(probe.kind), probe.friction_share);
        Scene scene = three_boxes(probe.friction_share);
        scene.objects[0].effects.magnet = {}; // that aims the proxy of all three
        scene.probe = {probe.kind, 0.03, probe.kind == ProbeKind::sphere ? 2e-3 : 0};
        const auto slot = scene.objects[2].texture;
        Renderer apart(shared(scene)), together(shared(joined(scene)));
        VisitingHand tip(7, probe.step_max_m), tail(11, probe.step_max_m);
        int touched[3] = {}, interruptions = 0, differences = 0, off_edges = 0;
        for (int i = 0; i < 60000; ++i) {
            if (i % 20000 == 10000) CHECK(slot->publish(sine_texture(1e-7 * i / 1e2, 1e-3)).empty());
            DevicePose pose;
            pose.tip_m = tip.next();
            pose.tail_m = tail.next();
            if (probe.kind != ProbeKind::gripper) pose.tail_m = pose.tip_m + dvec3(0, 0, 0.03);
            if (i % 1000 == 999) pose.tip_m.y = std::nan("");
            const uint64_t before = allocations_of_this_thread();
            const TickResult found = together.tick(pose);
            together.between_ticks();
            REQUIRE(allocations_of_this_thread() == before);
            const TickResult expected = apart.tick(pose);
            apart.between_ticks();
            CAPTURE(i);
            const double tolerance_n = probe.tolerance_n * std::max(1.0, glm::length(expected.unlimited_force_n));
            if (probe.kind == ProbeKind::stylus &&
                (found.contacts != expected.contacts ||
                 glm::distance(found.unlimited_force_n, expected.unlimited_force_n) >= tolerance_n)) {
                ++off_edges;
                continue;
            }
            REQUIRE(found.contacts == expected.contacts);
            // Round an edge a ball may need all its rounds, or one less where lengths are rounded otherwise.
            const auto but_rounds = [](const TickResult& result) { return result.faults & ~fault_contact_unfinished; };
            REQUIRE(but_rounds(found) == but_rounds(expected));
            REQUIRE(found.interrupted == expected.interrupted);
            REQUIRE(found.binding == expected.binding);
            REQUIRE(glm::distance(found.force_n, expected.force_n) < tolerance_n);
            REQUIRE(glm::distance(found.unlimited_force_n, expected.unlimited_force_n) < tolerance_n);
            REQUIRE(glm::distance(found.torque_n_m, expected.torque_n_m) < 0.1 * tolerance_n);
            REQUIRE(std::abs(found.grip_force_n - expected.grip_force_n) < tolerance_n);
            if (probe.kind != ProbeKind::stylus) // its contacts may push each other by more, or less
                REQUIRE(std::abs(found.depth_m - expected.depth_m) < 0.1 * tolerance_n);
            REQUIRE(std::abs(found.height_m - expected.height_m) < 0.1 * tolerance_n);
            if (tip.leaves()) REQUIRE(expected.contacts == 0);
            touched[tip.at()] += expected.contacts > 0;
            interruptions += expected.interrupted;
            differences += found.force_n != expected.force_n;
        }
        for (const int ticks : touched) CHECK(ticks > 1000);
        CHECK(off_edges <= 30); // of 60 000
        CHECK(interruptions == 59);
        CHECK(differences > 1000); // the proxies are others
        CHECK(together.skipped().objects < apart.skipped().objects);
    }
}

TEST_CASE("a gripper with one finger on each of two joined objects feels both")
{
    Scene scene = three_boxes(0);
    scene.probe.kind = ProbeKind::gripper;
    Renderer apart(shared(scene)), together(shared(joined(scene)));
    const auto fingers = [](double depth_m) {
        const double z_m = half_box_m - depth_m;
        return DevicePose{middle_m[2] + dvec3(0, 1e-3, z_m), middle_m[0] + dvec3(2e-3, 0, z_m - 1e-3)};
    };
    for (int i = 0; i < 200; ++i) {
        const TickResult found = together.tick(fingers(5e-5 * i - 3e-3)),
                         expected = apart.tick(fingers(5e-5 * i - 3e-3));
        REQUIRE(found.contacts == expected.contacts);
        REQUIRE(glm::distance(found.force_n, expected.force_n) < 1e-9);
        REQUIRE(glm::distance(found.torque_n_m, expected.torque_n_m) < 1e-10);
        REQUIRE(std::abs(found.grip_force_n - expected.grip_force_n) < 1e-9);
        REQUIRE(std::abs(found.depth_m - expected.depth_m) < 1e-12);
    }
    CHECK(together.tick(fingers(5e-3)).contacts == 2);
}

TEST_CASE("joined objects sleep and wake as one, and are counted as the objects that they are")
{
    for (const double share : {0.0, 1.0}) { // with friction, and without
        const Scene scene = three_boxes(share);
        Renderer apart(shared(scene)), together(shared(joined(scene)));
        const auto asleep = [](Renderer& renderer, const dvec3& hand) {
            const uint64_t before = renderer.skipped().objects;
            for (int i = 0; i < 100; ++i) renderer.tick(at(hand.x + 1e-6 * i, hand.y, hand.z));
            return renderer.skipped().objects - before;
        };
        const dvec3 far(0.3, 0.2, 0.5), near = middle_m[0] + dvec3(0, 0, half_box_m + 1e-3);
        asleep(apart, far), asleep(together, far);
        CHECK(asleep(apart, far) == 300);
        CHECK(asleep(together, far) == 300);
        asleep(apart, near), asleep(together, near);
        CHECK(asleep(apart, near) == 200);
        CHECK(asleep(together, near) == 100); // the third is by itself
        asleep(together, far);
        CHECK(asleep(together, far) == 300);
    }
}

TEST_CASE("a scene in the place of another goes on touching what is joined as before, friction and all")
{
    Scene first = joined(three_boxes());
    first.objects[0].effects = {}; // a vibration begins anew
    Scene apart = first;
    apart.joined.clear();
    for (const Scene* next : {&std::as_const(first), &std::as_const(apart)}) {
        RendererSlot slot(shared(first), {});
        auto swapped = std::make_unique<Renderer>(shared(first));
        Renderer plain(shared(first));
        const auto press = [&](int i) { // on a face of the first object, and then along it
            const dvec3 place = first.objects[0].placement.to_world(
                {half_box_m + std::max(-2e-3, 1e-3 - 1e-4 * i), 1e-3, 1e-5 * std::max(0, i - 50)});
            return at(place.x, place.y, place.z);
        };
        for (int i = 0; i < 300; ++i) {
            if (i == 200) slot.publish(shared(*next));
            slot.take(swapped);
            const TickResult found = swapped->tick(press(i)), expected = plain.tick(press(i));
            if (i < 200) continue;
            REQUIRE(found.contacts == 1);
            CHECK(found.depth_m > 1.9e-3);
            CHECK(std::abs(expected.force_n.z) > 0.05);
            if (next != &first) continue; // put down anew from above: no friction yet
            CHECK(found.depth_m == expected.depth_m);
            CHECK(glm::distance(found.unlimited_force_n, expected.unlimited_force_n) < 1e-12);
        }
    }
}

TEST_CASE("a contact with joined objects is, for the one it belongs to, the contact with that one")
{
    const Scene scene = joined(three_boxes(0));
    const JoinedObjects& both = scene.joined[0];
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(-1, 1);
    int turned = 0;
    for (int i = 0; i < 20000; ++i) {
        const uint32_t number = i % 2 == 0 ? 0 : 2;
        const SceneObject& object = scene.objects[number];
        const auto in_box = [&](double size) {
            return size * half_box_m * dvec3(uniform(random), uniform(random), uniform(random));
        };
        const auto own = make_point(object.surface), together = make_point(both.surface);
        const Friction friction;
        for (const dvec3& hand : {2.5 * half_box_m * glm::normalize(in_box(1)), in_box(1), in_box(1.1)}) {
            own->update(hand, friction);
            together->update(object.placement.to_world(hand), friction);
        }
        const Contact &expected = own->contact(), &on_both = together->contact();
        // The ball that a point is on both does not know on which side of a face a hand is that is nearer than its
        // radius.
        const dvec3 away = glm::abs(expected.hand_m);
        if (std::abs(std::max({away.x, away.y, away.z}) - half_box_m) <
            Lattice::point_radius * both.surface->lattice.unit_m)
            continue;
        REQUIRE(on_both.touching == expected.touching);
        if (!expected.touching) continue;
        REQUIRE(both.objects[both.surface->origins[on_both.face].part] == number);
        const Contact found = on_part(on_both, *both.surface, object);
        REQUIRE(found.face == expected.face);
        REQUIRE(found.side == expected.side);
        REQUIRE(found.sliding == expected.sliding);
        REQUIRE(glm::distance(found.proxy_m, expected.proxy_m) < 1e-11);
        REQUIRE(glm::distance(found.hand_m, expected.hand_m) < 1e-12);
        REQUIRE(glm::distance(found.barycentric, expected.barycentric) < 1e-9);
        REQUIRE(found.facet_normal == expected.facet_normal);
        REQUIRE((found.normal == found.facet_normal) == (expected.normal == expected.facet_normal));
        REQUIRE(glm::distance(found.normal, expected.normal) * expected.depth_m < 1e-11);
        REQUIRE(std::abs(found.depth_m - expected.depth_m) < 1e-11);
        REQUIRE(glm::distance(found.lag_m, expected.lag_m) < 1e-11);
        turned += number == 2;
        // As far beside its triangle as joining may put it.
        for (uint32_t corner = 0; corner < 3; ++corner) {
            Contact beside = on_both;
            beside.proxy_m = both.surface->vertex_m(on_both.face, corner) + in_box(2e-6);
            const Contact moved = on_part(beside, *both.surface, object);
            REQUIRE(moved.face == expected.face);
            for (int k = 0; k < 3; ++k) REQUIRE(moved.barycentric[k] >= 0);
            REQUIRE(std::abs(moved.barycentric.x + moved.barycentric.y + moved.barycentric.z - 1) < 1e-15);
            dvec3 place(0);
            for (uint32_t k = 0; k < 3; ++k)
                place += moved.barycentric[static_cast<int>(k)] * object.surface->vertex_m(moved.face, k);
            REQUIRE(glm::distance(place, moved.proxy_m) < 1e-5 * half_box_m);
        }
    }
    CHECK(turned > 5000);
}

TEST_CASE("contacts with joined objects go to each object in their order")
{
    const Scene scene = joined(three_boxes());
    const Surface& surface = *scene.joined[0].surface;
    const uint32_t parts[] = {1, 0, 1, 1, 0};
    std::vector<Contact> contacts;
    for (const uint32_t part : parts) {
        const auto of_part = [&](const Origin& origin) { return origin.part == part; };
        Contact contact;
        contact.face = static_cast<uint32_t>(std::find_if(surface.origins.begin(), surface.origins.end(), of_part) -
                                             surface.origins.begin());
        contact.depth_m = static_cast<double>(contacts.size());
        contacts.push_back(contact);
    }
    ContactsByPart by_part;
    CHECK(by_part.of(scene, scene.joined[0], {}).empty());
    const auto found = by_part.of(scene, scene.joined[0], contacts);
    REQUIRE(found.size() == 2);
    CHECK(found[0].part == 1);
    CHECK(found[1].part == 0);
    std::vector<double> order;
    for (const PartContacts& part : found)
        for (const Contact& contact : part.contacts) order.push_back(contact.depth_m);
    CHECK(order == std::vector<double>{0, 2, 3, 1, 4});
    const std::vector<Contact> many(30, contacts[0]);
    CHECK(by_part.of(scene, scene.joined[0], many)[0].contacts.size() == ContactsByPart::most);
}
