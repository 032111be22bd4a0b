// The surface below a hand, for pictures: its normal is that of a plane z = a x, turned as scene and workspace say.
#include "runtime/surface/shapes.h"
#include "tests/support/catch.h"
#include "tools/plot/plot_surface.h"

#include <cmath>

using namespace haptel;
using namespace haptel::runtime;
using haptel::tools::plot::textured_normal_below;

namespace {

constexpr double slope = 0.3;

void ramp(const haptel_point* point, const void*, haptel_sample* sample)
{
    sample->height_m = slope * point->p[0];
    sample->gradient[0] = slope;
}

TextureBinding ramp_texture()
{
    static const haptel_texture texture = [] {
        haptel_texture made = {};
        made.abi = HAPTEL_ABI_VERSION;
        made.size = sizeof(haptel_texture);
        made.reads = HAPTEL_READS_POINT;
        made.block_size = sizeof(haptel_block_head);
        made.name = "ramp";
        made.height = made.height_gradient = ramp;
        return made;
    }();
    static const haptel_block_head block = {};
    TextureBinding binding;
    binding.texture = &texture;
    binding.block = &block;
    binding.facts = {-1, 1, slope, 0, HAPTEL_CONTINUITY_C1, 1};
    return binding;
}

} // namespace

TEST_CASE("a picture's surface is bent by its texture, through placement and workspace")
{
    auto scene = std::make_shared<Scene>();
    SceneObject& object = scene->objects.emplace_back();
    Mesh plane = make_plane();
    scale_to_size(plane, 0.1);
    object.surface = build_surface(plane).surface;
    REQUIRE(object.surface);
    object.texture = std::make_shared<TextureSlot>(ramp_texture());

    const glm::dvec3 expected = glm::normalize(glm::dvec3(-slope, 0, 1));
    const auto at = [&](const Workspace& workspace, double x_m, double y_m) {
        return textured_normal_below(scene, workspace)(x_m, y_m);
    };
    REQUIRE(at({}, 0.02, 0.01));
    CHECK(glm::length(*at({}, 0.02, 0.01) - expected) < 1e-12);
    CHECK(!at({}, 0.06, 0)); // beside it

    // A quarter of a turn about z: what rose along x rises along y.
    const glm::dmat3 turned(glm::dvec3(0, 1, 0), glm::dvec3(-1, 0, 0), glm::dvec3(0, 0, 1));
    object.placement.rotation = turned;
    object.placement.position_m = {1, 0, 5};
    REQUIRE(at({}, 1.01, 0.02));
    CHECK(glm::length(*at({}, 1.01, 0.02) - turned * expected) < 1e-12);

    // A hand whose axes are turned alike, in a space of half the size, sees it as it was.
    Workspace workspace;
    workspace.scale = 2;
    workspace.placement.rotation = turned;
    workspace.placement.position_m = {1, 0, 0};
    REQUIRE(at(workspace, 0.02, 0));
    CHECK(glm::length(*at(workspace, 0.02, 0) - expected) < 1e-12);
    CHECK(!at(workspace, 0.03, 0));

    CHECK(!textured_normal_below(std::make_shared<Scene>(), {}));
}
