// Devices of scenes, what they are told of their objects, and scenes that are loaded again.
#include "tests/runtime/files/scene_folder.h"

#include <cmath>
#include <memory>
#include <string>
#include <string_view>

using namespace haptel;
using namespace haptel::runtime;
using namespace haptel::tests;

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
    CHECK(first.probe->kind == ProbeKind::stylus); // whatever the scene says when it is edited
    CHECK(first.probe->length_m == 0.3);
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
                         }) == "scene.toml:3:8: error: device `other`: is not there\n");
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

TEST_CASE("a scene that is loaded again has the surfaces that did not change, and those alone")
{
    const Folder folder;
    folder.write("triangle.obj", triangle_obj);
    const auto file = folder.write("scene.toml", "[[object]]\nmesh = \"triangle.obj\"\nsize_m = 0.1\n"
                                                 "[[object]]\nshape = \"box\"\n[[object]]\nshape = \"box\"\n");
    SurfaceCache surfaces;
    const auto load_again = [&] { return load_scene(file, resolve_flat, open_scripted, &surfaces); };
    LoadedScene first = load_again();
    CHECK(first.meshes == std::vector<std::filesystem::path>{folder.path / "triangle.obj"});
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

namespace {

class Rated final : public ScriptedDevice {
public:
    explicit Rated(double press_n, const DeviceAxes& axes = {})
        : ScriptedDevice([](uint64_t, DevicePose&) { return DeviceStatus::ok; }), rated_{"rated", 8, 800, 0, press_n}
    {
        rated_.axes = axes;
    }
    const DeviceInfo& info() const override { return rated_; }

private:
    DeviceInfo rated_;
};

std::string said(const std::string& toml)
{
    return diagnostics_of(toml, resolve_flat, [](const DeviceRequest& request) {
        return DeviceResult{std::make_unique<Rated>(request.press_n), ""};
    });
}

} // namespace

TEST_CASE("what a driver says stands where that is written of which it speaks")
{
    const auto told_at = [](DeviceKey about, const std::string& toml) {
        const std::string said =
            diagnostics_of(toml + "[[object]]\nshape = \"plane\"\n", resolve_flat,
                           [&](const DeviceRequest&) { return DeviceResult{nullptr, "no", {}, about}; });
        return said.substr(0, said.find(": error"));
    };
    const std::string device = "[device]\nspeed_m_per_s = 0.2\nname = \"simulated\"\nstroke = \"scan\"\npress_n = 2\n";
    CHECK(told_at(DeviceKey::device, device) == "scene.toml:1:1");
    CHECK(told_at(DeviceKey::speed, device) == "scene.toml:2:17");
    CHECK(told_at(DeviceKey::name, device) == "scene.toml:3:8");
    CHECK(told_at(DeviceKey::stroke, device) == "scene.toml:4:10");
    CHECK(told_at(DeviceKey::press, device) == "scene.toml:5:11");
    CHECK(told_at(DeviceKey::name, "[device]\nseed = 2\n") == "scene.toml:1:1"); // not written
    // The length is that of the probe, which may be the scene's.
    const std::string scene = "[probe]\nkind = \"stylus\"\nlength_m = 9\n", own = "probe = { kind = \"stylus\" }\n";
    CHECK(told_at(DeviceKey::stylus_length, scene + device) == "scene.toml:3:12");
    CHECK(told_at(DeviceKey::stylus_length, scene + device + own) == "scene.toml:9:9");
    CHECK(told_at(DeviceKey::stylus_length, device + "[device.probe]\nkind = \"stylus\"\nlength_m = 9\n") ==
          "scene.toml:8:12");
}

TEST_CASE("a simulated hand that presses harder than anything pushes back is told both figures")
{
    const std::string object = "[[object]]\nshape = \"plane\"\n";
    CHECK(said("[device]\npress_n = 7\n" + object).empty());
    CHECK(said("[device]\npress_n = \"7.5N\"\n" + object) ==
          "scene.toml:2:11: warning: `press_n` is 7.5 N, but at most 7 N push back, the `force_limit_n`: the hand "
          "sinks in, and the force stays at that limit. Lower `press_n`, or raise `force_limit_n`\n");
    CHECK(said("[servo]\nforce_limit_n = 9\n[device]\npress_n = 8.5\n" + object) ==
          "scene.toml:4:11: warning: `press_n` is 8.5 N, but at most 8 N push back, all that `rated` can hold: the "
          "hand sinks in, and the force stays at that limit. Lower `press_n`\n");
    CHECK(said("[servo]\nforce_limit_n = 0.5\n[device]\n" + object)
              .starts_with("scene.toml:3:1: warning: `press_n` is 1 N, but at most 0.5 N push back")); // the default
    // A device in a hand of flesh is pressed by whoever holds it.
    CHECK(diagnostics_of("[device]\npress_n = 9\n" + object).empty());
}

TEST_CASE("a stiffness of more than twice what a device is made for at that rate is told")
{
    const std::string soft = "[[object]]\nshape = \"plane\"\n",
                      hard = "[[object]]\nshape = \"box\"\nposition_m = [1, 0, 0]\nstiffness_n_per_m = ";
    CHECK(said(soft + hard + "1600\n").empty());
    CHECK(said(soft + hard + "\"2 N/mm\"\n") ==
          "scene.toml:6:21: warning: `box` has a stiffness of 2000 N/m, but `rated` is made for up to 800 N/m at 1000 "
          "Hz: a touch may hum or kick. Lower `stiffness_n_per_m`, or raise `rate_hz`\n");
    CHECK(said("[servo]\nrate_hz = 2000\n" + soft + hard + "3200\n").empty());
    CHECK(
        said("[servo]\nrate_hz = 400\n" + soft).starts_with("scene.toml:3:1: warning: `plane` has a stiffness of 800"));
    // A workspace changes nothing: stiffness is the hand's.
    CHECK(said("[workspace]\nscale = 0.1\n" + soft + hard + "1600\n").empty());
}

TEST_CASE(
    "a device without the axis z feels slopes alone, pressed in by press_n over the stiffness; a gripper needs it")
{
    const auto two_axes = [](const DeviceRequest& request) {
        const DeviceAxes axes{{true, true, false}, {true, true, false}};
        return DeviceResult{std::make_unique<Rated>(request.press_n, axes), ""};
    };
    const std::string object = "[[object]]\nshape = \"plane\"\nstiffness_n_per_m = 500\n";
    const Folder folder;
    const LoadedScene loaded = load(folder, "[device]\npress_n = 2\n" + object, resolve_flat, two_axes);
    REQUIRE(loaded.hands.size() == 1);
    CHECK(loaded.hands[0].settings.slopes_only);
    CHECK(loaded.hands[0].device->info().axes.all());
    DevicePose pose;
    for (int i = 0; i < 500; ++i) REQUIRE(loaded.hands[0].device->read(pose) == DeviceStatus::ok);
    CHECK(std::abs(pose.tip_m.z + 2.0 / 500) < 1e-12);

    const std::string gripper = "[probe]\nkind = \"gripper\"\n" + object;
    CHECK(diagnostics_of(gripper, resolve_flat, two_axes)
              .starts_with("scene.toml:1:1: error: `rated` has too few axes for a gripper"));
}
