// Malformed mesh files, as far as their readers go; tests/runtime/surface/hostile.cpp has malformed meshes themselves.
#include "runtime/files/mesh_file.h"
#include "tests/runtime/files/scene_folder.h"
#include "tests/support/catch.h"
#include "tests/support/folder.h"

#include <cmath>
#include <filesystem>
#include <string>
#include <string_view>
#include <sys/stat.h>

using namespace haptel;
using namespace haptel::runtime;
using haptel::tests::contains;

namespace {

const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

// A strip of right-angled triangles, two for each square; `before` stands before each of them.
template <class Before>
std::string strip(int triangles, Before&& before)
{
    std::string obj;
    for (int i = 0; i <= triangles / 2 + 1; ++i)
        obj += "v " + std::to_string(i) + " 0 0\nv " + std::to_string(i) + " 1 0\n";
    for (int i = 0; i < triangles; ++i) {
        obj += before(i);
        obj += "f " + std::to_string(i + 1) + " " + std::to_string(i + 2) + " " + std::to_string(i + 3) + "\n";
    }
    return obj;
}

std::string ply(std::string_view vertices, std::string_view faces)
{
    return "ply\nformat ascii 1.0\nelement vertex " + std::string(vertices) +
           "\nproperty float x\nproperty float y\nproperty float z\nelement face " + std::string(faces) +
           "\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
}

} // namespace

TEST_CASE("a mesh that is no regular file, or too large, is refused by what it is")
{
    const test::Folder folder;
    const std::string pipe = folder.file("pipe.obj"), sparse = folder.write("sparse.stl", "");
    REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
    std::filesystem::resize_file(sparse, std::uintmax_t{1} << 42);
    std::filesystem::create_symlink("/dev/zero", folder.path / "zero.ply");
    CHECK(load_mesh(pipe).error == "it is a pipe, not a regular file");
    CHECK(load_mesh(folder.path / "zero.ply").error == "it is a device, not a regular file");
    CHECK(load_mesh(sparse).error == "it has 4 TiB, and at most 1 GiB are read");
    CHECK(load_mesh(folder.path).error == "it is a folder");
}

TEST_CASE("a file that a mesh names is read with the same care: a material library, a buffer")
{
    const test::Folder folder;
    REQUIRE(mkfifo(folder.file("pipe").c_str(), 0600) == 0);
    std::filesystem::create_symlink("/dev/zero", folder.path / "zero");
    for (const auto& [name, is] : {std::pair("pipe", "a pipe"), std::pair("zero", "a device")}) {
        CAPTURE(name);
        const std::string told =
            "it is made of other files, and `" + (folder.path / name).string() + "` is " + is + ", not a regular file";
        CHECK(load_mesh(folder.write("m.obj", "mtllib " + std::string(name) + "\n" + triangle)).error == told);
        const std::string gltf = R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
            "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
            "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],
            "bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36,"uri":")";
        CHECK(load_mesh(folder.write("m.gltf", gltf + name + "\"}]}")).error == told);
    }
    // One that is not there is no fault of a mesh, which needs no materials.
    CHECK(load_mesh(folder.write("m.obj", "mtllib none.mtl\n" + triangle)).mesh.triangles.size() == 1);
}

TEST_CASE("a file that lies about its counts is refused, and takes no memory for them")
{
    const test::Folder folder;
    CHECK(load_mesh(folder.write("m.ply", ply("3", "1"))).mesh.triangles.size() == 1);
    for (const char* many : {"100000000", "2000000000", "4000000000"})
        for (const std::string& text : {ply(many, "1"), ply("3", many)}) {
            CAPTURE(many);
            const MeshFileResult read = load_mesh(folder.write("m.ply", text));
            CHECK((!read.error.empty() || read.mesh.triangles.size() == 1));
        }
}

TEST_CASE("an OBJ file of thousands of groups, objects and materials is one mesh, in the order of the file")
{
    const test::Folder folder;
    const int count = 5000;
    const std::string plain = strip(count, [](int) { return ""; });
    const MeshFileResult expected = load_mesh(folder.write("plain.obj", plain));
    REQUIRE(expected.mesh.triangles.size() == count);
    for (const std::string word : {"g", "o", "usemtl"}) {
        CAPTURE(word);
        const MeshFileResult read = load_mesh(
            folder.write("m.obj", strip(count, [&](int i) { return word + " name" + std::to_string(i) + "\n"; })));
        CHECK(read.error == "");
        CHECK(read.mesh.triangles == expected.mesh.triangles);
        CHECK(read.mesh.positions_m == expected.mesh.positions_m);
        CHECK(read.mesh.smoothing_groups.empty());
    }
}

TEST_CASE("more smoothing groups than are kept apart are left out, and that is told")
{
    const test::Folder folder;
    const auto groups = [&](int count) {
        return load_mesh(
            folder.write("m.obj", strip(3000, [&](int i) { return "s " + std::to_string(1 + i % count) + "\n"; })));
    };
    const MeshFileResult few = groups(7), many = groups(2000);
    CHECK(few.warning == "");
    CHECK(few.mesh.smoothing_groups.size() == 3000);
    CHECK(many.error == "");
    CHECK(many.mesh.triangles.size() == 3000);
    CHECK(many.mesh.smoothing_groups.empty());
    CHECK(contains(many.warning, "more than 1000 smoothing groups"));
}

TEST_CASE("a polygon of a hundred thousand corners is refused with what to do; one of a thousand is cut")
{
    const test::Folder folder;
    const auto polygon = [&](int corners) {
        std::string obj, face = "f";
        for (int i = 0; i < corners; ++i) {
            const double turn = 2 * 3.14159265358979 * i / corners;
            obj += "v " + std::to_string(std::cos(turn)) + " " + std::to_string(std::sin(turn)) + " 0\n";
            face += " " + std::to_string(i + 1);
        }
        return load_mesh(folder.write("m.obj", obj + face + "\n"));
    };
    CHECK(polygon(1000).mesh.triangles.size() == 998);
    const MeshFileResult large = polygon(100'000);
    CHECK(large.mesh.triangles.empty());
    CHECK(contains(large.error, "up to 100000"));
    CHECK(contains(large.error, "before the model is exported"));
}
