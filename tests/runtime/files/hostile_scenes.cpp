// Scenes that nobody means well with: too deep, too large, too many, or no files at all.
#include "input/toml/toml_syntax.h"
#include "runtime/files/mesh_process.h"
#include "tests/runtime/files/scene_folder.h"

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <string>
#include <string_view>
#include <sys/stat.h>
#include <unistd.h>
#include <vector>

using namespace haptel;
using namespace haptel::input;
using namespace haptel::runtime;
using namespace haptel::tests;

namespace {

std::string repeated(std::string_view text, std::size_t times)
{
    std::string all;
    for (std::size_t i = 0; i < times; ++i) all += text;
    return all;
}

std::size_t lines_of(std::string_view text)
{
    return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

const std::string box_object = "[[object]]\nshape = \"box\"\n";

} // namespace

TEST_CASE("keys and brackets that nest without end are refused where they pass the limit, before they are read")
{
    const std::string deep = "nest deeper than 64 levels";
    const std::string_view ends[] = {" = 1\n", ""};
    for (const std::string_view end : ends) {
        // 64 dots are the limit: the 65th stands in column 2 * 65.
        const std::string said = diagnostics_of(box_object + "a" + repeated(".a", 300'000) + std::string(end));
        CHECK(said.starts_with("scene.toml:3:130: error: "));
        CHECK(contains(said, deep));
    }
    CHECK(contains(diagnostics_of("[a" + repeated(".a", 300'000) + "]\n"), deep));
    CHECK(contains(diagnostics_of("a = " + repeated("[", 300'000)), deep));
    CHECK(contains(diagnostics_of("a = " + repeated("{a.a=", 300'000)), deep));
    CHECK(contains(diagnostics_of(repeated(" . ", 300'000)), deep));
    for (const char quote : {'"', '\''}) // quotes before the three that end a text are its own
        for (const size_t closing : {3, 4, 5}) {
            const std::string text = std::string(3, quote) + "x" + std::string(closing, quote);
            CHECK(contains(diagnostics_of("a = [" + text + ", {a" + repeated(".a", 300'000) + " = 1}]\n"), deep));
        }
}

TEST_CASE("what stands in strings and comments is not deep, and neither are many keys beside each other")
{
    const std::string dots(1000, '.'), brackets(1000, '[');
    for (const std::string& harmless :
         {"# " + dots + brackets + "\n", "a = \"" + dots + brackets + "\\\"" + dots + "\"\n", "a = '" + dots + "'\n",
          "a = '''\n'" + dots + "\n" + brackets + "'''\n", "a = \"\"\"" + dots + "\\\"\"\"\"\n",
          "a = [" + repeated("1.5,\n", 1000) + "]\n", repeated("# x.y\n[[object]]\nshape.a.b = 1.5\n", 100)}) {
        CAPTURE(harmless.substr(0, 20));
        CHECK(!too_deep(harmless));
    }
    std::string at_limit = "a" + repeated(".a", levels_max) + " = 1\n";
    CHECK(!too_deep(at_limit));
    CHECK(too_deep("a." + at_limit));
}

TEST_CASE("a scene that is no regular file, or larger than any scene, is refused by what it is")
{
    const Folder folder;
    const auto said = [&](const std::string& file) {
        const LoadedScene loaded = load_scene(file, resolve_flat, open_scripted);
        CHECK(!loaded.scene);
        return loaded.diagnostics.substr(file.size());
    };
    const std::string pipe = folder.file("pipe.toml"), sparse = folder.write("sparse.toml", "");
    REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
    std::filesystem::resize_file(sparse, std::uintmax_t{1} << 42);
    CHECK(said(pipe) == ":1:1: error: the scene is a pipe, not a regular file\n");
    CHECK(said("/dev/zero") == ":1:1: error: the scene is a device, not a regular file\n");
    CHECK(said(sparse) == ":1:1: error: the scene has 4 TiB, and at most 16 MiB are read: is it the right file?\n");
}

TEST_CASE("of thousands of mistakes the first ones are told, shortened, and the others counted")
{
    std::string toml = box_object;
    for (int i = 0; i < 1000; ++i) toml += "key" + std::to_string(i) + " = 1\n";
    const std::string said = diagnostics_of(toml);
    CHECK(lines_of(said) == FileMessages::messages_max + 1);
    CHECK(contains(said, "scene.toml:1:1: note: 800 more errors, warnings and notes are not shown"));
    const std::string one = diagnostics_of(box_object + std::string(1'000'000, 'k') + " = 1\n");
    CHECK(lines_of(one) == 1);
    CHECK(one.size() < FileMessages::message_bytes_max + 100);
}

TEST_CASE("more devices, objects or regions than any scene has are refused, the limit named, and none is opened")
{
    std::size_t opened = 0;
    const auto count = [&](const DeviceRequest& request) {
        ++opened;
        return open_scripted(request);
    };
    CHECK(diagnostics_of(box_object + repeated("[[device]]\nname = \"simulated:premium\"\n", 5000), resolve_flat,
                         count) ==
          "scene.toml:131:1: error: a scene may hold 64 devices, each with a thread of its own, and this one has 5000: "
          "leave some out\n");
    CHECK(opened == 0);
    CHECK_FALSE(contains(
        diagnostics_of(box_object + repeated("[[device]]\nname = \"simulated:premium\"\n", 64), resolve_flat, count),
        "may hold"));
    CHECK(opened == 64);
    CHECK(contains(diagnostics_of(repeated(box_object, 20'001)),
                   "a scene may hold 20000 objects, and this one has 20001"));
    CHECK(contains(diagnostics_of(box_object + repeated("[[region]]\nshape = \"space\"\n", 10'001)),
                   "a scene may hold 10000 regions"));
}

TEST_CASE("loading tells what it does and to which mesh, and ends at whatever it was told to end")
{
    const Folder folder;
    folder.write("triangle.obj", triangle_obj);
    const std::string file =
        folder.write("scene.toml", "[[object]]\nmesh = \"triangle.obj\"\ntexture = \"a:b\"\n" + box_object);
    std::vector<std::string> told;
    // A slow reader is told of now and then.
    const auto is_counted = [](std::string_view doing) { return !doing.ends_with("reading it"); };
    const Loading listening{[&](std::string_view doing) {
                                if (is_counted(doing)) told.emplace_back(doing);
                            },
                            nullptr};
    REQUIRE(load_scene(file, resolve_flat, open_scripted, nullptr, listening).scene);
    for (const char* said : {"mesh `triangle.obj`: which of its triangles cut each other", "texture `a:b`",
                             "mesh `box`: how round it is", "objects that meet: which of its parts meet"}) {
        CAPTURE(said);
        CHECK(std::find(told.begin(), told.end(), said) != told.end());
    }
    for (std::size_t step = 0; step < told.size(); ++step) {
        CAPTURE(step, told[step]);
        std::atomic<bool> stop = false;
        std::size_t steps = 0;
        const Loading ending{[&](std::string_view doing) { stop = stop || (is_counted(doing) && steps++ == step); },
                             &stop};
        const LoadedScene loaded = load_scene(file, resolve_flat, open_scripted, nullptr, ending);
        CHECK(!loaded.scene);
        CHECK(contains(loaded.diagnostics, "loading was stopped"));
    }
    // Whoever reads a mesh for ever is ended, too.
    std::atomic<bool> stop = true;
    const Loading ending{{}, &stop};
    const MeshReading reading = read_in_own_process(
        [](const std::string&) -> MeshFileResult {
            for (;;) pause();
        },
        "", {60, 60}, &ending);
    CHECK(reading.result.error == "loading was stopped");
}
