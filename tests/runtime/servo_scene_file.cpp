// Scenes from files: what they mean, and what is said about those that are wrong.
#include "runtime/files/quantity.h"
#include "runtime/files/scene_file.h"
#include "runtime/shading.h"
#include "tests/support/catch.h"
#include "tests/support/lambda_texture.h"
#include "tests/support/touch_scenes.h"

#include <atomic>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>

#include <unistd.h>

using namespace haptel;
using namespace haptel::runtime;
using namespace haptel::tests;
using namespace std::string_view_literals;

namespace {

// A folder of its own, gone afterwards.
class Folder {
public:
    Folder() : path_(std::filesystem::temp_directory_path() / ("haptel_scene_test_" + std::to_string(::getpid())))
    {
        std::filesystem::remove_all(path_);
        std::filesystem::create_directories(path_);
    }
    ~Folder() { std::filesystem::remove_all(path_); }

    std::filesystem::path write(const std::string& name, std::string_view text) const
    {
        std::ofstream(path_ / name, std::ios::binary) << text;
        return path_ / name;
    }
    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

// One right-angled triangle with legs of 3 and 4 units.
constexpr std::string_view triangle_obj = "v 0 0 0\nv 4 0 0\nv 0 3 0\nf 1 2 3\n";

TextureResult resolve_flat(const TextureRequest&)
{
    return {flat_texture(0), ""};
}

DeviceResult open_scripted(const DeviceRequest&)
{
    return {std::make_unique<ScriptedDevice>([](uint64_t, DevicePose&) { return DeviceStatus::ok; }), ""};
}

// What is said about a scene, with the folder's name taken out.
std::string diagnostics_of(std::string_view toml, const TextureResolver& textures = resolve_flat,
                           const DeviceFactory& devices = open_scripted)
{
    const Folder folder;
    folder.write("triangle.obj", triangle_obj);
    folder.write("empty.obj", "");
    folder.write("garbage.obj", "\0\1\2\xff\xfe garbage \n\n f f f"sv);
    folder.write("points.obj", "v 0 0 0\nv 1 0 0\n");
    folder.write("nan.obj", "v 0 0 0\nv nan 0 0\nv 0 inf 0\nf 1 2 3\n");
    folder.write("beyond.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\nf 1 2 3\n");
    folder.write(
        "beyond.ply",
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face "
        "2\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n4 0 0\n0 3 0\n3 0 1 2\n3 0 1 7\n");
    folder.write("beyond.off", "OFF\n3 2 0\n0 0 0\n4 0 0\n0 3 0\n3 0 1 2\n3 0 1 9\n");
    folder.write("note.txt", "hello");
    const LoadedScene loaded = load_scene(folder.write("scene.toml", toml), textures, devices);
    std::string text = loaded.diagnostics;
    const std::string name = folder.path().string() + "/";
    for (std::size_t at; (at = text.find(name)) != std::string::npos;) text.erase(at, name.size());
    CHECK((loaded.scene == nullptr) == (text.find(": error: ") != std::string::npos));
    CHECK(loaded.hands.empty() == (loaded.scene == nullptr));
    return text;
}

LoadedScene load(const Folder& folder, std::string_view toml, const TextureResolver& textures = resolve_flat,
                 const DeviceFactory& devices = open_scripted)
{
    folder.write("triangle.obj", triangle_obj);
    LoadedScene loaded = load_scene(folder.write("scene.toml", toml), textures, devices);
    INFO(loaded.diagnostics);
    REQUIRE(loaded.scene);
    return loaded;
}

} // namespace

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
    for (const char* wrong : {"", "m", "1 m m", "1kg", "1Hz", "1,5m", "0x10", "1e", "1 M", "--1"})
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
parameters = { depth = "60um", octaves = 5, sharp = true, gain = 0.5 }
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
    CHECK(loaded.diagnostics == (folder.path() / "scene.toml").string() +
                                    ":18:8: note: mesh `triangle.obj`: open mesh: 3 border edges, past which a hand "
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
    CHECK(texture->reference == (folder.path() / "sub/rock.haptel").string() + ":rock");
    CHECK(texture->parameters == std::vector<std::pair<std::string, std::string>>{
                                     {"depth", "60um"}, {"gain", "0.5"}, {"octaves", "5"}, {"sharp", "true"}});
    CHECK(std::abs(texture->box_maximum_m[0] - 0.04) < 1e-9);
    CHECK(texture->footprint_m == 2 * 0.5 / 2000);
    CHECK(triangle.request->reference == texture->reference);

    REQUIRE(device);
    CHECK(device->name == "replay:" + (folder.path() / "runs/trace.csv").string());
    CHECK(device->stroke == "scan");
    CHECK(device->speed_m_per_s == 0.05);
    CHECK(device->press_n == 2);
    CHECK(device->seed == 7);
    CHECK(device->rate_hz == 2000);
    CHECK(device->stylus_length_m == 0.12);
    CHECK(glm::length(device->box_minimum_m - glm::dvec3(1, 0.2, 3)) < 1e-9);
    CHECK(glm::length(device->box_maximum_m - glm::dvec3(1, 0.24, 3.03)) < 1e-9);
}

TEST_CASE("objects turn and swing as the scene says, and equal ones share their surface")
{
    const Folder folder;
    const LoadedScene loaded = load(folder, R"(
[[object]]
shape = "box"
position_m = [0.1, 0, 0]
spin_deg_per_s = [0, 0, 90]
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

TEST_CASE("the scene of the documentation is one, and has every key")
{
    const Folder folder;
    folder.write("bunny.obj", triangle_obj);
    std::ifstream page(HAPTEL_SOURCE_DIR "/docs/scenes.md");
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
        const std::string said = load_scene(folder.path() / "wrong.toml", resolve_flat, open_scripted).diagnostics;
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

TEST_CASE("force models, creases and the turning of normals reach the scene")
{
    CHECK(diagnostics_of("[servo]\nlateral_depth_m = 0.1\n[[object]]\nshape = \"plane\"\n") ==
          "scene.toml:2:19: error: `lateral_depth_m` is for `force_model = \"lateral\"` alone\n");
    const Folder folder;
    for (const ForceModel model :
         {ForceModel::displaced, ForceModel::paper, ForceModel::paper_unit, ForceModel::ho99, ForceModel::lateral}) {
        const std::string named = "[servo]\nforce_model = \"" + std::string(name_of(model)) + "\"\n";
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

TEST_CASE("the surface below a point is the first hit from above, wherever the object is put")
{
    const Folder folder;
    std::optional<DeviceRequest> device;
    load(folder,
         "[[object]]\nshape = \"icosphere\"\nsize_m = 0.2\nposition_m = [0.5, 0, 1]\nrotation_deg = [30, 40, 50]\n",
         resolve_flat, [&](const DeviceRequest& request) {
             device = request;
             return open_scripted(request);
         });
    REQUIRE(device);
    const auto hit = device->surface_below(0.53, 0.04);
    REQUIRE(hit);
    const double expected_z = 1 + std::sqrt(0.1 * 0.1 - 0.03 * 0.03 - 0.04 * 0.04);
    CHECK(std::abs(hit->point_m.x - 0.53) < 1e-9);
    CHECK(std::abs(hit->point_m.y - 0.04) < 1e-9);
    CHECK(std::abs(hit->point_m.z - expected_z) < 2e-4); // facets
    CHECK(glm::dot(hit->facet_normal, glm::dvec3(0.3, 0.4, std::sqrt(0.75))) > 0.998);
    CHECK_FALSE(device->surface_below(0.61, 0.0).has_value());
}

TEST_CASE("what is wrong with a scene is said where it is, all at once")
{
    struct Case {
        const char* toml;
        const char* said;
    };
    const Case cases[] = {
        {"",
         "scene.toml:1:1: error: a scene needs something to touch: add an `[[object]]` with a `mesh` or a `shape`\n"},
        {"[[object]\nshape = 1", nullptr},
        {"[[object]]\nshape = \"plane\"\nstifness_n_per_m = 3\n",
         "scene.toml:3:1: error: unknown key `stifness_n_per_m` in [[object]]: did you mean `stiffness_n_per_m`?\n"},
        {"[[object]]\nshape = \"plane\"\nstiffness = 3\n",
         "scene.toml:3:1: error: unknown key `stiffness` in [[object]]: did you mean `stiffness_n_per_m`?\n"},
        {"[servo]\nrate = 3\nqqqqqqqq = 1\n[[object]]\nshape = \"plane\"\n",
         "scene.toml:2:1: error: unknown key `rate` in [servo]: did you mean `rate_hz`?\n"
         "scene.toml:3:1: error: unknown key `qqqqqqqq` in [servo]: it may hold rate_hz, force_model, lateral_depth_m, "
         "force_limit_n, v_max_m_per_s, force_rise_s, wait_for_small_force_n\n"},
        {"[[objects]]\nshape = \"plane\"\n",
         "scene.toml:1:1: error: a scene needs something to touch: add an `[[object]]` with a `mesh` or a `shape`\n"
         "scene.toml:1:3: error: unknown key `objects`: did you mean `object`?\n"},
        {"[object]\nshape = \"plane\"\n",
         "scene.toml:1:1: error: expected `[[object]]` in double brackets: a scene may hold several objects\n"},
        {"probe = 3\n[[object]]\nshape = \"plane\"\n",
         "scene.toml:1:9: error: expected a table: write `[probe]` on a line of its own, its keys below\n"},
        {"[probe]\nkind = \"ball\"\nradius_m = 0.01\n[[object]]\nshape = \"plane\"\n",
         "scene.toml:2:8: error: expected \"point\", \"sphere\" or \"stylus\" for `kind`, found \"ball\"\n"
         "scene.toml:3:12: error: `radius_m` is for `kind = \"sphere\"` alone: write 0\n"},
        {"[probe]\nkind = \"sphere\"\n[[object]]\nshape = \"plane\"\n",
         "scene.toml:2:8: error: a sphere needs a radius: write `radius_m = 0.005`, or `kind = \"point\"`\n"},
        {"[probe]\nkind = \"sphere\"\nradius_m = 0.2\n[[object]]\nshape = \"plane\"\n",
         "scene.toml:5:9: error: the probe's `radius_m` is larger than `plane`: at most the largest side of its box\n"},
        {"[servo]\nforce_model = \"ho89\"\nrate_hz = 0\nforce_limit_n = -1\n[[object]]\nshape = \"plane\"\n",
         "scene.toml:2:15: error: expected \"displaced\", \"paper\", \"paper_unit\", \"ho99\" or \"lateral\" for "
         "`force_model`, found \"ho89\"\n"
         "scene.toml:3:11: error: `rate_hz` must be from 10 to 100000, found 0\n"
         "scene.toml:4:17: error: `force_limit_n` must be above 0 up to 100, found -1\n"},
        {"[[object]]\nshape = \"plane\"\nsize_m = \"15kg\"\n",
         "scene.toml:3:10: error: expected a length in metres, such as 0.15 or \"15cm\" for `size_m`, found \"15kg\" "
         "(units that fit: m, cm, mm, um, nm)\n"},
        {"[[object]]\nshape = \"plane\"\nsize_m = nan\nstiffness_n_per_m = inf\n",
         "scene.toml:3:10: error: `size_m` must be above 0 up to 1000, found nan\n"
         "scene.toml:4:21: error: `stiffness_n_per_m` must be above 0 up to 1000000, found inf\n"},
        {"[[object]]\nshape = \"plane\"\nswing_m = [0, 0, 0.01]\n",
         "scene.toml:3:11: error: an object swings by `swing_m = [x, y, z]` at `swing_hz`: write both\n"},
        {"[[object]]\nshape = \"plane\"\nposition_m = [0, 1]\nrotation_deg = 3\n",
         "scene.toml:3:14: error: expected three numbers, such as [0, 0, 0], for `position_m`, found a list of 2\n"
         "scene.toml:4:16: error: expected three numbers, such as [0, 0, 0], for `rotation_deg`, found 3\n"},
        {"[[object]]\nshape = \"cube\"\n", "scene.toml:2:9: error: expected \"plane\", \"box\", \"sphere\", "
                                           "\"icosphere\" or \"torus\" for `shape`, found "
                                           "\"cube\"\n"},
        {"[[object]]\nsize_m = 1\n",
         "scene.toml:1:1: error: an object needs a `mesh = \"FILE\"` or a `shape`: \"plane\", \"box\", \"sphere\", "
         "\"icosphere\" or \"torus\"\n"},
        {"[[object]]\nshape = \"plane\"\nmesh = \"triangle.obj\"\n",
         "scene.toml:1:1: error: an object has either a `mesh` or a `shape`, not both\n"},
        {"[[object]]\nshape = \"plane\"\nstatic_friction = 0.1\ndynamic_friction = 0.5\n",
         "scene.toml:4:20: error: `dynamic_friction` must not exceed `static_friction`: a surface that slides harder "
         "than it sticks chatters\n"},
        {"[[object]]\nshape = \"plane\"\nparameters = { a = 1 }\n",
         "scene.toml:3:14: error: `parameters` belong to a `texture`, but this object has none\n"},
        {"[[object]]\nshape = \"plane\"\ntexture = \"a.haptel:b\"\nparameters = { a = [1] }\n",
         "scene.toml:4:20: error: expected a number, true, false or text for parameter `a`, found a list\n"},
        {"[[object]]\nshape = \"plane\"\ntexture = \"rock.haptel\"\n",
         "scene.toml:3:11: error: expected a file, a colon and the name of a texture in it, such as "
         "\"rock.haptel:rock\", found \"rock.haptel\"\n"},
        {"[[object]]\nmesh = \"bunny.obj\"\n", nullptr},
        {"[[object]]\nmesh = \"empty.obj\"\n", "scene.toml:2:8: error: mesh `empty.obj`: the file is empty\n"},
        {"[[object]]\nmesh = \"points.obj\"\n",
         "scene.toml:2:8: error: mesh `points.obj`: the file holds no triangle\n"},
        {"[[object]]\nmesh = \"nan.obj\"\n",
         "scene.toml:2:8: error: mesh `nan.obj`: the mesh has no triangle to touch: "
         "dropped triangles: 1 with a coordinate that is not finite (of 1)\n"},
        {"[[object]]\nmesh = \"beyond.obj\"\n",
         "scene.toml:2:8: error: mesh `beyond.obj`: the file could not be read: OBJ: vertex index out of range\n"},
        {"[[object]]\nmesh = \"beyond.ply\"\n",
         "scene.toml:2:8: warning: mesh `beyond.ply`: dropped triangles: 1 with a vertex index that does not exist (of "
         "2)\n"
         "scene.toml:2:8: note: mesh `beyond.ply`: open mesh: 3 border edges, past which a hand gets behind the "
         "surface\n"},
        {"[[object]]\nmesh = \"beyond.off\"\n",
         "scene.toml:2:8: error: mesh `beyond.off`: the file could not be read: OFF: Vertex index is out of range\n"},
        {"[[object]]\nmesh = \"garbage.obj\"\n", nullptr},
        {"[[object]]\nmesh = \"note.txt\"\n",
         "scene.toml:2:8: error: mesh `note.txt`: expected a mesh of type .obj, .ply, .stl, .off, .3ds, .dae, .gltf or "
         ".glb, found .txt\n"},
        {"[device]\nseed = -1\nstroke = \"zigzag\"\npress_n = true\n[[object]]\nshape = \"plane\"\n",
         "scene.toml:2:8: error: expected a whole number from 0 on for `seed`, found -1\n"
         "scene.toml:3:10: error: expected \"circles\", \"scan\", \"press\" or \"random\" for `stroke`, found "
         "\"zigzag\"\n"
         "scene.toml:4:11: error: expected a force in newtons, such as 7 or \"500mN\" for `press_n`, found true\n"},
    };
    for (const Case& bad : cases) {
        CAPTURE(bad.toml);
        const std::string said = diagnostics_of(bad.toml);
        if (bad.said)
            CHECK(said == bad.said);
        else
            CHECK(said.find("scene.toml:") == 0);
    }
}

TEST_CASE("every device of a scene has its probe and its workspace, and is told of the scene as its hand sees it")
{
    const Folder folder;
    std::vector<DeviceRequest> requests;
    std::optional<TextureRequest> texture;
    const LoadedScene loaded = load(
        folder, R"(
[probe]
kind = "stylus"
length_m = 0.3
[workspace]
scale = 2
position_m = [0.1, 0, 0]
[[device]]
seed = 4
[[device]]
stroke = "press"
workspace = { scale = 4, rotation_deg = [0, 0, 90] }
[device.probe]
kind = "sphere"
radius_m = 0.02
[[object]]
shape = "box"
size_m = 0.4
position_m = [0.3, 0, 0]
texture = "a.haptel:a"
)",
        [&](const TextureRequest& request) {
            texture = request;
            return resolve_flat(request);
        },
        [&](const DeviceRequest& request) {
            requests.push_back(request);
            return open_scripted(request);
        });
    REQUIRE(loaded.hands.size() == 2);
    const HandSettings &first = loaded.hands[0].settings, &second = loaded.hands[1].settings;
    CHECK_FALSE(first.probe);
    CHECK(first.workspace.scale == 2);
    CHECK(second.probe->kind == ProbeKind::sphere);
    CHECK(second.probe->radius_m == 0.02);
    CHECK(second.workspace.scale == 4);
    CHECK(second.workspace.placement.position_m == glm::dvec3(0));
    CHECK(texture->footprint_m == 2 * 4 * 0.3 / 1000); // of the hand that goes fastest

    REQUIRE(requests.size() == 2);
    CHECK(requests[0].seed == 4);
    CHECK(requests[1].stroke == "press");
    CHECK(requests[0].stylus_length_m == 0.15);
    CHECK(requests[1].stylus_length_m == 0);
    CHECK(glm::distance(requests[0].box_minimum_m, glm::dvec3(0, -0.1, -0.1)) < 1e-9);
    CHECK(glm::distance(requests[0].box_maximum_m, glm::dvec3(0.2, 0.1, 0.1)) < 1e-9);
    // x of the scene is -y of the second hand
    CHECK(glm::distance(requests[1].box_minimum_m, glm::dvec3(-0.05, -0.125, -0.05)) < 1e-9);
    CHECK(glm::distance(requests[1].box_maximum_m, glm::dvec3(0.05, -0.025, 0.05)) < 1e-9);
    CHECK(glm::distance(requests[0].surface_below(0.1, 0.02)->point_m, glm::dvec3(0.1, 0.02, 0.1)) < 1e-9);
    const auto hit = requests[1].surface_below(0.01, -0.1);
    CHECK(glm::distance(hit->point_m, glm::dvec3(0.01, -0.1, 0.055)) < 1e-9); // its ball lies there
    CHECK(glm::distance(hit->facet_normal, glm::dvec3(0, 0, 1)) < 1e-9);
    CHECK_FALSE(requests[1].surface_below(0.01, 0));

    const std::string object = "[[object]]\nshape = \"plane\"\n";
    CHECK(diagnostics_of("[workspace]\nscale = 0\nscal = 1\n" + object) ==
          "scene.toml:2:9: error: `scale` must be from 0.001 to 1000, found 0\n"
          "scene.toml:3:1: error: unknown key `scal` in [workspace]: did you mean `scale`?\n");
    CHECK(diagnostics_of("[[device]]\n[[device]]\nworkspace = 3\nprobe = { kin = \"point\" }\n" + object) ==
          "scene.toml:3:13: error: expected a table, such as `workspace = { scale = 2 }`, found 3\n"
          "scene.toml:4:11: error: unknown key `kin` in `probe`: did you mean `kind`?\n");
    CHECK(diagnostics_of("device = [1]\n" + object) ==
          "scene.toml:1:10: error: expected a table: write `[device]` on a line of its own, its keys below\n");
    int opened = 0;
    CHECK(diagnostics_of("[[device]]\n[[device]]\nname = \"other\"\n" + object, resolve_flat,
                         [&](const DeviceRequest& request) {
                             if (++opened == 2) return DeviceResult{nullptr, "is not there"};
                             return open_scripted(request);
                         }) == "scene.toml:2:1: error: device `other`: is not there\n");
}

TEST_CASE("a scene that is loaded again has the surfaces that did not change, and those alone")
{
    const Folder folder;
    folder.write("triangle.obj", triangle_obj);
    const auto file = folder.write("scene.toml", "[[object]]\nmesh = \"triangle.obj\"\nsize_m = 0.1\n"
                                                 "[[object]]\nshape = \"box\"\n[[object]]\nshape = \"box\"\n");
    SurfaceCache surfaces;
    const auto load_again = [&] { return load_scene(file, resolve_flat, open_scripted, &surfaces); };
    LoadedScene first = load_again();
    CHECK(first.meshes == std::vector<std::filesystem::path>{folder.path() / "triangle.obj"});
    const LoadedScene second = load_again();
    REQUIRE(second.scene);
    CHECK(second.scene != first.scene);
    for (std::size_t i = 0; i < 3; ++i) CHECK(second.scene->objects[i].surface == first.scene->objects[i].surface);

    folder.write("triangle.obj", std::string(triangle_obj) + "v 4 3 0\nf 2 3 4\n");
    const LoadedScene third = load_again();
    CHECK(third.scene->objects[0].surface != first.scene->objects[0].surface);
    CHECK(third.scene->objects[0].surface->faces.size() == 2);
    CHECK(third.scene->objects[1].surface == first.scene->objects[1].surface);
    folder.write("scene.toml", "[[object]]\nmesh = \"triangle.obj\"\nsize_m = 0.2\n[[object]]\nshape = \"box\"\n"
                               "crease_deg = 40\n"); // the default, but written: smoothing groups do not count
    const LoadedScene fourth = load_again();
    CHECK(fourth.scene->objects[0].surface != third.scene->objects[0].surface);
    CHECK(fourth.scene->objects[1].surface != third.scene->objects[1].surface);

    // It holds nothing: what nobody else holds is gone.
    const std::weak_ptr<const Surface> gone = first.scene->objects[0].surface;
    first = {};
    CHECK_FALSE(gone.expired()); // `second` has it
    folder.write("triangle.obj", "nothing");
    CHECK_FALSE(load_again().scene);
    CHECK(load_again().meshes.size() == 1);
}

TEST_CASE("effects are read, and what is wrong with them is said")
{
    const Folder folder;
    const Scene scene = *load(folder, R"(
[servo]
rate_hz = 2000
wait_for_small_force_n = 0.4
[[object]]
shape = "box"
magnet = { force_n = 1.5, reach_m = "6mm" }
viscosity = { damping_n_s_per_m = 2, reach_m = 0.02 }
vibration = { force_n = "200mN", frequency_hz = 999, direction = [0, 3, 4], reach_m = "1mm" }
[[object]]
shape = "plane"
[[region]]
shape = "ball"
radius_m = 0.04
position_m = [1, 2, 3]
damping_n_s_per_m = 4
[[region]]
shape = "box"
sides_m = [0.1, 0.2, 0.3]
rotation_deg = [0, 0, 90]
edge_m = "1cm"
vibration = { force_n = 0.1 }
[[region]]
shape = "space"
damping_n_s_per_m = 0.5
)")
                             .scene;
    CHECK(scene.servo.wait_for_small_force_n == 0.4);
    const ObjectEffects& box = scene.objects[0].effects;
    CHECK(box.magnet.force_n == 1.5);
    CHECK(box.magnet.reach_m == 6e-3);
    CHECK(box.damping_n_s_per_m == 2);
    CHECK(box.damping_reach_m == 0.02);
    CHECK(box.vibration.force_n == 0.2);
    CHECK(box.vibration.frequency_hz == 999);
    CHECK(glm::distance(box.vibration.direction, glm::dvec3(0, 0.6, 0.8)) < 1e-15);
    CHECK(box.vibration_reach_m == 1e-3);
    CHECK_FALSE(scene.objects[1].effects.act());
    REQUIRE(scene.regions.size() == 3);
    CHECK(scene.regions[0].shape == RegionShape::ball);
    CHECK(scene.regions[0].half_sides_m == glm::dvec3(0.04));
    CHECK(scene.regions[0].edge_m == 0.01);
    CHECK(scene.regions[0].placement.position_m == glm::dvec3(1, 2, 3));
    CHECK(scene.regions[0].damping_n_s_per_m == 4);
    CHECK(scene.regions[1].shape == RegionShape::box);
    CHECK(glm::distance(scene.regions[1].half_sides_m, glm::dvec3(0.05, 0.1, 0.15)) < 1e-15);
    CHECK(scene.regions[1].edge_m == 0.01);
    CHECK(glm::distance(scene.regions[1].placement.to_world({1, 0, 0}), glm::dvec3(0, 1, 0)) < 1e-15);
    CHECK(scene.regions[1].vibration.acts());
    CHECK(scene.regions[1].vibration.frequency_hz == 100);
    CHECK(scene.regions[2].shape == RegionShape::space);

    const std::string object = "[[object]]\nshape = \"plane\"\n", region = object + "[[region]]\n";
    const struct {
        std::string toml, said;
    } cases[] = {
        {object + "magnet = 3\n",
         "3:10: error: expected a table, such as `magnet = { force_n = 1, reach_m = \"5mm\" }`, found 3\n"},
        {object + "magnet = { force_n = 1 }\n",
         "3:10: error: a magnet needs the distance from which on it pulls: write `reach_m = \"5mm\"`\n"},
        {object + "magnet = { force = 1, reach_m = \"11cm\" }\n",
         "3:10: error: a magnet needs its largest pull: write `force_n = 1`\n"
         "scene.toml:3:12: error: unknown key `force` in `magnet`: did you mean `force_n`?\n"},
        {object + "viscosity = { damping_n_s_per_m = 2000, reach_m = 0.1 }\n",
         "3:35: error: `damping_n_s_per_m` must be from 0 to 1000, found 2000\n"},
        {object + "viscosity = { damping_n_s_per_m = 2, reach_m = \"11cm\" }\n",
         "2:9: error: the `reach_m` of an effect is larger than `plane`: at most the largest side of its box; what is "
         "felt farther away is a `[[region]]`\n"},
        {object + "vibration = { force_n = 1, frequency_hz = 500 }\n",
         "3:43: error: `frequency_hz` must be below half of the servo's `rate_hz`, so below 500: at that rate faster "
         "swings are felt as slower ones. Lower it, or raise `rate_hz`\n"},
        {object + "vibration = { force_n = 1, direction = [0, 0, 0] }\n",
         "3:40: error: a vibration needs a direction: write `direction = [0, 0, 1]`\n"},
        {object + "vibrations = { force_n = 1 }\n",
         "3:1: error: unknown key `vibrations` in [[object]]: did you mean `vibration`?\n"},
        {object + "[region]\nshape = \"space\"\n",
         "3:1: error: expected `[[region]]` in double brackets: a scene may hold several regions\n"},
        {region + "damping_n_s_per_m = 1\n",
         "3:1: error: a region needs a `shape`: \"space\" (everywhere), \"ball\" or \"box\"\n"},
        {region + "shape = \"ball\"\nsides_m = [1, 1, 1]\n",
         "4:9: error: a ball needs a radius: write `radius_m = 0.02`\n"
         "scene.toml:5:11: error: `sides_m` is for `shape = \"box\"` alone\n"},
        {region + "shape = \"box\"\nradius_m = 1\n",
         "4:9: error: a box needs its sides: write `sides_m = [0.04, 0.04, 0.02]`\n"
         "scene.toml:5:12: error: `radius_m` is for `shape = \"ball\"` alone\n"},
        {region + "shape = \"space\"\nedge_m = 1\n",
         "5:10: error: `edge_m` is for a `shape` with a border, \"ball\" or \"box\"\n"},
        {region + "shape = \"box\"\nsides_m = [1, 0.25, 1]\nedge_m = \"13cm\"\n",
         "6:10: error: `edge_m` must be at most 0.125, half of the region's smallest side: beyond that its effects are "
         "nowhere felt in full\n"},
        {region + "shape = \"space\"\ndamping = 1\n",
         "5:1: error: unknown key `damping` in [[region]]: did you mean `damping_n_s_per_m`?\n"},
    };
    for (const auto& bad : cases) {
        CAPTURE(bad.toml);
        CHECK(diagnostics_of(bad.toml) == "scene.toml:" + bad.said);
    }
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

TEST_CASE("a scene that is no text is reported, not crashed on")
{
    CHECK(diagnostics_of("\0\1\2\xff\xfe\xfd"sv).starts_with("scene.toml:1:"));
    CHECK(diagnostics_of(std::string(20000, '[')).starts_with("scene.toml:1:"));
    CHECK(diagnostics_of("a = " + std::string(20000, '[')).starts_with("scene.toml:1:"));
    const LoadedScene missing = load_scene("/nowhere/at/all.toml", resolve_flat, open_scripted);
    CHECK_FALSE(missing.scene);
    CHECK(missing.diagnostics == "/nowhere/at/all.toml:1:1: error: the scene could not be read: is the path right?\n");
    const LoadedScene folder = load_scene(std::filesystem::temp_directory_path(), resolve_flat, open_scripted);
    CHECK_FALSE(folder.scene);
    CHECK(folder.diagnostics.ends_with(":1:1: error: this is a folder: name the scene file in it\n"));
}

TEST_CASE("what textures and devices say reaches the user")
{
    const char* toml = "[device]\nname = \"falcon\"\n[[object]]\nshape = \"plane\"\ntexture = \"a.haptel:b\"\n";
    CHECK(diagnostics_of(toml, [](const TextureRequest&) {
              return TextureResult{std::nullopt, "a.haptel:3:4: error: what?"};
          }) == "scene.toml:5:11: error: texture `a.haptel:b` cannot be used\na.haptel:3:4: error: what?\n");
    CHECK(diagnostics_of(toml,
                         [](const TextureRequest&) {
                             TextureResult result{flat_texture(0), ""};
                             result.binding->facts.height_max_m = INFINITY;
                             return result;
                         })
              .starts_with("scene.toml:5:11: error: texture `a.haptel:b` cannot be used: the range of the texture's "
                           "height is not"));
    CHECK(diagnostics_of(toml, resolve_flat, [](const DeviceRequest&) {
              return DeviceResult{nullptr, "not plugged in"};
          }) == "scene.toml:1:1: error: device `falcon`: not plugged in\n");
    CHECK(diagnostics_of(toml, [](const TextureRequest&) -> TextureResult { throw std::runtime_error("oops"); }) ==
          "scene.toml:1:1: error: the scene could not be loaded: oops\n");
}

TEST_CASE("a mended mesh is a warning, with what was mended")
{
    const Folder folder;
    folder.write("mended.obj", "v 0 0 0\nv 4 0 0\nv 0 3 0\nv 0 0 0\nv nan 0 0\nf 1 2 3\nf 1 2 2\nf 1 2 5\nf 4 2 3\n");
    const LoadedScene loaded =
        load_scene(folder.write("scene.toml", "[[object]]\nmesh = \"mended.obj\"\n"), resolve_flat, open_scripted);
    INFO(loaded.diagnostics);
    REQUIRE(loaded.scene);
    CHECK(loaded.scene->objects[0].surface->faces.size() == 1);
    CHECK(loaded.diagnostics.find("scene.toml:2:8: warning: mesh `mended.obj`: ") != std::string::npos);
}

TEST_CASE("an open mesh is a note with the number of its border edges; a closed one and a shape are not")
{
    const Folder folder;
    const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";
    const std::string three_faces = "f 1 2 4\nf 2 3 4\nf 3 1 4\n", floor = "f 1 3 2\n";
    folder.write("open.obj", corners + three_faces);
    folder.write("closed.obj", corners + three_faces + floor);
    CHECK(load(folder, "[[object]]\nmesh = \"open.obj\"\n").diagnostics.find("open mesh: 3 border edges") !=
          std::string::npos);
    CHECK(load(folder, "[[object]]\nmesh = \"closed.obj\"\n").diagnostics.empty());
    CHECK(load(folder, "[[object]]\nshape = \"plane\"\n").diagnostics.empty());
}

TEST_CASE("smoothing groups of an OBJ file are kept as creases, unless the scene says where creases are")
{
    const Folder folder;
    // Four walls in a row that turn by 20 degrees each: two of one group in two objects and materials, one of another,
    // one of none.
    std::string points = "# walls\n";
    double x = 0, y = 0;
    for (int i = 0; i <= 4; ++i) {
        for (const int z : {0, 1})
            points += "v " + std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(z) + "\n";
        const double angle = i * 3.14159265358979323846 / 9;
        x += std::cos(angle);
        y += std::sin(angle);
    }
    const auto wall = [](int i) {
        const auto point = [](int n) { return " " + std::to_string(n); };
        return "f" + point(2 * i + 1) + point(2 * i + 3) + point(2 * i + 4) + point(2 * i + 2) + "\n";
    };
    const auto edges_kept = [&](const std::string& obj, const std::string& more = {}) {
        folder.write("walls.obj", obj);
        const LoadedScene loaded = load(folder, "[[object]]\nmesh = \"walls.obj\"\n" + more);
        INFO(loaded.diagnostics);
        REQUIRE(loaded.scene);
        const Surface& surface = *loaded.scene->objects[0].surface;
        REQUIRE(surface.faces.size() == 8);
        // Of the three lines where walls meet, from left to right: is the normal there one of the facets?
        std::string kept;
        for (int line = 1; line < 4; ++line) {
            bool crease = true;
            for (uint32_t face = 0; face < 8; ++face)
                for (uint32_t corner = 0; corner < 3; ++corner) {
                    const glm::dvec3 at = surface.vertex_m(face, corner);
                    const double reach = glm::length(glm::dvec2(at));
                    glm::dvec2 expected(0);
                    for (int i = 0; i < line; ++i)
                        expected += glm::dvec2(std::cos(i * 0.349065850), std::sin(i * 0.349065850));
                    if (glm::distance(expected, glm::dvec2(at)) > 1e-4 || reach == 0) continue;
                    glm::dvec3 w(0);
                    w[int(corner)] = 1;
                    crease =
                        crease && glm::distance(shading_normal(surface, face, 0, w), surface.facet_normal(face)) < 1e-9;
                }
            kept += crease ? '|' : '.';
        }
        return kept + loaded.diagnostics;
    };
    const std::string grouped = points + "s 1\r\no one\nusemtl red\n" + wall(0) + "o two\ng x\nusemtl blue\n" +
                                wall(1) + "s 7\n" + wall(2) + "s off\n" + wall(3);
    const std::string open = "scene.toml:2:8: note: mesh `walls.obj`: ";
    CHECK(edges_kept(points + wall(0) + wall(1) + wall(2) + wall(3)).starts_with("..."));
    CHECK(edges_kept(grouped).starts_with(".||"));
    CHECK(edges_kept(grouped, "crease_deg = 40\n").starts_with("..."));
    CHECK(edges_kept(grouped, "crease_deg = 10\n").starts_with("|||"));
    CHECK(edges_kept(points + wall(0) + wall(1) + "s 1\n" + wall(2) + wall(3)).starts_with("||."));
    const std::string flat = edges_kept(points + "s 0\n" + wall(0) + wall(1) + wall(2) + wall(3));
    CHECK(flat.starts_with("|||"));
    CHECK(flat.find("without a smoothing group (`s off`) and felt flat; write `crease_deg = 40`") != std::string::npos);
    CHECK(edges_kept(grouped).find("smoothing group") == std::string::npos);
}

TEST_CASE("a mesh is read from every common format")
{
    const Folder folder;
    folder.write("a.obj", triangle_obj);
    folder.write(
        "b.ply",
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face "
        "1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n4 0 0\n0 3 0\n3 0 1 2\n");
    folder.write("c.stl", "solid t\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 4 0 0\nvertex 0 3 "
                          "0\nendloop\nendfacet\nendsolid "
                          "t\n");
    folder.write("d.off", "OFF\n3 1 0\n0 0 0\n4 0 0\n0 3 0\n3 0 1 2\n");
    for (const char* name : {"a.obj", "b.ply", "c.stl", "d.off"}) {
        CAPTURE(name);
        const LoadedScene loaded =
            load_scene(folder.write("scene.toml", "[[object]]\nmesh = \"" + std::string(name) + "\"\n"), resolve_flat,
                       open_scripted);
        INFO(loaded.diagnostics);
        REQUIRE(loaded.scene);
        REQUIRE(loaded.scene->objects[0].surface->faces.size() == 1);
        CHECK(glm::length(loaded.scene->objects[0].surface->box_maximum_m - glm::dvec3(4, 3, 0)) < 1e-6);
    }
}
