// Which objects of a scene file are joined to one surface.
#include "runtime/render/renderer.h"
#include "tests/runtime/files/scene_folder.h"

#include <cmath>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

using namespace haptel;
using namespace haptel::runtime;
using namespace haptel::tests;

namespace {

using Groups = std::vector<std::vector<uint32_t>>;

std::string box(double x_m, std::string_view more = "")
{
    return "[[object]]\nshape = \"box\"\nsize_m = 0.02\nposition_m = [" + std::to_string(x_m) + ", 0, 0]\n" +
           std::string(more) + "\n";
}

std::string ball(double size_m, std::string_view more = "")
{
    return "[[object]]\nshape = \"icosphere\"\nsize_m = " + std::to_string(size_m) + "\n" + std::string(more) + "\n";
}

Groups joined_in(const std::string& toml)
{
    const Folder folder;
    const LoadedScene loaded = load(folder, toml);
    CHECK(loaded.diagnostics.empty());
    Groups groups;
    for (const JoinedObjects& joined : loaded.scene->joined) {
        groups.push_back(joined.objects);
        REQUIRE(joined.surface);
        REQUIRE(joined.surface->origins.size() == joined.surface->faces.size());
        for (const Origin& origin : joined.surface->origins) {
            REQUIRE(origin.part < joined.objects.size());
            REQUIRE(origin.face < loaded.scene->objects[joined.objects[origin.part]].surface->faces.size());
        }
    }
    return groups;
}

// The scenes hold their surfaces, the cache does not.
std::shared_ptr<const Scene> cached(const Folder& folder, const std::string& toml, SurfaceCache& surfaces)
{
    const LoadedScene loaded = load_scene(folder.write("scene.toml", toml), resolve_flat, open_scripted, &surfaces);
    INFO(loaded.diagnostics);
    REQUIRE(loaded.scene);
    return loaded.scene;
}

} // namespace

TEST_CASE("objects at rest that meet are joined, unless the scene says no")
{
    CHECK(joined_in(box(0)) == Groups{});
    CHECK(joined_in(box(0) + box(0.02)) == Groups{{0, 1}});
    CHECK(joined_in(box(0) + box(0.021)) == Groups{});
    CHECK(joined_in(box(0) + box(0.1) + box(0.01) + box(0.12)) == Groups{{0, 2}, {1, 3}});
    CHECK(joined_in(box(0) + box(0.02) + box(0.04)) == Groups{{0, 1, 2}}); // the first and the last by the second

    const char *apart = "joined = false", *together = "joined = true";
    CHECK(joined_in(box(0, together) + box(0.02)) == Groups{{0, 1}});
    CHECK(joined_in(box(0, apart) + box(0.02)) == Groups{});
    CHECK(joined_in(box(0) + box(0.02, apart) + box(0.04)) == Groups{});
    CHECK(joined_in(box(0) + box(0.02) + box(0.04, apart)) == Groups{{0, 1}});

    // What moves is by itself, though it passes through what is at rest.
    CHECK(joined_in(box(0) + box(0.02, "spin_deg_per_s = [0, 0, 90]")) == Groups{});
    CHECK(joined_in(box(0) + box(0.02, "swing_m = [0, 0, 0.01]\nswing_hz = 1\njoined = false")) == Groups{});

    // A hand pressed through the soft ball finds the hard one.
    CHECK(joined_in(ball(0.05, "stiffness_n_per_m = 100") + ball(0.03)) == Groups{});
    CHECK(joined_in(ball(0.05) + ball(0.05, "position_m = [0.03, 0.01, 0]")) == Groups{{0, 1}});
}

TEST_CASE("objects that meet nearly everywhere are joined like others")
{
    std::string balls;
    for (int k = 0; k < 10; ++k) balls += ball(0.1, "position_m = [0, 0, " + std::to_string(0.004 * k) + "]");
    CHECK(joined_in(balls) == Groups{{0, 1, 2, 3, 4, 5, 6, 7, 8, 9}});
}

TEST_CASE("an object that is there twice in one place is told, however it came there: both are felt")
{
    const auto said = [](size_t line, int first, int second) {
        return "scene.toml:" + std::to_string(line) + ":9: warning: objects " + std::to_string(first) + " and " +
               std::to_string(second) +
               " are both `box` in the same place: their forces add, as of one that is as stiff as both. Move one of "
               "them (`position_m`), or leave it out\n";
    };
    // Each box is five lines long.
    CHECK(diagnostics_of(box(0) + box(0.1) + box(0)) == said(12, 1, 3));
    CHECK(diagnostics_of(box(0) + box(0) + box(0)) == said(7, 1, 2) + said(12, 1, 3));
    CHECK(diagnostics_of(box(0, "joined = false") + box(0, "stiffness_n_per_m = 100")) == said(7, 1, 2));
    CHECK(diagnostics_of(box(0) + box(1e-6)).empty());
    CHECK(diagnostics_of(box(0) + box(0, "rotation_deg = [0, 0, 1]")).empty());
    CHECK(diagnostics_of(box(0) + box(0, "spin_deg_per_s = [0, 0, 9]")).empty());

    const Folder folder;
    const auto force_n = [&](const std::string& toml) {
        Renderer renderer(load(folder, toml).scene);
        renderer.tick({{0, 0, 0.02}, {0, 0, 0.1}});
        glm::dvec3 felt(0);
        for (int i = 0; i < 1000; ++i) felt = renderer.tick({{0, 0, 0.0095}, {0, 0, 0.1}}).force_n;
        return felt.z;
    };
    CHECK(std::abs(force_n(box(0)) - 0.4) < 1e-9); // 800 N/m, 0.5 mm
    CHECK(std::abs(force_n(box(0) + box(0)) - 0.8) < 1e-9);
}

TEST_CASE("what cannot be joined as the scene says is an error")
{
    CHECK(diagnostics_of("[[object]]\nshape = \"box\"\njoined = 1\n") ==
          "scene.toml:3:10: error: expected true or false for `joined`, found 1\n");
    CHECK(diagnostics_of("[[object]]\nshape = \"box\"\nspin_deg_per_s = [0, 0, 9]\njoined = true\n") ==
          "scene.toml:4:10: error: an object that moves cannot be joined to what it meets\n");
}

TEST_CASE("joined objects keep their own materials and textures, and may have none")
{
    const Folder folder;
    const Scene scene = *load(folder, box(0, "texture = \"a.haptel:b\"\nstiffness_n_per_m = 300") + box(0.02) +
                                          box(0.04, "texture = \"a.haptel:c\""))
                             .scene;
    REQUIRE(scene.joined.size() == 1);
    CHECK(scene.joined[0].objects == std::vector<uint32_t>{0, 1, 2});
    CHECK(scene.objects[0].material.stiffness_n_per_m == 300);
    CHECK(scene.objects[1].material.stiffness_n_per_m == 800);
    CHECK(scene.objects[0].request);
    CHECK_FALSE(scene.objects[1].request);
    CHECK(scene.objects[2].request);
    CHECK(scene.objects[0].surface == scene.objects[1].surface);
}

TEST_CASE("a scene loaded again has the joined surface that it had, if nothing of it moved")
{
    const Folder folder;
    SurfaceCache surfaces;
    const std::string elsewhere = box(0.2) + box(0.22);
    const auto first = cached(folder, box(0) + box(0.02) + elsewhere, surfaces);
    REQUIRE(first->joined.size() == 2);

    const auto softer = cached(folder, box(0) + box(0.02, "stiffness_n_per_m = 100") + elsewhere, surfaces);
    REQUIRE(softer->joined.size() == 2);
    CHECK(softer->joined[0].surface == first->joined[0].surface);
    CHECK(softer->joined[1].surface == first->joined[1].surface);

    const auto moved = cached(folder, box(0) + box(0.015) + elsewhere, surfaces);
    REQUIRE(moved->joined.size() == 2);
    CHECK(moved->joined[0].surface != first->joined[0].surface);
    CHECK(moved->joined[1].surface == first->joined[1].surface);

    const auto turned = cached(folder, box(0) + box(0.02, "rotation_deg = [0, 0, 90]") + elsewhere, surfaces);
    REQUIRE(turned->joined.size() == 2);
    CHECK(turned->joined[0].surface != first->joined[0].surface);

    // The same boxes, but another is the first: what a face belongs to is told by parts.
    const auto swapped = cached(folder, box(0.02) + box(0) + elsewhere, surfaces);
    CHECK(swapped->joined[0].surface != first->joined[0].surface);
    const auto larger = cached(folder, box(0) + box(0.025, "crease_deg = 90") + elsewhere, surfaces);
    CHECK(larger->joined.size() == 1);
}
