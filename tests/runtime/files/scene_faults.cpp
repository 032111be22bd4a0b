// What is said about scenes that are wrong.
#include "tests/runtime/files/scene_folder.h"

#include <string>
#include <string_view>

using namespace haptel;
using namespace haptel::runtime;
using namespace haptel::tests;
using namespace std::string_view_literals;

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
        {"[[object]]\nshape = \"plane\"\nstifness = 3\n",
         "scene.toml:3:1: error: unknown key `stifness` in [[object]]: did you mean `stiffness_n_per_m`?\n"},
        {"[servo]\nrate = 3\nqqqqqqqq = 1\n[[object]]\nshape = \"plane\"\n",
         "scene.toml:2:1: error: unknown key `rate` in [servo]: did you mean `rate_hz`?\n"
         "scene.toml:3:1: error: unknown key `qqqqqqqq` in [servo]: it may hold rate_hz, lateral_depth_m, "
         "force_limit_n, v_max_m_per_s, force_rise_s, wait_for_small_force_n, "
         "force_model, shading\n"},
        {"[[objects]]\nshape = \"plane\"\n",
         "scene.toml:1:1: error: a scene needs something to touch: add an `[[object]]` with a `mesh` or a `shape`\n"
         "scene.toml:1:3: error: unknown key `objects`: did you mean `object`?\n"},
        {"[object]\nshape = \"plane\"\n",
         "scene.toml:1:1: error: expected `[[object]]` in double brackets: a scene may hold several objects\n"},
        {"probe = 3\n[[object]]\nshape = \"plane\"\n",
         "scene.toml:1:9: error: expected a table: write `[probe]` on a line of its own, its keys below\n"},
        {"[probe]\nkind = \"ball\"\nradius_m = 0.01\n[[object]]\nshape = \"plane\"\n",
         "scene.toml:2:8: error: expected \"point\", \"sphere\", \"stylus\" or \"gripper\" for `kind`, found \"ball\"\n"
         "scene.toml:3:12: error: `radius_m` is for `kind = \"sphere\"` alone: write that, or leave `radius_m` out\n"},
        {"[probe]\nkind = \"sphere\"\n[[object]]\nshape = \"plane\"\n",
         "scene.toml:2:8: error: a sphere needs a radius: write `radius_m = 0.005`, or `kind = \"point\"`\n"},
        {"[probe]\nkind = \"sphere\"\nradius_m = 0.2\n[[object]]\nshape = \"plane\"\n",
         "scene.toml:5:9: error: the probe's `radius_m` is larger than `plane`: at most the largest side of its box\n"},
        {"[probe]\nlength_m = \"2cm\"\n[[object]]\nshape = \"plane\"\n",
         "scene.toml:2:12: error: `length_m` is for `kind = \"stylus\"` or `\"gripper\"`: write one of them, or leave "
         "`length_m` out\n"},
        {"[[device]]\nprobe = { kind = \"sphere\", radius_m = 0.01, length_m = 0.1, grip_m = 0.2 }\n[[object]]\n"
         "shape = \"plane\"\n",
         "scene.toml:2:56: error: `length_m` is for `kind = \"stylus\"` or `\"gripper\"`: write one of them, or leave "
         "`length_m` out\n"
         "scene.toml:2:70: error: `grip_m` is for `kind = \"stylus\"` alone: leave it out\n"},
        {"[probe]\nkind = \"gripper\"\nlength_m = 0.1\nradius_m = 0.01\ngrip_m = 0.05\n[[object]]\nshape = \"plane\"\n",
         "scene.toml:4:12: error: `radius_m` is for `kind = \"sphere\"` alone: write that, or leave `radius_m` out\n"
         "scene.toml:5:10: error: `grip_m` is for `kind = \"stylus\"` alone: leave it out\n"},
        {"[probe]\nkind = \"stylus\"\nlength_m = \"+-5mm\"\n[[object]]\nshape = \"plane\"\n",
         "scene.toml:3:12: error: expected a length in metres, such as 0.15 or \"15cm\" for `length_m`, found "
         "\"+-5mm\" "
         "(units that fit: m, cm, mm, um, nm)\n"},
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
        {"[[object]]\nshape = \"plane\"\nstiffness_n_per_m = 9223372036854775807\ntexture = \"\"\n",
         "scene.toml:3:21: error: `stiffness_n_per_m` must be above 0 up to 1000000, found 9223372036854775807\n"
         "scene.toml:4:11: error: `texture` is empty: name something, or leave the key out\n"},
        {"[[object]]\nshape = \"plane\"\nswing_m = [0, 0, 0.01]\n",
         "scene.toml:3:11: error: an object swings by `swing_m = [x, y, z]` at `swing_hz`: write both\n"},
        {"[servo]\nrate_hz = 500\n[[object]]\nshape = \"plane\"\nswing_m = [0, 0, 0.01]\nswing_hz = 250\n",
         "scene.toml:6:12: error: `swing_hz` must be below half of the servo's `rate_hz`, so below 250: at that rate "
         "faster swings are felt as slower ones. Lower it, or raise `rate_hz`\n"},
        {"[servo]\nrate_hz = 100\n[[object]]\nshape = \"plane\"\nspin_deg_per_s = [0, 0, 18000]\n",
         "scene.toml:5:18: error: `spin_deg_per_s` must be below half a turn in a tick at the servo's `rate_hz`, so "
         "below 18000 about all axes together: at that rate faster turns are felt as slower ones. Lower it, or raise "
         "`rate_hz`\n"},
        {"[servo]\nrate_hz = 100\n[[object]]\nshape = \"plane\"\nspin_deg_per_s = [0, -10800, 14400]\n",
         "scene.toml:5:18: error: `spin_deg_per_s` must be below half a turn in a tick at the servo's `rate_hz`, so "
         "below 18000 about all axes together: at that rate faster turns are felt as slower ones. Lower it, or raise "
         "`rate_hz`\n"},
        {"[servo]\nrate_hz = 100\n[[object]]\nshape = \"box\"\nspin_deg_per_s = [0, 0, -17999]\n", ""},
        {"[[object]]\nshape = \"box\"\nspin_deg_per_s = [0, 0, \"15Hz\"]\n",
         "scene.toml:3:25: error: expected a rate of turning in degrees per second, such as 90 or \"15rpm\" for "
         "`spin_deg_per_s`, found \"15Hz\" (units that fit: deg/s, rad/s, rpm)\n"},
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
         "scene.toml:4:20: error: expected a number, true, false, text or, for a vector, a list of numbers for "
         "parameter "
         "`a`, found a list\n"},
        {"[[object]]\nshape = \"plane\"\ntexture = \"a.haptel:b\"\nparameters = { a = [1, [2]] }\n",
         "scene.toml:4:20: error: expected a number, true, false, text or, for a vector, a list of numbers for "
         "parameter "
         "`a`, found a list\n"},
        {"[[object]]\nshape = \"plane\"\ntexture = \"rock.haptel\"\n",
         "scene.toml:3:11: error: expected a file, a colon and the name of a texture in it, such as "
         "\"rock.haptel:rock\", or a file of an installed library, such as \"wood.oak\", found \"rock.haptel\"\n"},
        {"[[object]]\nmesh = \"bunny.obj\"\n", nullptr},
        {"[[object]]\nmesh = \"empty.obj\"\n", "scene.toml:2:8: error: mesh `empty.obj`: the file is empty\n"},
        {"[[object]]\nmesh = \"points.obj\"\n", "scene.toml:2:8: error: mesh `points.obj`: the file holds no triangle: "
                                                "points or lines only, or it is cut off before "
                                                "its faces\n"},
        {"[[object]]\nmesh = \"nan.obj\"\n",
         "scene.toml:2:8: error: mesh `nan.obj`: the mesh has no triangle to touch: "
         "dropped triangles: 1 with a coordinate that is not finite (of 1)\n"},
        {"[[object]]\nmesh = \"beyond.obj\"\n",
         "scene.toml:2:8: error: mesh `beyond.obj`: the file could not be read: OBJ: vertex index out of range; is it "
         "damaged or cut off? Export it again, or as OBJ or STL\n"},
        {"[[object]]\nmesh = \"beyond.ply\"\n",
         "scene.toml:2:8: warning: mesh `beyond.ply`: dropped triangles: 1 with a vertex index that does not exist (of "
         "2)\n"
         "scene.toml:2:8: note: mesh `beyond.ply`: open mesh: 3 border edges, past which a hand gets behind the "
         "surface\n"},
        {"[[object]]\nmesh = \"beyond.off\"\n",
         "scene.toml:2:8: error: mesh `beyond.off`: the file could not be read: OFF: Vertex index is out of range; is "
         "it damaged or cut off? Export it again, or as OBJ or STL\n"},
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

TEST_CASE("usual slips of TOML are told with what to write")
{
    const struct {
        const char *toml, *at, *mend;
    } slips[] = {
        {"[[object]]\nshape = box\n", "2:9",
         "Text needs straight quotes, such as `shape = \"box\"`; three numbers are a list, [0, 0, 0]"},
        {"[[object]]\nshape = \"box\n", "2:13", "Is the closing quote missing?"},
        {"[[object]\nshape = \"box\"\n", "1:10",
         "A header is `[servo]`, or `[[object]]` with two brackets at both ends"},
        {"[[object]] shape = \"box\"\n", "1:12", "Keys stand below their header, each on a line of its own"},
        {"[[object]]\nshape: \"box\"\n", "2:6", "Write `key = value`, the key without spaces"},
        {"[[object]]\nsize_m = 0,15\n", "2:11",
         "Numbers have a point, such as 0.15; three of them are a list, [0, 0, 0]"},
        {"[[object]]\nsize_m = 15cm\n", "2:12", "A number with a unit is text, such as `size_m = \"15cm\"`"},
        {"[[object]]\nsize_m = 1.5cm\n", "2:13",
         "A number with a unit is text, such as `size_m = \"15cm\"`; a point has digits before and behind it, such as "
         "0.5 "
         "and 5.0"},
        {"[[object]]\nsize_m = .5\n", "2:10",
         "A number with a unit is text, such as `size_m = \"15cm\"`; a point has digits before and behind it, such as "
         "0.5 "
         "and 5.0"},
        {"[[object]]\nsize_m =\n", "2:9", "Write a value behind the `=`, or leave the key out"},
        {"[[object]]\njoined = True\n", "2:10",
         "Write `true` or `false`, in small letters; text needs quotes, such as `shape = \"box\"`"},
        {"[[object]]\nposition_m = [0, 0 0]\n", "2:20", "Three numbers are a list, [0, 0, 0]"},
        {"[[object]]\nmagnet = { force_n = 1\nreach_m = 2 }\n", "2:23",
         "A table in braces stands on one line, with a comma between its keys"},
        {"[[object]]\nmagnet = { force_n = 1, }\n", "2:25", "Leave the last comma out"},
        {"[[object]]\nmesh = \"C:\\users\\a.obj\"\n", "2:13",
         "In double quotes a backslash is written twice; paths may be written with `/`"},
        {"[[object]]\nmesh = \"meshes\\a.obj\"\n", "2:16",
         "In double quotes a backslash is written twice; paths may be written with `/`"},
        {"// a scene\n", "1:1", "A comment begins with `#`"},
        {"{ \"object\": 1 }\n", "1:1",
         "A scene is a TOML file: `[[object]]` on a line of its own, `shape = \"box\"` on the next"},
        {"[[object]]\nshape = \"box\";\n", "2:14", "A line ends without `;`"},
        {"[servo]\nrate_hz = 1000\nrate_hz = 500\n", "3:11", "It is there twice: leave one of them out"},
        {"[object]\n[[object]]\n", "2:1", "Write it in double brackets each time"},
        {"# \xe9\n", "1:2", "Save the file as UTF-8 text"},
    };
    for (const auto& slip : slips) {
        CAPTURE(slip.toml);
        const std::string said = diagnostics_of(slip.toml);
        CHECK(said.starts_with("scene.toml:" + std::string(slip.at) + ": error: "));
        CHECK(said.ends_with(". " + std::string(slip.mend) + "\n"));
        CHECK(said.find("Error while") == std::string::npos);
    }
    CHECK(
        load_scene("rock.haptel:rock", resolve_flat, open_scripted).diagnostics ==
        "rock.haptel:rock:1:1: error: this is a texture, and a scene is needed: a TOML file with an `[[object]]` that "
        "has this `texture`\n");
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
          }) == "scene.toml:2:8: error: device `falcon`: not plugged in\n");
    CHECK(diagnostics_of(toml, [](const TextureRequest&) -> TextureResult { throw std::runtime_error("oops"); }) ==
          "scene.toml:1:1: error: the scene could not be loaded: oops\n");
}
