// Scenes from files: what they mean.
#include "runtime/files/quantity.h"
#include "runtime/texture/shading.h"
#include "tests/runtime/files/scene_folder.h"
#include "tests/support/project_path.h"

#include <cmath>
#include <fstream>
#include <iterator>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>

using namespace haptel;
using namespace haptel::runtime;
using namespace haptel::tests;

TEST_CASE("quantities are numbers in SI or text with a unit, to the last bit")
{
    CHECK(parse_quantity("0.15m", Quantity::length) == 0.15);
    CHECK(parse_quantity(" 60 um ", Quantity::length) == 60e-6);
    CHECK(parse_quantity("60um", Quantity::length) == 60e-6);
    CHECK(parse_quantity("15cm", Quantity::length) == 0.15);
    CHECK(parse_quantity("+0.7mm", Quantity::length) == 0.7e-3);
    CHECK(parse_quantity("-3", Quantity::length) == -3);
    CHECK(parse_quantity("1kHz", Quantity::frequency) == 1000);
    CHECK(parse_quantity("0.8 N/mm", Quantity::stiffness) == 800);
    CHECK(parse_quantity("100mm/s", Quantity::speed) == 0.1);
    CHECK(std::abs(*parse_quantity("3.141592653589793rad", Quantity::angle_deg) - 180) < 1e-12);
    CHECK(parse_quantity("90 deg/s", Quantity::turning_deg_per_s) == 90);
    CHECK(parse_quantity("15rpm", Quantity::turning_deg_per_s) == 90);
    CHECK(std::abs(*parse_quantity("3.141592653589793rad/s", Quantity::turning_deg_per_s) - 180) < 1e-12);
    for (const char* wrong :
         {"", "m", "1 m m", "1kg", "1Hz", "1,5m", "0x10", "1e", "1 M", "--1", "+-5mm", "-+5mm", "++5mm", "+"})
        CHECK_FALSE(parse_quantity(wrong, Quantity::length).has_value());
    CHECK_FALSE(parse_quantity("1m", Quantity::number).has_value());
}

TEST_CASE("a whole scene is read")
{
    const Folder folder;
    std::optional<DeviceRequest> device;
    std::optional<TextureRequest> texture;
    const LoadedScene loaded = load(
        folder, R"(
[probe]
kind = "stylus"
length_m = "12cm"
radius_m = 0.0
[servo]
rate_hz = "2kHz"
force_model = "paper"
shading = "paper"
force_limit_n = 5
v_max_m_per_s = 0.5
[device]
name = "replay:runs/trace.csv"
stroke = "scan"
speed_m_per_s = "50mm/s"
press_n = 2
seed = 7
[[object]]
mesh = "triangle.obj"
size_m = 0.04
position_m = [1, "20cm", 3]
rotation_deg = [90, 0, 90]
stiffness_n_per_m = 900
damping_n_s_per_m = 2.5
static_friction = 0.5
dynamic_friction = 0.25
texture = "sub/rock.haptel:rock"
parameters = { depth = "60um", octaves = 5, sharp = true, gain = 0.5, size = ["21cm", 0.07], edge = "round" }
[[object]]
shape = "icosphere"
)",
        [&](const TextureRequest& request) {
            texture = request;
            return TextureResult{flat_texture(1e-3), "rock.haptel:1:1: warning: harmless"};
        },
        [&](const DeviceRequest& request) {
            device = request;
            return open_scripted(request);
        });
    CHECK(loaded.diagnostics == (folder.path / "scene.toml").string() +
                                    ":19:8: note: mesh `triangle.obj`: open mesh: 3 border edges, past which a hand "
                                    "gets behind the surface\nrock.haptel:1:1: warning: harmless\n");

    const Scene& scene = *loaded.scene;
    CHECK(scene.probe.kind == ProbeKind::stylus);
    CHECK(scene.probe.length_m == 0.12);
    CHECK(scene.servo.rate_hz == 2000);
    CHECK(scene.servo.force.model == ForceModel::paper);
    CHECK(scene.servo.force_limit_n == 5);
    CHECK(scene.servo.v_max_m_per_s == 0.5);
    REQUIRE(scene.objects.size() == 2);

    const SceneObject& triangle = scene.objects[0];
    CHECK(triangle.name == "triangle.obj");
    CHECK(triangle.material.stiffness_n_per_m == 900);
    CHECK(triangle.material.damping_n_s_per_m == 2.5);
    CHECK(triangle.material.static_friction == 0.5);
    CHECK(triangle.material.dynamic_friction == 0.25);
    CHECK(triangle.texture->newest_serial() == 1);
    CHECK(glm::length(triangle.surface->box_maximum_m - glm::dvec3(0.04, 0.03, 0)) < 1e-9);
    // about x by 90 degrees: y to z; then about z by 90 degrees: x to y
    CHECK(glm::length(triangle.placement.to_world({0.04, 0, 0}) - glm::dvec3(1, 0.24, 3)) < 1e-12);
    CHECK(glm::length(triangle.placement.to_world({0, 0.03, 0}) - glm::dvec3(1, 0.2, 3.03)) < 1e-12);
    CHECK(glm::length(triangle.placement.to_object({1, 0.24, 3}) - glm::dvec3(0.04, 0, 0)) < 1e-12);
    CHECK(scene.objects[1].name == "icosphere");
    CHECK(std::abs(scene.objects[1].surface->box_maximum_m.z - 0.05) < 1e-3);
    CHECK(scene.objects[1].material.stiffness_n_per_m == 800);
    CHECK_FALSE(scene.objects[1].request.has_value());

    REQUIRE(texture);
    CHECK(texture->reference == (folder.path / "sub/rock.haptel").string() + ":rock");
    CHECK(texture->parameters == std::vector<std::pair<std::string, std::string>>{{"depth", "60um"},
                                                                                  {"edge", "round"},
                                                                                  {"gain", "0.5"},
                                                                                  {"octaves", "5"},
                                                                                  {"sharp", "true"},
                                                                                  {"size", "21cm, 0.07"}});
    CHECK(std::abs(texture->box_maximum_m[0] - 0.04) < 1e-9);
    CHECK(texture->footprint_m == 2 * 0.5 / 2000);
    CHECK(triangle.request->reference == texture->reference);

    REQUIRE(device);
    CHECK(device->name == "replay:" + (folder.path / "runs/trace.csv").string());
    CHECK(device->stroke == "scan");
    CHECK(device->speed_m_per_s == 0.05);
    CHECK(device->press_n == 2);
    CHECK(device->seed == 7);
    CHECK(device->rate_hz == 2000);
    CHECK(device->stylus_length_m == 0.12);
    CHECK(glm::length(device->box_minimum_m - glm::dvec3(1, 0.2, 3)) < 1e-9);
    CHECK(glm::length(device->box_maximum_m - glm::dvec3(1, 0.24, 3.03)) < 1e-9);
}

TEST_CASE("of an object that moves no detail is kept that passes the hand within a tick")
{
    const auto footprint_m = [](const std::string& motion) {
        const Folder folder;
        double found = 0;
        load(folder,
             "[servo]\nv_max_m_per_s = 0.5\n[[object]]\nshape = \"box\"\nsize_m = 0.1\ntexture = \"a:b\"\n" + motion,
             [&](const TextureRequest& request) {
                 found = request.footprint_m;
                 return TextureResult{flat_texture(0), ""};
             });
        return found;
    };
    CHECK(footprint_m("") == 2 * 0.5 / 1000);
    const double corner_m = 0.05 * std::sqrt(3), turn = 2 * 3.14159265358979323846;
    CHECK(std::abs(footprint_m("spin_deg_per_s = [0, 720, 0]") - 2e-3 * (0.5 + 2 * turn * corner_m)) < 1e-12);
    CHECK(std::abs(footprint_m("swing_m = [0.03, 0, 0.04]\nswing_hz = 3") - 2e-3 * (0.5 + 3 * turn * 0.05)) < 1e-12);
}

TEST_CASE("a texture that reads coordinates on a mesh without any is told, and so is one with a few")
{
    const auto said = [](const char* mesh, uint32_t reads) {
        const Folder folder;
        folder.write("mesh.obj", mesh);
        const std::string text =
            load(folder, "[[object]]\nmesh = \"mesh.obj\"\ntexture = \"a:b\"\n", [&](const TextureRequest&) {
                return TextureResult{lambda_texture([](const haptel_point&, glm::dvec3&) { return 0.0; }, 0, 0, reads),
                                     ""};
            }).diagnostics;
        const std::size_t begin = text.find("texture `");
        return begin == std::string::npos ? "" : text.substr(begin, text.find(": there", begin) - begin);
    };
    const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\n", drawn = corners + "vt 0 0\nvt 1 0\nvt 0 1\n";
    const std::string none = corners + "f 1 2 3\nf 2 4 3\n", all = drawn + "f 1/1 2/2 3/3\nf 2/2 4/1 3/3\n",
                      some = drawn + "f 1/1 2/2 3/3\nf 2 4 3\n";
    CHECK(said(none.c_str(), HAPTEL_READS_UV) == "texture `a:b` reads `uv`, but `mesh.obj` has no coordinates");
    CHECK(said(some.c_str(), HAPTEL_READS_UV) ==
          "texture `a:b` reads `uv`, but `mesh.obj` has no coordinates on some of its faces");
    CHECK(said(all.c_str(), HAPTEL_READS_UV).empty());
    CHECK(said(none.c_str(), HAPTEL_READS_POINT).empty());
}

TEST_CASE("a texture that is deeper than half the width of its object is told")
{
    const auto said = [](const std::string& object, double minimum_m, double maximum_m) {
        return diagnostics_of("[[object]]\ntexture = \"a:b\"\n" + object + "\n", [=](const TextureRequest&) {
            return TextureResult{lambda_texture([](const haptel_point&, glm::dvec3&) { return 0.0; }, minimum_m,
                                                maximum_m, HAPTEL_READS_POINT),
                                 ""};
        });
    };
    CHECK(
        said("shape = \"box\"\nsize_m = 0.05", -1.0 / 3, 2) ==
        "scene.toml:2:11: warning: texture `a:b` has heights from -0.333 to 2 m, 2.33 m deep, but `box` is only 0.05 m "
        "wide: a hand may sink in that far. Is a unit wrong (`depth = \"60um\"` of its `parameters`, `size_m` of the "
        "object)? If not, bound the height with clamp()\n");
    // A plane has no thickness, and is as wide as it is long.
    for (const std::string shape : {"box", "plane", "icosphere"}) {
        CAPTURE(shape);
        CHECK(said("shape = \"" + shape + "\"\nsize_m = 0.05", -0.009, 0.012).empty());
        CHECK_FALSE(said("shape = \"" + shape + "\"\nsize_m = 0.05", -0.014, 0.012).empty());
    }
    // A triangle of 4 cm by 3 cm; and nothing is deep about a height that is the same everywhere.
    CHECK(said("mesh = \"triangle.obj\"\nsize_m = 0.04", 0, 0.0149).find("deep") == std::string::npos);
    CHECK(said("mesh = \"triangle.obj\"\nsize_m = 0.04", 0, 0.0151).find("is only 0.03 m wide") != std::string::npos);
    CHECK(said("shape = \"box\"", 2, 2).empty());
    CHECK(diagnostics_of("[[object]]\nshape = \"box\"\ntexture = \"a:b\"\n", [](const TextureRequest&) {
              return TextureResult{TextureBinding{}, ""};
          }).empty());
}

TEST_CASE("objects turn and swing as the scene says, and equal ones share their surface")
{
    const Folder folder;
    const LoadedScene loaded = load(folder, R"(
[[object]]
shape = "box"
position_m = [0.1, 0, 0]
spin_deg_per_s = [0, 0, "15rpm"]
[[object]]
shape = "box"
swing_m = [0, 0, "5mm"]
swing_hz = 0.25
[[object]]
shape = "box"
size_m = 0.2
)");
    REQUIRE(loaded.scene);
    const auto& objects = loaded.scene->objects;
    const Placement turned = *objects[0].motion->at(1);
    CHECK(glm::length(turned.to_world({0.05, 0, 0}) - glm::dvec3(0.1, 0.05, 0)) < 1e-15);
    CHECK(glm::length(objects[1].motion->at(1)->position_m - glm::dvec3(0, 0, 0.005)) < 1e-15);
    CHECK(objects[2].motion == nullptr);
    CHECK(objects[0].surface == objects[1].surface);
    CHECK(objects[0].surface != objects[2].surface);
}

TEST_CASE("an object that swings out of reach, or not at all, is told")
{
    const auto said = [](const std::string& swing, const std::string& above = "") {
        return diagnostics_of(above + "[[object]]\nshape = \"box\"\nswing_m = " + swing + "\nswing_hz = 1\n");
    };
    CHECK(said("[0, 0, 1]") ==
          "scene.toml:3:11: warning: `box` swings by 1 m to either side, but is only 0.1 m large: a hand hardly meets "
          "it again. Is a unit wrong (`swing_m = [0, 0, \"1mm\"]`, `size_m` of the object)?\n");
    CHECK(said("[0, 0.3, 0.4]").empty());
    CHECK(said("[0, 0.3, 0.41]").starts_with("scene.toml:3:11: warning: `box` swings by 0.508035 m"));
    CHECK(said("[0, 0, 1]", "[workspace]\nscale = 2\n").empty());
    CHECK(said("[0, 0, 1]\nsize_m = 0.25").empty()); // large enough to be met often

    CHECK(said("[0, 0, 0]") == "scene.toml:3:11: warning: `swing_m` is 0, so that this object does not swing: write "
                               "more than 0, or leave `swing_m` and `swing_hz` out\n");
    CHECK(said("[0, 0, \"1kg\"]").find("warning") == std::string::npos); // it was told already
}

TEST_CASE("the scene of the documentation is one, and has every key")
{
    const Folder folder;
    folder.write("bunny.obj", triangle_obj);
    std::ifstream page(test::project_path("docs/scenes.md"));
    const std::string text{std::istreambuf_iterator<char>(page), {}};
    const std::size_t begin = text.find("```toml\n") + 8, end = text.find("```", begin);
    REQUIRE(end != std::string::npos);
    const std::string scene = text.substr(begin, end - begin);
    const Scene loaded = *load(folder, scene).scene;
    CHECK(loaded.objects.size() == 1);
    CHECK(loaded.servo.force.model == ForceModel::lateral);

    // What a wrong key in each table is told of, is there.
    for (const char* table : {"[probe]", "[servo]", "[workspace]", "[device]", "[[object]]\nshape = \"plane\"",
                              "[[region]]\nshape = \"box\"\nsides_m = [1, 1, 1]"}) {
        folder.write("wrong.toml", std::string(table) + "\nqqqqqqqqqqqqq = 1\n");
        const std::string said = load_scene(folder.path / "wrong.toml", resolve_flat, open_scripted).diagnostics;
        const std::string before = "it may hold ";
        const std::size_t at = said.find(before);
        REQUIRE(at != std::string::npos);
        std::istringstream keys(said.substr(at + before.size(), said.find('\n', at) - at - before.size()));
        for (std::string key; keys >> key;) {
            if (key.back() == ',') key.pop_back();
            if (key == "radius_m" || key == "shape") continue;
            CAPTURE(table, key);
            CHECK(scene.find("\n" + key + " = ") != std::string::npos);
        }
    }
}

TEST_CASE("a scene of one line has the defaults of the documentation")
{
    const Folder folder;
    std::optional<DeviceRequest> device;
    const LoadedScene loaded =
        load(folder, "[[object]]\nshape = \"plane\"\n", resolve_flat, [&](const DeviceRequest& r) {
            device = r;
            return open_scripted(r);
        });
    CHECK(loaded.diagnostics.empty());
    const Scene& scene = *loaded.scene;
    CHECK(scene.probe.kind == ProbeKind::point);
    CHECK(scene.servo.rate_hz == 1000);
    CHECK(scene.servo.force.model == ForceModel::displaced);
    CHECK(scene.servo.force_limit_n == 7);
    CHECK(scene.servo.v_max_m_per_s == 0.3);
    const Material& material = scene.objects[0].material;
    CHECK(material.stiffness_n_per_m == 800);
    CHECK(material.damping_n_s_per_m == 1);
    CHECK(material.static_friction == 0.3);
    CHECK(material.dynamic_friction == 0.2);
    REQUIRE(device);
    CHECK(device->name == "simulated:premium");
    CHECK(device->stroke == "circles");
    CHECK(device->speed_m_per_s == 0.1);
    CHECK(device->press_n == 1);
    CHECK(device->stylus_length_m == 0);
}

TEST_CASE("a scene is loaded for another rate than it says, and the device hears of it")
{
    const Folder folder;
    double device_hz = 0;
    const auto open = [&](const DeviceRequest& request) {
        device_hz = request.rate_hz;
        return open_scripted(request);
    };
    // A vibration that is too fast at the file's rate is none at that one.
    const auto file = folder.write("scene.toml", "[servo]\nrate_hz = 500\n[[object]]\nshape = \"plane\"\nvibration = "
                                                 "{ force_n = 1, frequency_hz = 300 }\n");
    CHECK(!load_scene(file, resolve_flat, open).scene);
    const LoadedScene loaded = load_scene(file, resolve_flat, open, nullptr, {}, {.rate_hz = 48'000});
    CHECK(loaded.diagnostics.empty());
    REQUIRE(loaded.scene);
    CHECK(loaded.scene->servo.rate_hz == 48'000);
    CHECK(device_hz == 48'000);
    CHECK(!load_scene(folder.write("bad.toml", "[servo]\nrate_hz = 1\n[[object]]\nshape = \"plane\"\n"), resolve_flat,
                      open, nullptr, {}, {.rate_hz = 48'000})
               .scene); // the file is still wrong
}

TEST_CASE("force models, creases and the turning of normals reach the scene")
{
    CHECK(diagnostics_of("[servo]\nlateral_depth_m = 0.1\n[[object]]\nshape = \"plane\"\n") ==
          "scene.toml:2:19: error: `lateral_depth_m` is for `force_model = \"lateral\"` alone: write that, or leave it "
          "out\n");
    const Folder folder;
    for (const ForceModel model :
         {ForceModel::displaced, ForceModel::paper, ForceModel::paper_unit, ForceModel::ho99, ForceModel::lateral}) {
        const std::string named =
            "[servo]\nforce_model = \"" + std::string(force_model_names[static_cast<std::size_t>(model)]) + "\"\n";
        const Scene scene = *load(folder, named + "[[object]]\nshape = \"plane\"\n").scene;
        CHECK(scene.servo.force.model == model);
        CHECK(scene.servo.force.lateral_depth_m == 1e-3);
    }
    CHECK(load(folder, "[servo]\nforce_model = \"lateral\"\nlateral_depth_m = \"2mm\"\n[[object]]\nshape = \"plane\"\n")
              .scene->servo.force.lateral_depth_m == 2e-3);

    struct Turning {
        const char* object;
        double per_m;
    };
    for (const auto& [object, per_m] :
         {Turning{"shape = \"icosphere\"\nsize_m = 0.04", 50},
          Turning{"shape = \"icosphere\"\nsize_m = 0.04\ncrease_deg = 0", 0}, Turning{"shape = \"box\"", 0}}) {
        std::optional<TextureRequest> asked;
        const Scene scene = *load(folder, "[[object]]\n" + std::string(object) + "\ntexture = \"a.haptel:b\"\n",
                                  [&](const TextureRequest& request) {
                                      asked = request;
                                      return resolve_flat(request);
                                  })
                                 .scene;
        REQUIRE(asked);
        CHECK(asked->normal_turn_max_per_m == scene.objects[0].surface->normal_turn_max_per_m);
        CHECK(std::abs(asked->normal_turn_max_per_m - per_m) <= 0.06 * per_m);
        // A box's faces have 0 .. 1 over 0.1 m, an icosphere has no coordinates.
        const bool is_box = std::string_view(object).find("box") != std::string_view::npos;
        CHECK(std::abs(asked->uv.slope_max_per_m[0] - (is_box ? 10 : 0)) < 1e-6);
        CHECK(std::abs(asked->uv.maximum[1] - (is_box ? 1 : 0)) < 1e-9);
    }
    CHECK(load(folder, "[[object]]\nshape = \"box\"\ncrease_deg = 100\n")
              .scene->objects[0]
              .surface->normal_turn_max_per_m > 1);
}

TEST_CASE("friction of which only one half is written stays possible")
{
    const Folder folder;
    const auto material = [&](const std::string& line) {
        return load(folder, "[[object]]\nshape = \"plane\"\n" + line + "\n").scene->objects[0].material;
    };
    CHECK(material("static_friction = 0.1").dynamic_friction == 0.1);
    CHECK(material("dynamic_friction = 0.6").static_friction == 0.6);
    CHECK(material("static_friction = 0").dynamic_friction == 0);
}
