// Meshes of scenes: what is read, mended, told.
#include "runtime/texture/shading.h"
#include "tests/runtime/files/scene_folder.h"

#include <fstream>
#include <string>

using namespace haptel;
using namespace haptel::runtime;
using namespace haptel::tests;

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

TEST_CASE("a mesh that is not there is told with what is, and one that is cut off without the reader's words")
{
    const Folder folder;
    folder.write("bunny.obj", triangle_obj);
    folder.write("bunny.txt", "");
    folder.write("no.gltf", "{}");
    folder.write("short.stl", std::string(80, ' ') + std::string("\xe8\x03\0\0", 4) + std::string(150, '\0'));
    const auto said = [&](const std::string& mesh) {
        const LoadedScene loaded = load_scene(folder.write("scene.toml", "[[object]]\nmesh = \"" + mesh + "\"\n"),
                                              resolve_flat, open_scripted);
        CHECK_FALSE(loaded.scene);
        const std::size_t at = loaded.diagnostics.find(": error: ");
        return at == std::string::npos ? "" : loaded.diagnostics.substr(at);
    };
    CHECK(said("buny.obj") == ": error: mesh `buny.obj`: there is no such file (looked for " + folder.file("buny.obj") +
                                  "): did you mean `bunny.obj`?\n");
    CHECK(said("BUNNY.OBJ").ends_with("did you mean `bunny.obj`?\n"));
    CHECK(said("teapot.ply") == ": error: mesh `teapot.ply`: there is no such file (looked for " +
                                    folder.file("teapot.ply") + "): paths start from the scene's folder\n");
    CHECK(said("no/bunny.obj").ends_with("no/bunny.obj): paths start from the scene's folder\n"));
    CHECK(said("short.stl") ==
          ": error: mesh `short.stl`: the file could not be read: its content is not that of a whole "
          ".stl file; is it damaged or cut off? Export it again, or as OBJ or STL\n");
    CHECK(said("no.gltf").find("its content is not that of a whole .gltf file; is it damaged") != std::string::npos);
}

TEST_CASE("a mesh in millimetres is told, as far as its size and the workspace show it")
{
    const Folder folder;
    folder.write("part.obj", "v 0 0 0\nv 40 0 0\nv 0 30 0\nf 1 2 3\n");
    const auto warned = [&](const std::string& toml) {
        const std::string text = load(folder, toml).diagnostics;
        const std::size_t at = text.find("warning: ");
        return at == std::string::npos ? "" : text.substr(at, text.find('\n', at) - at);
    };
    const std::string part = "[[object]]\nmesh = \"part.obj\"\n";
    CHECK(warned(part) == "warning: mesh `part.obj` is 40 m large, as its numbers are taken for metres: if they are "
                          "millimetres write `size_m = \"40mm\"`, else `size_m = \"40m\"`");
    CHECK(warned(part + "size_m = \"40mm\"\n").empty());
    CHECK(warned(part + "size_m = \"40m\"\n").empty());
    CHECK(warned("[[object]]\nshape = \"box\"\nsize_m = 40\n").empty());
    CHECK(warned("[workspace]\nscale = 8\n" + part).empty());
    CHECK_FALSE(warned("[workspace]\nscale = 7.9\n" + part).empty());
}
