// What a tick leaves out changes no force: with each skip off the hand feels the same.
#include "tests/surface/textured.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

using namespace haptel;
using namespace haptel::runtime;
using namespace haptel::test;
using glm::dvec3;
using tests::at;

namespace {

constexpr int ticks = 12'000;

const char* const skipping_source = R"(
texture solid() { return 60um * fbm(p / 4mm, 4); }
texture printed() { return 40um * sinturn(20.0 * uv.x) * costurn(20.0 * uv.y); }
texture by_normal() { return 50um * triplanar(perlin, p / 6mm, n); }

// fbm as the library has it, and the same with every octave computed, whatever is left of it.
texture rock()
{
    float sum = 0.0, frequency = 1.0, amplitude = 1.0, detail = footprint_in(p / 6mm);
    for (int i = 0; i < 6; i++) {
        if (detail < 1.0)
            sum += octave_strength(detail) * amplitude * perlin(frequency * p / 6mm);
        detail *= 2.0; frequency *= 2.0; amplitude *= 0.5;
    }
    return 60um * sum;
}
texture rock_in_full()
{
    float sum = 0.0, frequency = 1.0, amplitude = 1.0, detail = footprint_in(p / 6mm);
    for (int i = 0; i < 6; i++) {
        sum += octave_strength(detail) * amplitude * perlin(frequency * p / 6mm);
        detail *= 2.0; frequency *= 2.0; amplitude *= 0.5;
    }
    return 60um * sum;
}
)";

struct Case {
    const char *shape, *texture; // or none
    ProbeSettings probe = {};
    double footprint_m = 0;
};

const Case cases[] = {{"sphere", "solid"},
                      {"sphere", "printed"},
                      {"torus", "by_normal"},
                      {"plane", "solid"},
                      {"box", "printed"},
                      {"sphere", nullptr},
                      {"sphere", "solid", {ProbeKind::sphere, 0, 4e-3}},
                      {"icosphere", nullptr, {ProbeKind::sphere, 0, 4e-3}},
                      {"torus", "printed", {ProbeKind::stylus, 0.1, 0}}};

// Two rows of the shape, 5 cm each.
Scene scene_of(const Case& c)
{
    static const auto program = compiled(skipping_source);
    Mesh mesh = *make_shape(c.shape);
    scale_to_size(mesh, 0.05);
    Scene scene = tests::bare_scene(mesh);
    SceneObject object = scene.objects[0];
    object.material = {1000, 1.0, 0.3, 0.2};
    if (c.texture)
        object.texture =
            std::make_shared<TextureSlot>(bound_for(program, c.texture, *object.surface, {}, {}, c.footprint_m));
    scene.objects.clear();
    scene.probe = c.probe;
    for (int i = 0; i < 12; ++i) {
        object.placement.position_m = {0.08 * (i % 6), 0.08 * (i / 6), 0};
        scene.objects.push_back(object);
    }
    return scene;
}

struct Run {
    std::vector<dvec3> forces_n;
    SkippedStages skipped;
    int contacts = 0;
};

// Over the row, up and down, so that each shape is stroked and left.
Run run(Scene scene, const Skips& skips = {})
{
    scene.servo.skips = skips;
    const double top_m = scene.probe.radius_m + scene.objects[0].surface->box_maximum_m.z;
    Renderer renderer(tests::shared(std::move(scene)));
    Run run;
    for (int i = 0; i < ticks; ++i) {
        const double t = i * 1e-3;
        const dvec3 tip(0.2 - 0.2 * std::cos(0.5 * t), 0.01 * std::sin(2.3 * t), top_m + 6e-3 * std::cos(9 * t));
        const TickResult felt = renderer.tick({tip, tip + dvec3(0, 0, 0.1)});
        run.forces_n.push_back(felt.force_n);
        run.contacts += felt.contacts > 0;
    }
    run.skipped = renderer.skipped();
    return run;
}

double furthest_n(const Run& a, const Run& b)
{
    double furthest = 0;
    for (std::size_t i = 0; i < a.forces_n.size(); ++i)
        furthest = std::max(furthest, glm::distance(a.forces_n[i], b.forces_n[i]));
    return furthest;
}

} // namespace

TEST_CASE("no skip changes a force: free space, objects, texture and mapping, one after the other and all at once")
{
    for (const Case& c : cases) {
        CAPTURE(c.shape, c.texture ? c.texture : "none", int(c.probe.kind));
        const bool flat = *c.shape == 'p' || *c.shape == 'b';
        const Scene scene = scene_of(c);
        const Run all = run(scene);
        REQUIRE(all.contacts > 1000);
        const auto in_air = uint64_t(ticks - all.contacts);
        CHECK(in_air > 1000);
        CHECK(all.skipped.free_space > 100);
        CHECK(all.skipped.objects > 9 * ticks);
        CHECK(all.skipped.texture == (c.texture ? in_air : ticks));
        CHECK(all.skipped.octaves == 0);
        // Nobody needs the turning of normals, but `printed` the mesh's coordinates.
        const bool printed = c.texture && std::string(c.texture) == "printed";
        CHECK(all.skipped.mapping == (printed && flat ? 0 : uint64_t(all.contacts)));

        // Without clearance the ways are swept, and nothing is hit: the same bits.
        CHECK((run(scene, {.free_space = false}).forces_n == all.forces_n));
        CHECK((run(scene, {.objects = false}).forces_n == all.forces_n));
        const Run evaluated = run(scene, {.texture = false});
        CHECK((evaluated.forces_n == all.forces_n));
        CHECK((evaluated.skipped.texture < all.skipped.texture) == (c.texture != nullptr));
        // On flat faces the turning of normals is 0 but for rounding, of which the texture's slope takes a share.
        const Run mapped = run(scene, {.mapping = false});
        CHECK(furthest_n(mapped, all) <= (flat ? 1e-12 : 0));

        const Run nothing = run(scene, {false, false, false, false});
        CHECK(furthest_n(nothing, all) <= (flat ? 1e-12 : 0));
        CHECK(nothing.skipped.free_space == 0);
        CHECK(nothing.skipped.objects == 0);
        CHECK(nothing.skipped.texture == (c.texture ? 0 : ticks));
        CHECK(nothing.skipped.mapping == 0);
    }
}

TEST_CASE("the turning of normals is left out where the force model does not ask for it")
{
    for (const ForceModel model : {ForceModel::paper, ForceModel::ho99}) {
        Scene scene = scene_of({"sphere", "solid"});
        scene.servo.force.model = model;
        const Run all = run(scene);
        CHECK(all.skipped.mapping == uint64_t(all.contacts));
        CHECK((run(scene, {.mapping = false}).forces_n == all.forces_n));
    }
}

TEST_CASE("octaves finer than the footprint are left out, are counted, and would add nothing")
{
    const auto texture = [](const char* name, double footprint_m) {
        return run(scene_of({"sphere", name, {}, footprint_m}));
    };
    // Wavelengths from 6 mm down to 0.19 mm; in space the footprint counts sqrt(3) times.
    const Run full = texture("rock_in_full", 0);
    for (const double footprint_m : {0.3e-3, 0.6e-3, 2e-3, 8e-3}) {
        CAPTURE(footprint_m);
        const Run limited = texture("rock", footprint_m);
        CHECK((limited.forces_n == texture("rock_in_full", footprint_m).forces_n));
        CHECK((limited.forces_n != full.forces_n));
        CHECK(limited.skipped.octaves == uint64_t(limited.contacts));
    }
    const Run fine = texture("rock", 0.01e-3); // less than half of the last octave's wavelength
    CHECK((fine.forces_n == full.forces_n));
    CHECK(fine.skipped.octaves == 0);
    CHECK(texture("by_normal", 2e-3).skipped.octaves == 0); // it has no octaves
}
