// Textures from the compiler and precompiled ones, changed while they are felt.
#include "tests/api/scenes.h"
#include "tests/support/catch.h"

#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <haptel/compiler.h>
#include <mutex>
#include <span>
#include <thread>
#include <vector>

using namespace haptel;
using namespace haptel::test;

namespace {

struct TextureFile {
    explicit TextureFile(const std::string& text) { write(text); }
    ~TextureFile() { std::filesystem::remove(path); }
    void write(const std::string& text) const
    {
        const std::filesystem::path part = path.string() + ".part";
        std::ofstream(part) << text;
        std::filesystem::rename(part, path);
    }
    std::filesystem::path path = std::filesystem::temp_directory_path() / "haptel_api_flat.haptel";
};

// Between crest and groove there are two depths, by which the spring is shorter in the groove.
const std::string waves = "/// Waves.\ntexture waves(float depth = 0mm in 0mm .. 1mm)\n"
                          "{ return depth * sinturn(p.x / 4mm); }\n";
const Pose in_groove{.tip_m = {3e-3, 0, -2e-3}}, in_air{.tip_m = {3e-3, 0, 2e-3}};

struct OwnBlock {
    haptel_block_head head;
    double height_m;
    int32_t kind;
};

void flat(const haptel_point*, const void* block, haptel_sample* sample)
{
    const auto& own = *static_cast<const OwnBlock*>(block);
    *sample = {};
    sample->height_m = own.kind == 1 ? own.height_m : 0;
    sample->stiffness_scale = sample->friction_scale = 1;
}

const char* const kinds[] = {"off", "on"};
const char* const* const choices[] = {nullptr, kinds};
const haptel_parameter parameters[] = {
    {"height", "m", "", HAPTEL_FLOAT, offsetof(OwnBlock, height_m), 0, -1e-3, 0},
    {"kind", "", "", HAPTEL_INT, offsetof(OwnBlock, kind), 0, 0, 1},
};

haptel_texture own_texture()
{
    haptel_texture texture{};
    texture.abi = HAPTEL_ABI_VERSION;
    texture.size = sizeof texture;
    texture.block_size = sizeof(OwnBlock);
    texture.parameter_count = 2;
    texture.name = "flat";
    texture.parameters = parameters;
    texture.facts = {-1e-3, 0, 0, 0, HAPTEL_CONTINUITY_C1, 0};
    texture.height_gradient = flat;
    texture.choices = choices;
    return texture;
}

} // namespace

TEST_CASE("texture: a value that is set is felt from the next tick on, and whole after 50 ms")
{
    const TextureFile file(waves);
    SceneBuilder build{compiler()};
    Object top = build.add(plane(0.2), frictionless);
    top.texture(file.path.string() + ":waves");
    CHECK(top.set("depth", "0.1mm") == "the scene is not built");
    const Scene scene = build.finish({.force_rise_s = 0});
    INFO(scene.messages());
    REQUIRE(scene);
    Renderer renderer{scene};
    renderer.tick(in_air);
    CHECK(std::fabs(renderer.tick(in_groove).force_n.z - 500 * 2e-3) < 1e-9);
    CHECK(top.set("depth", "0.1mm").empty());
    renderer.tick(in_groove);
    CHECK(renderer.tick(in_groove).force_n.z < 500 * 2e-3 - 1e-6); // within two ticks
    double last_n = 0;
    for (int tick = 0; tick < 60; ++tick) last_n = renderer.tick(in_groove).force_n.z;
    CHECK(std::fabs(last_n - 500 * (2e-3 - 2 * 0.1e-3)) < 1e-4);

    CHECK(contains(top.set("dephth", "1mm"), "did you mean 'depth'?"));
    CHECK(contains(top.set("depth", "1kg"), "depth"));
    CHECK(renderer.tick(in_groove).force_n.z == last_n);

    // Values change the program that is felt, whatever became of its file.
    file.write("texture waves(");
    CHECK(top.set("depth", "0.2mm").empty());
    for (int tick = 0; tick < 60; ++tick) last_n = renderer.tick(in_groove).force_n.z;
    CHECK(std::fabs(last_n - 500 * (2e-3 - 2 * 0.2e-3)) < 1e-4);
}

TEST_CASE("texture: files are followed if the compiler is asked to; what is broken is reported, and changes nothing")
{
    TextureFile file("/// Flat.\ntexture waves(float depth = 0mm in 0mm .. 1mm) { return 0.0; }\n");
    std::mutex mutex;
    std::string reported;
    const auto report = [&](std::string_view text) {
        const std::lock_guard lock(mutex);
        reported += text;
    };
    SceneBuilder build{compiler({.follow_files = true, .report = report})};
    Object top = build.add(plane(0.2), frictionless);
    top.texture(file.path.string() + ":waves", {{"depth", "0.5mm"}});
    const Scene scene = build.finish({.force_rise_s = 0});
    REQUIRE(scene);
    Renderer renderer{scene};
    renderer.tick(in_air);
    const auto felt_n = [&] { return renderer.tick(in_groove).force_n.z; };
    const auto within_seconds = [&](const auto& happens) {
        const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
        while (!happens() && std::chrono::steady_clock::now() < end)
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
        return happens();
    };
    const double flat_n = felt_n();
    file.write("texture waves(");
    CHECK(within_seconds([&] {
        const std::lock_guard lock(mutex);
        return contains(reported, "error: ");
    }));
    CHECK(felt_n() == flat_n);
    file.write(waves);
    CHECK(within_seconds([&] { return felt_n() < flat_n; }));
    CHECK(top.set("depth", "0mm").empty());
    CHECK(within_seconds([&] { return std::fabs(felt_n() - flat_n) < 1e-9; }));
}

TEST_CASE("texture: precompiled ones take their values as written, by name, unit and choice")
{
    const haptel_texture texture = own_texture();
    SceneBuilder build{precompiled({&texture})};
    Object top = build.add(plane(0.2), frictionless);
    top.texture("precompiled:flat", {{"height", "-0.5mm"}, {"kind", "on"}});
    const Scene scene = build.finish({.force_rise_s = 0});
    INFO(scene.messages());
    REQUIRE(scene);
    Renderer renderer{scene};
    renderer.tick({.tip_m = {0, 0, 2e-3}});
    CHECK(std::fabs(renderer.tick({.tip_m = {0, 0, -2e-3}}).force_n.z - 500 * 1.5e-3) < 1e-9);
    CHECK(top.set("kind", "off").empty());
    Force last;
    for (int tick = 0; tick < 60; ++tick) last = renderer.tick({.tip_m = {0, 0, -2e-3}});
    CHECK(std::fabs(last.force_n.z - 500 * 2e-3) < 1e-9);
    CHECK(contains(top.set("kind", "maybe"), "kind"));
    CHECK(contains(top.set("hight", "0"), "did you mean 'height'?"));

    SceneBuilder other{precompiled({&texture, nullptr})};
    other.add(plane(0.2)).texture("precompiled:rock");
    CHECK(contains(other.finish().messages(), "no precompiled texture is called 'rock': there are flat"));
    CHECK(contains(top.set("height", "1mm"), "its bounds hold for its range alone"));
    const auto refused = [&](auto&& change) {
        haptel_texture changed = texture;
        std::array<haptel_parameter, 2> own = {parameters[0], parameters[1]};
        changed.parameters = own.data();
        change(changed, own);
        SceneBuilder of_changed{precompiled({&changed})};
        of_changed.add(plane(0.2)).texture("precompiled:flat");
        return of_changed.finish().messages();
    };
    CHECK(contains(refused([](auto& t, auto&) { t.block_size = 8; }), "its block is smaller than haptel_block_head"));
    CHECK(contains(refused([](auto&, auto& p) { p[1].offset = 1 << 20; }), "'kind' does not lie in its block"));
    CHECK(contains(refused([](auto&, auto& p) { p[1].offset += 2; }), "'kind' does not lie in its block"));
    CHECK(contains(refused([](auto&, auto& p) { p[0].name = nullptr; }), "a parameter has no name"));
    CHECK(contains(refused([](auto&, auto& p) { p[0].type = 9; }), "'height' has no type of haptel/abi.h"));
    CHECK(refused([](auto&, auto& p) { p[0].unit = nullptr; }).find("error") == std::string::npos);
    haptel_texture old = texture;
    old.abi = 0;
    SceneBuilder of_old{precompiled({&old})};
    of_old.add(plane(0.2)).texture("precompiled:flat");
    CHECK(contains(of_old.finish().messages(), "another version of haptel/abi.h"));
}

TEST_CASE("texture: one that is only looked at has the heights, gradients and bounds of its formula")
{
    const Texture rings = compile(waves, "", {{"depth", "0.2mm"}});
    INFO(rings.messages());
    REQUIRE(rings);
    std::vector<Vec3> points, gradients(1000);
    std::vector<double> heights(1000);
    for (int i = 0; i < 1000; ++i) points.push_back({1e-5 * i, 1e-3 * i, 0});
    rings.evaluate(points, heights, gradients);
    constexpr double two_pi = 6.283185307179586;
    double worst_m = 0, worst_slope = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const double angle = two_pi * points[i].x / 4e-3;
        worst_m = std::fmax(worst_m, std::fabs(heights[i] - 2e-4 * std::sin(angle)));
        worst_slope = std::fmax(worst_slope, std::fabs(gradients[i].x - 2e-4 * two_pi / 4e-3 * std::cos(angle)));
        CHECK(gradients[i].y == 0);
    }
    CHECK(worst_m < 1e-17);
    CHECK(worst_slope < 1e-14);
    CHECK(rings.facts().height_max_m >= 2e-4);
    CHECK(rings.facts().height_max_m < 2.001e-4);
    CHECK(std::string(rings.table().name) == "waves");

    const Texture broken = compile("texture t() { return dept; }");
    CHECK(!broken);
    CHECK(contains(broken.messages(), "error"));
    CHECK(contains(compile_file("nowhere.haptel").messages(), "nowhere.haptel:1:1: error: "));
    CHECK(contains(compile(waves, "wave").messages(), "did you mean 'waves'?"));
    double untouched = 1;
    broken.evaluate(std::span(points).first(1), std::span(&untouched, 1));
    CHECK(untouched == 1);
}
