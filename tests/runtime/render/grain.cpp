// Friction with a grain as textures tell it: from the object's space to the hand.
#include "runtime/render/body.h"
#include "tests/runtime/render/stroke.h"

using namespace haptel;
using namespace haptel::runtime;
using namespace haptel::tests;
using glm::dvec3;

namespace {

constexpr double mu = 0.3, below_m = 1e-3;

// A flat texture with that grain.
TextureBinding grained(const dvec3& direction, double along)
{
    return sample_lambda(
        [=](const haptel_point&, haptel_sample& sample) {
            for (int i = 0; i < 3; ++i) sample.friction_direction[i] = direction[i];
            sample.friction_along_scale = along;
        },
        0, 0, 0);
}

} // namespace

// Maximum dissipation: for a motion v the force is -m N S^2 v / |S v|, with S along and across the grain.
TEST_CASE("a texture's grain is of its object's space, and of what of it lies in the surface, alone and joined")
{
    const dvec3 normal = dvec3(1, 2, 2) / 3.0, a = dvec3(2, 1, -2) / 3.0, b = glm::cross(normal, a),
                place(0.01, 0.02, 0);
    for (const ProbeKind kind : {ProbeKind::point, ProbeKind::sphere, ProbeKind::gripper})
        for (const bool meets : {false, true})
            for (const double along : {0.3, 2.5})
                for (const double way_angle : {0.4, 0.4 + 0.25 * std::numbers::pi, 0.1, -0.3}) {
                    const dvec3 grain = std::cos(0.4) * a + std::sin(0.4) * b, across = glm::cross(normal, grain);
                    // The second lies beside the first, turned by a right angle in the same plane.
                    const auto one = [&](const dvec3& at, const dvec3& x) {
                        const glm::dmat3 rotation(x, glm::cross(normal, x), normal);
                        return behind(at, normal, x, spring_n_per_m, mu,
                                      grained((7.0 * grain + 2.0 * normal) * rotation, along));
                    };
                    Scene scene;
                    scene.servo.force_rise_s = 0;
                    scene.servo.force_limit_n = 100;
                    if (meets)
                        scene = joined({one(place, a), one(place + 0.1 * a, b)});
                    else
                        scene.objects = {one(place, a)};
                    scene = with_probe(std::move(scene), kind);
                    const double radius_m = scene.probe.radius_m;
                    Stroke stroke(std::move(scene), 0.02 * b);
                    const dvec3 v = std::cos(way_angle) * a + std::sin(way_angle) * b;
                    const double va = glm::dot(v, grain), vc = glm::dot(v, across);
                    const dvec3 held = (along * along * va * grain + vc * across) / std::hypot(along * va, vc);
                    const int ends = kind == ProbeKind::gripper ? 2 : 1;
                    const dvec3 expected_n = ends * spring_n_per_m * below_m * (normal - mu * held);
                    const auto on_way = [&](double gone_m) {
                        return place + (radius_m - below_m) * normal - 0.02 * a - 0.01 * b + gone_m * v;
                    };
                    stroke.to(on_way(0) + 3e-3 * normal);
                    stroke.to(on_way(0));
                    CAPTURE(static_cast<int>(kind), meets, along, way_angle);
                    for (const double gone_m : {15e-3, 20e-3, meets && way_angle < 0.5 ? 85e-3 : 25e-3}) {
                        stroke.to(on_way(gone_m));
                        CHECK(glm::distance(stroke.force_n(), expected_n) < 2e-5 * spring_n_per_m * below_m);
                    }
                }
}

TEST_CASE("without a direction along the surface, or with the same friction along it, forces are those of no grain")
{
    const auto forces = [](const TextureBinding& texture, ProbeKind kind) {
        Scene scene = with_probe(bare_scene(ball_mesh(3, 0.1), texture), kind);
        scene.objects[0].material = {spring_n_per_m, 1, mu, 0.2};
        Renderer renderer(shared(std::move(scene)));
        std::mt19937 random(4);
        std::normal_distribution<double> any;
        dvec3 place(0, 0, 0.06), aim = place;
        std::vector<TickResult> results;
        for (int i = 0; i < 3000; ++i) {
            if (i % 40 == 0) aim = 0.049 * glm::normalize(dvec3(any(random), any(random), 3 + any(random)));
            place += 0.03 * (aim - place);
            results.push_back(renderer.tick({place, place + dvec3(0.01, 0, 0.05)}));
        }
        return results;
    };
    const auto of_normal = sample_lambda(
        [](const haptel_point& at, haptel_sample& sample) {
            for (int i = 0; i < 3; ++i) sample.friction_direction[i] = -3 * at.n[i];
            sample.friction_along_scale = 0.2;
        },
        0, 0);
    for (const ProbeKind kind : every_probe) {
        const std::vector<TickResult> plain = forces(flat_texture(0), kind);
        CHECK(std::ranges::count_if(plain, [](const TickResult& one) { return one.contacts > 0; }) > 1000);
        const std::pair<TextureBinding, uint32_t> others[] = {
            {grained(dvec3(0), 0.2), 0},
            {grained({1, 2, 3}, 1), 0},
            {of_normal, 0},
            {grained({1, std::nan(""), 3}, 0.2), HAPTEL_FAULT_OUTPUT_NOT_FINITE},
            {grained({HUGE_VAL, 0, 0}, 0.2), HAPTEL_FAULT_OUTPUT_NOT_FINITE},
            {grained({1, 2, 3}, std::nan("")), HAPTEL_FAULT_OUTPUT_NOT_FINITE}};
        for (const auto& [texture, fault] : others) {
            const std::vector<TickResult> found = forces(texture, kind);
            uint32_t faults = 0;
            size_t differing = 0;
            for (size_t i = 0; i < plain.size(); ++i) {
                faults |= found[i].faults;
                differing += found[i].force_n != plain[i].force_n;
            }
            CHECK(differing == 0);
            CHECK(faults == fault);
        }
        size_t differing = 0;
        const std::vector<TickResult> found = forces(grained({1, 2, 3}, 0.2), kind);
        for (size_t i = 0; i < plain.size(); ++i) differing += found[i].force_n != plain[i].force_n;
        CHECK(differing > 500);
    }
}

// To the hand, from above the ball to above it, by the trapezoid of forces: what friction takes is much more than what
// that is off by.
TEST_CASE("on closed paths friction with a grain takes energy from the hand, textured and on a ball")
{
    const auto waves = [](const haptel_point& at, haptel_sample& sample) {
        constexpr double k = 2 * std::numbers::pi / 4e-3;
        sample.height_m = 20e-6 * std::sin(k * at.p[0]);
        sample.gradient[0] = 20e-6 * k * std::cos(k * at.p[0]);
        sample.friction_direction[0] = std::sin(300 * at.p[1]); // it bends, and is none on some lines
        sample.friction_direction[1] = std::cos(200 * at.p[0]);
        sample.friction_along_scale = 0.2 + 20 * std::abs(at.p[0]);
    };
    std::mt19937 random(6);
    std::uniform_real_distribution<double> phase(0, 2 * std::numbers::pi);
    for (const bool ball : {false, true})
        for (int loop = 0; loop < 12; ++loop) {
            Scene scene = bare_scene(ball ? ball_mesh(4, 0.1) : plane_mesh(), sample_lambda(waves, -20e-6, 20e-6));
            scene.objects[0].material = {spring_n_per_m, 0, mu, 0.2};
            Stroke stroke(std::move(scene), dvec3(0), 5e-6);
            const double first = phase(random), second = phase(random);
            const auto place = [&](double t) {
                const dvec3 at(6e-3 * std::sin(t + first), 5e-3 * std::sin(2 * t + second),
                               1e-3 - 2e-3 * std::sin(0.5 * t));
                return ball ? (0.05 + at.z) * glm::normalize(dvec3(at.x, at.y, 0.05)) : at;
            };
            stroke.to(place(0));
            for (int i = 1; i <= 400; ++i) stroke.to(place(2 * std::numbers::pi * i / 400));
            CAPTURE(ball, loop, stroke.given_j());
            CHECK(stroke.touching() > 1000);
            CHECK(stroke.given_j() < -1e-6);
        }
}

// What two surfaces hold together is the mean of what each holds, weighted by how hard it pushes: as tensors, the mean
// coefficient times the mean grain is the mean of coefficients times grains.
TEST_CASE("where several surfaces hold a probe their grains are averaged by what friction holds there, in any order")
{
    const struct {
        Friction friction;
        double push_n;
    } parts[] = {{{0.8, 0.6}, 1.0},
                 {{0.3, 0.2, grain_along({1, 0, 0}, 0.2, {0, 0, 1})}, 2.0},
                 {{0.5, 0.5, grain_along({1, 2, 0}, 3, {0, 0, 1})}, 0.7},
                 {{0, 0, grain_along({1, 2, 0}, 9, {0, 0, 1})}, 0.7}};
    double weight = 0;
    Grain expected;
    for (const auto& [friction, push_n] : parts) {
        const double own = push_n * (friction.static_coefficient + friction.dynamic_coefficient);
        weight += own;
        expected.diagonal += own * friction.grain.diagonal;
        expected.mixed += own * friction.grain.mixed;
    }
    for (const std::vector<int>& order : std::vector<std::vector<int>>{{0, 1, 2, 3}, {3, 2, 1, 0}, {1, 3, 0, 2}}) {
        MeanFriction mean;
        for (const int i : order) mean.add(parts[i].friction, parts[i].push_n);
        CHECK(glm::distance(mean.mean.grain.diagonal, expected.diagonal / weight) < 1e-14);
        CHECK(glm::distance(mean.mean.grain.mixed, expected.mixed / weight) < 1e-14);
    }
}
