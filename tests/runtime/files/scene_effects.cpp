// Effects and regions in scene files.
#include "tests/runtime/files/scene_folder.h"

#include <string>

using namespace haptel;
using namespace haptel::runtime;
using namespace haptel::tests;

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
         "3:48: error: the `reach_m` of an effect is larger than `plane`: at most the largest side of its box; what is "
         "felt farther away is a `[[region]]`\n"},
        {object + "magnet = { force_n = 1, reach_m = 0.1 }\nvibration = { reach_m = 0.2, force_n = 1 }\n",
         "4:25: error: the `reach_m` of an effect is larger than `plane`: at most the largest side of its box; what is "
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

TEST_CASE("an effect that is written and does nothing is told where it is, unless something else is wrong with it")
{
    const std::string object = "[[object]]\nshape = \"plane\"\n", region = object + "[[region]]\nshape = \"space\"\n";
    const auto idle = [](const char* at, const std::string& strength, const std::string& effect) {
        return "scene.toml:" + std::string(at) + ": warning: `" + strength + "` is 0, so that this " + effect +
               " is not felt: write more than 0, or leave the " + effect + " out\n";
    };
    const std::string nothing =
        "scene.toml:3:1: warning: nothing is felt in this region: give it a medium, such as `damping_n_s_per_m = 3`, "
        "or a `vibration = { force_n = 0.1 }`, or leave it out\n";
    const struct {
        std::string toml, said;
    } cases[] = {
        {object + "magnet = { force_n = 0, reach_m = 0.01 }\n", idle("3:22", "force_n", "magnet")},
        {object + "viscosity = { damping_n_s_per_m = 0.0, reach_m = 0.01 }\n",
         idle("3:35", "damping_n_s_per_m", "viscosity")},
        {object + "vibration = { force_n = \"0N\", reach_m = 0.01 }\n", idle("3:25", "force_n", "vibration")},
        {object + "vibration = { force_n = -1 }\n",
         "scene.toml:3:25: error: `force_n` must be from 0 to 100, found -1\n"},
        {object + "vibration = { force_n = 0, frequency_hz = 700 }\n",
         "scene.toml:3:43: error: `frequency_hz` must be below half of the servo's `rate_hz`, so below 500: at that "
         "rate faster swings are felt as slower ones. Lower it, or raise `rate_hz`\n"},
        {region, nothing},
        {region + "damping_n_s_per_m = 0\n", nothing},
        {region + "vibration = { force_n = 0 }\n", idle("5:25", "force_n", "vibration")},
        {region + "damping_n_s_per_m = -1\n",
         "scene.toml:5:21: error: `damping_n_s_per_m` must be from 0 to 1000, found -1\n"},
        {region + "damping_n_s_per_m = 1\n", ""},
        {region + "vibration = { force_n = 0.1 }\n", ""},
    };
    for (const auto& one : cases) {
        CAPTURE(one.toml);
        CHECK(diagnostics_of(one.toml) == one.said);
    }
}
