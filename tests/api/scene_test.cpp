// What a program is told of the scene that it builds, in which words.
#include "tests/api/scenes.h"
#include "tests/support/catch.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <thread>
#include <vector>

using namespace haptel;
using namespace haptel::test;

namespace {

std::string refused(const Material& material, const SceneSettings& settings = {})
{
    const Scene scene = table(material, settings);
    CHECK(!scene);
    return scene.messages();
}

} // namespace

TEST_CASE("scene: what is out of its range is refused with its name, its range and the object")
{
    CHECK(contains(refused({.stiffness_n_per_m = -1}), "object 1: error: `stiffness_n_per_m` must be"));
    CHECK(contains(refused({.static_friction = 0.1, .dynamic_friction = 0.2}), "object 1: error: "));
    CHECK(contains(refused({}, {.rate_hz = 1}), "scene: error: `rate_hz` must be from 10 to 100000"));
    CHECK(contains(refused({}, {.rate_hz = std::nan("")}), "scene: error: `rate_hz`"));
    CHECK(contains(refused({}, {.probe = {.kind = ProbeKind::sphere}}), "scene: error: "));
    CHECK(contains(refused({}, {.force_limit_n = 1e9}), "`force_limit_n` must be"));
}

TEST_CASE("scene: a mesh of nothing, of NaN or of wrong indices is refused or repaired, never felt wrongly")
{
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    const std::vector<Mesh> meshes = {
        {},
        box({0, 1, 1}),
        icosphere(-1),
        {.positions_m = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, .triangles = {{0, 1, 7}}},
        {.positions_m = {{nan, 0, 0}, {1, 0, 0}, {0, 1, 0}}, .triangles = {{0, 1, 2}}},
    };
    for (const Mesh& mesh : meshes) {
        SceneBuilder build;
        build.add(plane(0.1));
        build.add(mesh);
        const Scene scene = build.finish();
        CHECK(!scene);
        CHECK(contains(scene.messages(), "object 2: error: mesh `mesh 2`: "));
    }
    Mesh short_of_uv = plane(0.1);
    short_of_uv.uv.pop_back();
    SceneBuilder build;
    build.add(short_of_uv);
    CHECK(contains(build.finish().messages(), "object 1: error: `uv` must be one per position, 4, or empty, found 3"));
    SceneBuilder of_file;
    of_file.add_file("some.obj", -1);
    CHECK(contains(of_file.finish().messages(), "object 1: error: `size_m` must be from 0 to 1000, found -1"));
}

TEST_CASE("scene: a texture without a source, a missing file and a place that is none are told")
{
    SceneBuilder build;
    build.add(plane(0.1)).texture("rock.haptel:rock");
    CHECK(contains(build.finish().messages(), "this program brings no textures"));
    SceneBuilder of_files;
    of_files.add_file("nowhere.obj");
    CHECK(contains(of_files.finish().messages(), "object 1: error: mesh `nowhere.obj`"));
    SceneBuilder far;
    far.add(plane(0.1)).place({.position_m = {1e9, 0, 0}});
    CHECK(contains(far.finish().messages(), "object 1: error: `position_m`"));
    CHECK(contains(load_scene("nowhere.toml").messages(), "nowhere.toml:1:1: error: "));
}

TEST_CASE("scene: one from a file is felt as one that is built alike")
{
    const std::filesystem::path file = std::filesystem::temp_directory_path() / "haptel_api_scene.toml";
    std::ofstream(file)
        << "[servo]\nforce_rise_s = 0\n[[object]]\nshape = \"plane\"\nsize_m = 0.2\n"
           "stiffness_n_per_m = 500\ndamping_n_s_per_m = 0\nstatic_friction = 0\ndynamic_friction = 0\n";
    const Scene loaded = load_scene(file.string());
    REQUIRE(loaded);
    Renderer one{loaded}, other{table()};
    for (int tick = 0; tick < 100; ++tick) {
        const Pose pose{.tip_m = {1e-3 * tick, 0, 1e-3 - 4e-5 * tick}};
        CHECK(one.tick(pose).force_n.z == other.tick(pose).force_n.z);
    }
    std::filesystem::remove(file);
}

TEST_CASE("scene: objects that meet are one, unless one is to be apart")
{
    const auto contacts_at_seam = [](bool apart) {
        SceneBuilder build;
        build.add(box({0.1, 0.1, 0.1}), frictionless).place({.position_m = {-0.05, 0, -0.05}});
        Object other = build.add(box({0.1, 0.1, 0.1}), frictionless);
        other.place({.position_m = {0.05, 0, -0.05}});
        if (apart) other.apart();
        Renderer renderer{build.finish({.force_rise_s = 0})};
        double most_n = 0;
        for (int tick = 0; tick < 400; ++tick) // across the seam, 1 mm deep
            most_n = std::fmax(most_n,
                               renderer.tick({.tip_m = {1e-4 * (tick - 200), 0, tick < 10 ? 1e-3 : -1e-3}}).force_n.z);
        return most_n;
    };
    CHECK(std::fabs(contacts_at_seam(false) - 0.5) < 1e-6); // K d throughout
}
