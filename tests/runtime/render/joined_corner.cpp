// The line in which two joined objects meet.
#include "runtime/contact/end_contact.h"
#include "runtime/render/body.h"
#include "runtime/render/renderer.h"
#include "runtime/surface/collision.h"
#include "runtime/surface/corner.h"
#include "runtime/texture/shading.h"
#include "tests/support/catch.h"
#include "tests/support/touch_scenes.h"

#include <memory>
#include <utility>

using namespace haptel::runtime;
using namespace haptel::tests;
using glm::dvec3;

TEST_CASE("where a floor and a wall meet the hand is pushed out of both, though neither has a crease there")
{
    // Each goes on behind the other; joined, they end in the line where they meet.
    const glm::dmat3 upright(dvec3(0, 0, 1), dvec3(0, 1, 0), dvec3(-1, 0, 0)); // faces -x
    Scene scene = bare_scene(plane_mesh(0.2));
    scene.objects.push_back(scene.objects[0]);
    scene.objects[1].texture = std::make_shared<TextureSlot>();
    scene.objects[1].placement.rotation = upright;
    Mesh mesh;
    mesh.positions_m = {{-0.1, -0.1, 0}, {0, -0.1, 0}, {0, 0.1, 0}, {-0.1, 0.1, 0}, {0, -0.1, 0.1}, {0, 0.1, 0.1}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {1, 4, 5}, {1, 5, 2}};
    const auto surface = std::const_pointer_cast<Surface>(build_surface(mesh).surface);
    const dvec3 corner(0, 0.03, 0);
    for (const Face& face : surface->faces) {
        const uint32_t part = face.normal.z > 0.5 ? 0 : 1;
        const SceneObject& object = scene.objects[part];
        const dvec3 there = object.surface->lattice.units(object.placement.to_object(corner));
        const dvec3 weights = barycentric_of(*object.surface, 0, there);
        const bool inside = weights.x > 1e-3 && weights.y > 1e-3 && weights.z > 1e-3;
        surface->origins.push_back({part, inside ? 0u : 1u});
    }
    scene.joined.push_back({surface, {0, 1}});
    const auto point = make_point(surface);
    EndContact& contact = *point;
    contact.update({-0.02, 0.03, 0.02});
    contact.update({0.001, 0.03, -0.002});
    CreaseRows crease_rows;
    const auto rows = crease_rows.of(*surface, contact.contacts());
    REQUIRE(rows.size() == 2);
    for (const Contact& row : rows) {
        const SceneObject& object = scene.objects[surface->origins[row.face].part];
        const Contact found = on_part(row, *surface, object);
        CHECK_FALSE(found.on_crease);
        CHECK_FALSE(on_crease(*object.surface, found.face, found.side, found.barycentric));
        CHECK(found.normal == found.facet_normal);
    }

    Renderer renderer(shared(std::move(scene)));
    renderer.tick(at(-0.02, 0.03, 0.02));
    TickResult felt;
    for (int i = 0; i < 3; ++i) felt = renderer.tick(at(0.001, 0.03, -0.002));
    CHECK(glm::distance(felt.force_n, 1000.0 * dvec3(-0.001, 0, 0.002)) < 1e-8);
}
