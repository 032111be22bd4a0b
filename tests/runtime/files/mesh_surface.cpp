// Surfaces of mesh files that are kept on disk: the same as built, or built anew.
#include "runtime/files/mesh_surface.h"

#include "tests/runtime/surface/meshes.h"
#include "tests/runtime/surface/same_surface.h"
#include "tests/support/catch.h"
#include "tests/support/folder.h"
#include "tests/support/tries.h"

#include <cstdio>
#include <iterator>
#include <sys/stat.h>
#include <unistd.h>

using namespace haptel;
using namespace haptel::runtime;
using namespace haptel::test;
namespace fs = std::filesystem;

namespace {

std::string obj_of(const Mesh& mesh)
{
    std::string text;
    char line[200];
    for (const glm::dvec3& p : mesh.positions_m) {
        std::snprintf(line, sizeof line, "v %.9f %.9f %.9f\n", p.x, p.y, p.z);
        text += line;
    }
    for (const auto& [a, b, c] : mesh.triangles)
        text += "f " + std::to_string(a + 1) + " " + std::to_string(b + 1) + " " + std::to_string(c + 1) + "\n";
    return text;
}

std::string bytes_of(const fs::path& file)
{
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

// A folder with a mesh, and one for surfaces.
struct Kept {
    Folder folder;
    input::KeptFiles files{folder.path / "kept", ".surface", 1 << 28};

    MeshSurface surface(const std::string& name, double size_m = 0.1, std::optional<double> crease_deg = {})
    {
        return surface_of_mesh_file(folder.path / name, size_m, crease_deg, {}, files, 0);
    }
    fs::path only_file() const
    {
        const fs::directory_iterator first(folder.path / "kept");
        REQUIRE(std::distance(first, fs::directory_iterator()) == 1);
        return fs::directory_iterator(folder.path / "kept")->path();
    }
    uint64_t count() const { return files.status().files; }
};

// Built from the same file with nothing kept.
MeshSurface built(const Kept& kept, const std::string& name, double size_m = 0.1)
{
    input::KeptFiles none("", ".surface", 0);
    return surface_of_mesh_file(kept.folder.path / name, size_m, {}, {}, none, 0);
}

// Told by the file of the mesh being read no more: a folder in its place could not be.
bool comes_from_disk(Kept& kept, const std::string& name)
{
    std::vector<std::string> told;
    const Loading loading{[&](std::string_view doing) { told.emplace_back(doing); }};
    const MeshSurface found = surface_of_mesh_file(kept.folder.path / name, 0.1, {}, loading, kept.files, 0);
    REQUIRE(found.surface);
    return told.empty(); // building tells of its steps
}

} // namespace

TEST_CASE("a surface from disk is the one that was built, to the last bit, with what was told of it")
{
    Kept kept;
    Mesh pierced = make_crossing_boxes();
    pierced.triangles.push_back(pierced.triangles[0]);
    kept.folder.write("pierced.obj", obj_of(pierced));
    kept.folder.write("bumpy.obj", obj_of(make_bumpy_sphere(5)));
    kept.folder.write("open.obj", "s off\n" + obj_of(make_plane(20)));
    kept.folder.write("drawn.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n");
    kept.folder.write("far.obj", "v 90000 0 0\nv 90001 0 0\nv 90000 1 0\nf 1 2 3\n");
    for (const std::string name : {"pierced.obj", "bumpy.obj", "open.obj", "drawn.obj", "far.obj"}) {
        CAPTURE(name);
        const MeshSurface expected = built(kept, name), made = kept.surface(name), found = kept.surface(name);
        REQUIRE(expected.surface);
        for (const MeshSurface* one : {&made, &found}) {
            REQUIRE(one->surface);
            CHECK(first_difference(*one->surface, *expected.surface) == "");
            CHECK((same_bits(one->report, expected.report)));
            CHECK(one->warning == expected.warning);
            CHECK(one->all_groups_off == expected.all_groups_off);
        }
        CHECK(comes_from_disk(kept, name));
        // Its tree asks the arrays that it lies beside.
        CHECK(bool(found.surface->first_hit({0, 0, 1}, {0, 0, -1})) ==
              bool(expected.surface->first_hit({0, 0, 1}, {0, 0, -1})));
    }
    CHECK(kept.count() == 5);
    CHECK(built(kept, "open.obj").all_groups_off);
    CHECK(!built(kept, "far.obj").warning.empty());
    CHECK(!built(kept, "drawn.obj").surface->uv.empty());
}

TEST_CASE("another file, size or crease is another surface; the same file elsewhere is the same")
{
    Kept kept;
    kept.folder.write("a.obj", obj_of(make_icosphere(2)));
    kept.folder.write("b.obj", obj_of(make_icosphere(2)));
    CHECK(!comes_from_disk(kept, "a.obj"));
    CHECK(comes_from_disk(kept, "b.obj"));
    kept.surface("a.obj", 0.2);
    CHECK(kept.count() == 2);
    const MeshSurface flat = kept.surface("a.obj", 0.1, 0);
    CHECK(kept.count() == 3);
    CHECK(flat.surface->fan_parts.size() == 6 * flat.surface->faces.size());
    kept.folder.write("a.obj", obj_of(make_icosphere(3)));
    CHECK(kept.surface("a.obj").surface->faces.size() == 20 * 64);
    CHECK(kept.surface("b.obj").surface->faces.size() == 20 * 16);
}

TEST_CASE("a mesh that is made of several files is another one when any of them changes")
{
    Kept kept;
    const auto buffer = [](float x) {
        const float corners[9] = {0, 0, 0, x, 0, 0, 0, 1, 0};
        return std::string(reinterpret_cast<const char*>(corners), sizeof corners);
    };
    kept.folder.write("m.gltf",
                      R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],)"
                      R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],)"
                      R"("buffers":[{"uri":"m.bin","byteLength":36}],"bufferViews":[{"buffer":0,"byteLength":36}],)"
                      R"("accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3",)"
                      R"("min":[0,0,0],"max":[9,1,0]}]})");
    kept.folder.write("m.bin", buffer(1));
    const MeshSurface first = kept.surface("m.gltf", 0);
    INFO(first.error);
    REQUIRE(first.surface);
    CHECK(kept.count() == 1);
    CHECK(first.surface->box_maximum_m.x == 1);
    kept.folder.write("m.bin", buffer(3));
    CHECK(kept.surface("m.gltf", 0).surface->box_maximum_m.x == 3);
    CHECK(kept.surface("m.gltf", 0).surface->box_maximum_m.x == 3);
    fs::create_directory(kept.folder.path / "elsewhere"); // the same text beside another buffer
    kept.folder.write("elsewhere/m.gltf", bytes_of(kept.folder.path / "m.gltf"));
    kept.folder.write("elsewhere/m.bin", buffer(7));
    CHECK(kept.surface("elsewhere/m.gltf", 0).surface->box_maximum_m.x == 7);
}

TEST_CASE("a surface on disk that is cut, changed or of another version is not taken, and is replaced")
{
    Kept kept;
    kept.folder.write("a.obj", obj_of(make_bumpy_sphere(1)));
    const MeshSurface expected = kept.surface("a.obj");
    const fs::path file = kept.only_file();
    const std::string good = bytes_of(file);
    CHECK(comes_from_disk(kept, "a.obj"));
    std::vector<std::string> damaged{"", "x", good + "x", std::string(good.size(), '\0')};
    for (const size_t length : {size_t{15}, size_t{100}, size_t{400}, good.size() / 2, good.size() - 1})
        damaged.push_back(good.substr(0, length));
    const size_t in_head = is_sanitized ? 35 : 7, behind = good.size() / tries(50);
    for (size_t at = 0; at < good.size(); at += at < 400 ? in_head : behind)
        for (const char bit : {char(1), char(-128)}) {
            damaged.push_back(good);
            damaged.back()[at] = char(damaged.back()[at] ^ bit);
        }
    for (const std::string& bytes : damaged) {
        std::ofstream(file, std::ios::binary) << bytes;
        REQUIRE(!comes_from_disk(kept, "a.obj"));
        REQUIRE((bytes_of(file).size() == good.size()));
        REQUIRE(first_difference(*kept.surface("a.obj").surface, *expected.surface) == "");
    }
}

TEST_CASE("what is built at once, what cannot be built and what has no folder to be kept in leaves nothing")
{
    Kept kept;
    kept.folder.write("a.obj", obj_of(make_icosphere(1)));
    kept.folder.write("bad.obj", "v 0 0 0\nf 1 1 1\n");
    CHECK(surface_of_mesh_file(kept.folder.path / "a.obj", 0.1, {}, {}, kept.files, 1e9).surface);
    CHECK(!kept.surface("bad.obj").error.empty());
    CHECK(!kept.surface("none.obj").error.empty());
    CHECK(kept.count() == 0);

    kept.folder.write("file", "no folder");
    for (const fs::path& path : {fs::path(), kept.folder.path / "file", fs::path("/proc/none/of/it")}) {
        input::KeptFiles impossible(path, ".surface", 1 << 28);
        for (int again = 0; again < 2; ++again)
            CHECK(surface_of_mesh_file(kept.folder.path / "a.obj", 0.1, {}, {}, impossible, 0).surface);
        CHECK(impossible.status().files == 0);
    }
    kept.surface("a.obj");
    CHECK(kept.count() == 1);
    chmod((kept.folder.path / "kept").c_str(), 0777); // others might have put anything there
    CHECK(!comes_from_disk(kept, "a.obj"));
    chmod((kept.folder.path / "kept").c_str(), 0700);
    CHECK(comes_from_disk(kept, "a.obj"));
}
