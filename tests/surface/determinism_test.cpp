// The same scene and the same hand give the same bits: twice, from a trace, and with every compiler.
#include "device/device_factory.h"
#include "runtime/servo/trace_csv.h"
#include "tests/surface/textured.h"

#include <algorithm>
#include <bit>
#include <cfloat>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <unistd.h>
#include <vector>

using namespace haptel;
using namespace haptel::runtime;
using namespace haptel::test;
using glm::dvec3;

namespace {

// What the bits below stand for: one rounding per operation, as IEEE 754 has it.
#ifdef __FAST_MATH__
#error "forces are repeated bit for bit: no -ffast-math"
#endif
static_assert(FLT_EVAL_METHOD == 0);

const char* const played_source = R"(
texture rock() { return 60um * fbm(p / 4mm, 4); }
texture printed() { return 40um * sinturn(20.0 * uv.x) * costurn(20.0 * uv.y); }
texture by_normal() { return 50um * triplanar(perlin, p / 6mm, n); }
texture sticky(out float friction_scale, out float stiffness_scale)
{
    friction_scale = 1.0 + 0.5 * sinturn(p.x / 5mm);
    stiffness_scale = 0.8 + 0.1 * sinturn(p.y / 7mm);
    return 30um * noise(p / 3mm);
}
texture drifting() { return 30um * sinturn(p.x / 4mm + 0.5 * time / 1s); }
)";

SceneObject object_of(const std::shared_ptr<const jit::CompiledProgram>& program, Mesh mesh, double size_m,
                      const char* texture, const dvec3& position_m)
{
    scale_to_size(mesh, size_m);
    SceneObject object;
    object.surface = build_surface(mesh).surface;
    object.material = {900, 1.5, 0.4, 0.25};
    object.placement.position_m = position_m;
    object.texture = std::make_shared<TextureSlot>(bound_for(program, texture, *object.surface, {}, {}, 0.3e-3));
    return object;
}

// All that a scene can have: five textures, objects at rest, turning and swinging, touching each other, effects of
// objects and regions, rise and wait.
Scene scene_of_everything()
{
    const auto program = compiled(played_source);
    Scene scene;
    scene.objects.push_back(object_of(program, make_plane(16), 0.12, "sticky", {0, 0, 0}));
    scene.objects.push_back(object_of(program, make_torus(), 0.04, "printed", {0.03, 0, 0.004}));
    scene.objects.push_back(object_of(program, make_box(), 0.02, "by_normal", {-0.03, 0, 0.008}));
    scene.objects.push_back(object_of(program, make_icosphere(4), 0.02, "rock", {0, 0.02, 0.005}));
    scene.objects.push_back(object_of(program, make_sphere(), 0.02, "drifting", {0, -0.02, 0.005}));
    for (int i = 2; i < 4; ++i)
        scene.objects[size_t(i)].motion = std::make_shared<SteadyMotion>(
            scene.objects[size_t(i)].placement, SteadyMotion::Figures{{0, 0, 1}, 2.0 - i, {0.002, 0, 0}, 0.7});
    scene.objects[3].effects = {{0.5, 0.004}, 2, 0.005, {0.1, 120, {0, 0, 1}}, 0.004};
    Region bath;
    bath.shape = RegionShape::ball;
    bath.half_sides_m = dvec3(0.01);
    bath.placement.position_m = {0.02, 0.02, 0.005};
    bath.edge_m = 0.002;
    bath.damping_n_s_per_m = 3;
    bath.vibration = {0.05, 80, {1, 0, 0}};
    scene.regions.push_back(bath);
    scene.servo.force_rise_s = 0.03;
    scene.servo.wait_for_small_force_n = 2;
    return scene;
}

std::shared_ptr<const Scene> with_probe(Scene scene, const ProbeSettings& probe)
{
    scene.probe = probe;
    return tests::shared(std::move(scene));
}

// Over all of it, in and out, late and interrupted at times.
DevicePose pose_at(int tick, double& periods, const ProbeSettings& probe)
{
    DevicePose pose;
    pose.periods = tick % 50 == 49 ? 3 : 1;
    pose.interrupted = tick % 1500 == 1499;
    const double t = (periods += static_cast<double>(pose.periods)) * 1e-3;
    pose.tip_m = {0.045 * std::sin(1.3 * t), 0.03 * std::cos(2.1 * t),
                  probe.radius_m + 0.006 + 0.008 * std::sin(5.3 * t)};
    pose.tail_m = pose.tip_m + dvec3(0.02, 0.01, 0.1);
    return pose;
}

bool same_bits(const dvec3& a, const dvec3& b)
{
    const auto bits = [](double x) { return std::bit_cast<uint64_t>(x); };
    return bits(a.x) == bits(b.x) && bits(a.y) == bits(b.y) && bits(a.z) == bits(b.z);
}

bool same_bits(const TickResult& a, const TickResult& b)
{
    return same_bits(a.force_n, b.force_n) && same_bits(a.torque_n_m, b.torque_n_m) &&
           same_bits(a.unlimited_force_n, b.unlimited_force_n) &&
           same_bits(dvec3(a.time_s, a.depth_m, a.height_m), dvec3(b.time_s, b.depth_m, b.height_m)) &&
           a.interrupted == b.interrupted && a.waiting == b.waiting && a.contacts == b.contacts &&
           a.binding == b.binding && a.faults == b.faults;
}

} // namespace

TEST_CASE("a scene of everything: twin runs and the replay of its trace are equal in all bits")
{
    const Scene scene = scene_of_everything(), twin = scene_of_everything(); // compiled and built twice
    for (const ProbeSettings& probe :
         {ProbeSettings{ProbeKind::point, 0, 0}, {ProbeKind::sphere, 0, 3e-3}, {ProbeKind::stylus, 0.1, 0}}) {
        CAPTURE(int(probe.kind));
        Renderer one(with_probe(scene, probe)), other(with_probe(twin, probe));
        std::vector<TickRecord> records;
        std::vector<TickResult> felt;
        double periods = 0;
        int contacts = 0, several = 0;
        for (int i = 0; i < 15'000; ++i) {
            const DevicePose pose = pose_at(i, periods, probe);
            felt.push_back(one.tick(pose));
            one.between_ticks(); // which changes no force
            REQUIRE(same_bits(felt.back(), other.tick(pose)));
            contacts += felt.back().contacts > 0;
            several += felt.back().contacts > 1;
            TickRecord record;
            record.tick = uint64_t(i);
            record.time_s = felt.back().time_s;
            record.tip_m = pose.tip_m;
            record.tail_m = pose.tail_m;
            record.force_n = felt.back().force_n;
            record.interrupted = pose.interrupted;
            records.push_back(record);
        }
        CHECK(contacts > 3000);
        CHECK(several > 100);

        const std::filesystem::path trace =
            std::filesystem::temp_directory_path() / ("haptel-determinism-" + std::to_string(getpid()) + ".csv");
        {
            std::ofstream out(trace);
            write_trace_header(out);
            for (const TickRecord& record : records) write_trace_row(out, record);
        }
        DeviceRequest request;
        request.name = "replay:" + trace.string();
        request.rate_hz = 1000;
        const DeviceResult opened = device::open_device(request);
        std::filesystem::remove(trace);
        INFO(opened.error);
        REQUIRE(opened.device);
        Renderer again(with_probe(scene, probe));
        for (const TickResult& expected : felt) {
            DevicePose pose;
            REQUIRE(opened.device->read(pose) == DeviceStatus::ok);
            REQUIRE(same_bits(again.tick(pose), expected));
        }
    }
}

namespace {

// Whole numbers from a generator that the standard defines to the bit, and + - * / and square roots of them.
class Wander {
public:
    explicit Wander(uint32_t seed, const dvec3& place) : random_(seed), place_(place) {}

    // -1 .. 1
    double next() { return static_cast<double>(random_()) / 2147483648.0 - 1; }

    dvec3 toward(const dvec3& goal, double share) { return place_ += share * (goal - place_); }

private:
    std::mt19937 random_;
    dvec3 place_;
};

// An octahedron: angles at a vertex are equal, so that its normals do not depend on their digits.
Mesh octahedron()
{
    Mesh mesh;
    mesh.positions_m = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    mesh.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
    return mesh;
}

// Turned by a right triangle's angle about z and then x, exactly: 3, 4, 5 and 5, 12, 13.
glm::dmat3 turned()
{
    const glm::dmat3 about_z(0.6, 0.8, 0, -0.8, 0.6, 0, 0, 0, 1);
    const glm::dmat3 about_x(1, 0, 0, 0, 5.0 / 13, 12.0 / 13, 0, -12.0 / 13, 5.0 / 13);
    return about_x * about_z;
}

// There and back, by whole periods.
class Shuttle final : public Motion {
public:
    std::optional<Placement> at(double time_s) const noexcept override
    {
        const double share = time_s - std::floor(time_s);
        return Placement{turned(), {0.01 * std::abs(share - 0.5), -0.03, 0.0}};
    }
};

// FNV-1a.
class BitHash {
public:
    void add(const dvec3& v)
    {
        for (int k = 0; k < 3; ++k) {
            const auto bits = std::bit_cast<uint64_t>(v[k] + 0.0); // -0 is 0
            for (int byte = 0; byte < 8; ++byte) hash_ = (hash_ ^ (bits >> 8 * byte & 0xff)) * 0x100000001b3;
        }
    }
    std::string hex() const
    {
        char text[20];
        std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash_));
        return text;
    }

private:
    uint64_t hash_ = 0xcbf29ce484222325;
};

std::string hash_of_forces(const ProbeSettings& probe, double damping_n_s_per_m)
{
    const auto program = compiled(played_source);
    Scene scene;
    scene.probe = probe;
    scene.objects.push_back(object_of(program, make_plane(16), 0.12, "sticky", {0, 0, 0}));
    scene.objects.push_back(object_of(program, make_box(), 0.02, "by_normal", {0, -0.03, 0}));
    scene.objects[1].motion = std::make_shared<Shuttle>();
    Mesh mesh = octahedron();
    scale_to_size(mesh, 0.03);
    SceneObject round = object_of(program, mesh, 0.03, "rock", {0.01, 0.02, 0.005});
    round.surface = build_surface(mesh, 180).surface; // shaded all round
    round.placement.rotation = turned();
    round.effects.magnet = {0.5, 0.004};
    scene.objects.push_back(round);
    for (SceneObject& object : scene.objects) object.material.damping_n_s_per_m = damping_n_s_per_m;

    Renderer renderer(tests::shared(std::move(scene)));
    Wander wander(2024, {0, 0, 0.02}), lean(4202, {0, 0, 0.1});
    dvec3 goal(0), lean_goal(0);
    BitHash hash;
    int contacts = 0, by_shaft = 0;
    for (int i = 0; i < 30'000; ++i) {
        if (i % 150 == 0) {
            goal = {0.05 * wander.next(), 0.05 * wander.next(), 0.002 + 0.012 * wander.next()};
            lean_goal = {0.1 * lean.next(), 0.1 * lean.next(), 0.02 + 0.02 * lean.next()};
            if (probe.kind == ProbeKind::gripper) lean_goal *= dvec3(0.3, 0.3, 0.2);
        }
        DevicePose pose;
        pose.tip_m = wander.toward(goal, i % 1000 < 20 ? 0.5 : 0.01);
        pose.tail_m = pose.tip_m + (probe.has_tail() ? lean.toward(lean_goal, 0.01) : dvec3(0, 0, 0.1));
        pose.periods = damping_n_s_per_m > 0 && i % 70 == 69 ? 3 : 1;
        const TickResult felt = renderer.tick(pose);
        contacts += felt.contacts > 0;
        hash.add(felt.force_n);
        if (!probe.has_tail()) continue;
        hash.add(felt.torque_n_m);
        hash.add({felt.grip_force_n, 0, 0});
        const dvec3 by_tip = torque_about(felt.grip_m, pose.tip_m, felt.force_n);
        by_shaft += glm::distance(felt.torque_n_m, by_tip) > 1e-3;
    }
    CHECK(contacts > 8000);
    if (probe.has_tail()) CHECK(by_shaft > 1000); // or by the tail
    return hash.hex();
}

} // namespace

// These runs use + - * / and square roots, and the language's own elementary functions, so that no C library, compiler,
// optimisation level or instruction set has a say: contact of all probes, friction, damping, shading, textures by place
// and by normal with material outputs, a moving object, a magnet, late ticks.
//
// When a hash moves: it is found on one machine or with one compiler only? Then a rounding is not where it was written:
// look for -ffast-math, contraction to fma, x87, an elementary function of the C library, a value that was never set.
// It is found everywhere? Then the forces are others than before. If that was meant (another order of a sum is enough,
// and so is a triangle visited earlier), see that the other tests of contact and textures hold, and write down the new
// hash with the change that moved it.
TEST_CASE("the forces of a run are these bits, with every compiler, optimisation and instruction set")
{
    CHECK(hash_of_forces({ProbeKind::point, 0, 0}, 0) == "601a3bec0269b17a");
    CHECK(hash_of_forces({ProbeKind::sphere, 0, 3e-3}, 0) == "376c97fb3fd93abb");
    CHECK(hash_of_forces({ProbeKind::stylus, 0.1, 0}, 0) == "5b44b6c9a72a6f90");
    CHECK(hash_of_forces({ProbeKind::stylus, 0.1, 0}, 2) == "83eb8bc76277d0cc");
    CHECK(hash_of_forces({ProbeKind::gripper, 0.1, 0}, 2) == "b414227a8ea1ba38");
}

TEST_CASE("no multiplication is fused with an addition")
{
    volatile double a = 1 + 0x1p-30, b = 1 - 0x1p-30, c = -1;
    const double x = a, y = b, z = c;
    CHECK(x * y + z == 0); // exactly -2^-60, which rounding the product to 1 loses
    CHECK(std::fma(x, y, z) == -0x1p-60);
}
