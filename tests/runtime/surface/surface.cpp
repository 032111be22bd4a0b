#include "runtime/surface/surface.h"

#include "runtime/contact/end_contact.h"
#include "runtime/surface/build/build.h"
#include "runtime/surface/build/edges.h"
#include "runtime/surface/corner.h"
#include "runtime/surface/shapes.h"
#include "tests/runtime/surface/meshes.h"
#include "tests/support/catch.h"

#include <cmath>
#include <random>
#include <set>

using namespace haptel::runtime;
using namespace haptel::test;
using glm::dvec3;

namespace {

// Half-planes that share the z axis as their edge, at the given angles (degrees), wound at random.
Mesh make_book(const std::vector<double>& angles)
{
    Mesh mesh;
    mesh.positions_m = {{0, 0, 0}, {0, 0, 1}};
    for (size_t i = 0; i < angles.size(); ++i) {
        const double angle = glm::radians(angles[i]);
        const uint32_t tip = uint32_t(mesh.positions_m.size());
        mesh.positions_m.emplace_back(std::cos(angle), std::sin(angle), 0.3 + 0.1 * double(i));
        if (i % 2)
            mesh.triangles.push_back({0, 1, tip});
        else
            mesh.triangles.push_back({tip, 1, 0});
    }
    return mesh;
}

double signed_volume(const Surface& s)
{
    double volume = 0;
    for (uint32_t f = 0; f < s.faces.size(); ++f)
        volume += glm::dot(s.vertex_m(f, 0), glm::cross(s.vertex_m(f, 1), s.vertex_m(f, 2))) / 6;
    return volume;
}

} // namespace

TEST_CASE("built-in shapes are closed, face outward and have the promised size")
{
    const double pi = 3.141592653589793;
    const struct {
        const char* name;
        double volume; // of the smooth shape
        int euler;     // vertices - edges + faces
    } shapes[] = {{"box", 1, 2},
                  {"sphere", pi / 6, 2},
                  {"icosphere", pi / 6, 2},
                  {"torus", 2 * pi * pi * (0.5 / 1.4) * (0.2 / 1.4) * (0.2 / 1.4), 0}};
    for (const auto& shape : shapes) {
        CAPTURE(shape.name);
        const Mesh mesh = make_shape(shape.name).value();
        const SurfaceResult built = build_surface(mesh);
        REQUIRE(built.surface);
        const Surface& s = *built.surface;
        CHECK(built.report.warning().empty()); // nothing to repair: users would ask what is wrong with the shape
        CHECK(built.report.border_edges == 0);
        CHECK(built.report.pierced == 0);
        CHECK(int(s.vertices.size()) - int(s.faces.size()) / 2 == shape.euler);
        CHECK(signed_volume(s) > 0.98 * shape.volume);
        CHECK(signed_volume(s) < 1.0000001 * shape.volume);
        const dvec3 sides = s.box_maximum_m - s.box_minimum_m;
        CHECK(std::abs(std::max({sides.x, sides.y, sides.z}) - 1) < 2e-3); // an icosphere's vertices miss the poles
    }
    const SurfaceResult plane = build_surface(make_plane(4));
    CHECK(plane.report.border_edges == 16);
    CHECK(plane.surface->faces.size() == 32);
    for (const Face& face : plane.surface->faces) CHECK(face.normal == dvec3(0, 0, 1));
    CHECK_FALSE(make_shape("cube").has_value());

    Mesh scaled = make_torus();
    scale_to_size(scaled, 0.15);
    const dvec3 sides = surface_of(scaled)->box_maximum_m - surface_of(scaled)->box_minimum_m;
    CHECK(std::abs(sides.x - 0.15) < 1e-11);
}

TEST_CASE("a mesh is repaired, and says what was wrong")
{
    Mesh mesh = make_box();
    mesh.positions_m.push_back({NAN, 0, 0});
    mesh.positions_m.push_back({0, INFINITY, 0});
    mesh.positions_m.push_back({0, 0, 1e200});
    const uint32_t bad = uint32_t(mesh.positions_m.size());
    mesh.triangles.push_back({0, 1, bad});
    mesh.triangles.push_back({0, 1, ~0u});
    mesh.triangles.push_back({0, 1, bad - 1});
    mesh.triangles.push_back({0, 1, bad - 2});
    mesh.triangles.push_back({0, 1, bad - 3});
    mesh.triangles.push_back({0, 0, 1});
    mesh.triangles.push_back({mesh.triangles[0][1], mesh.triangles[0][2], mesh.triangles[0][0]});
    mesh.triangles.push_back({mesh.triangles[0][2], mesh.triangles[0][1], mesh.triangles[0][0]});
    mesh.uv = {{0.5, 0.5}}; // too few: as if absent

    const SurfaceResult built = build_surface(mesh);
    REQUIRE(built.surface);
    CHECK(built.report.triangles_given == 20);
    CHECK(built.surface->faces.size() == 12);
    CHECK(built.report.indices_out_of_range == 2);
    CHECK(built.report.not_finite == 3);
    CHECK(built.report.degenerate == 1);
    CHECK(built.report.duplicate == 2);
    CHECK(built.report.border_edges == 0);
    CHECK(built.report.warning() ==
          "dropped triangles: 2 with a vertex index that does not exist, 3 with a coordinate that is not finite, "
          "1 without area, 2 given twice (of 20)");
    CHECK(built.surface->uv.empty());
    CHECK(build_surface(make_box()).report.warning().empty());
}

TEST_CASE("a mesh without one good triangle is an error that says why")
{
    Mesh mesh;
    CHECK(build_surface(mesh).error == "the mesh has no triangle to touch");
    // All that is left lies in a crack that closes.
    Mesh crack;
    crack.positions_m = {{0, 0, 0}, {1, 0, 0}, {0, 1e-7, 0}, {1, 1e-7, 0}, {1, -1e-7, 0}, {0, -1e-7, 0}};
    crack.triangles = {{0, 3, 4}, {1, 2, 5}};
    CHECK(build_surface(crack).error.starts_with("the mesh has no triangle to touch"));
    mesh.positions_m = {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {NAN, 0, 0}};
    mesh.triangles = {{0, 1, 2}, {0, 1, 3}};
    const SurfaceResult built = build_surface(mesh);
    CHECK_FALSE(built.surface);
    CHECK(built.error ==
          "the mesh has no triangle to touch: dropped triangles: 1 with a coordinate that is not finite, "
          "1 without area (of 2)");
}

TEST_CASE("links pair every side of every edge")
{
    for (const Mesh& mesh :
         {make_icosphere(2), make_plane(3), make_book({10, 40, 100, 200, 300}), make_crossing_boxes()}) {
        const auto s = surface_of(mesh);
        for (uint32_t f = 0; f < s->faces.size(); ++f)
            for (uint32_t e = 0; e < 3; ++e)
                for (uint32_t side = 0; side < 2; ++side) {
                    const SideEdge link = s->faces[f].link[e][side];
                    CHECK(s->faces[link.face()].link[link.edge()][link.side()] == SideEdge(f, e, side));
                    const auto ends = [&](uint32_t face, uint32_t edge) {
                        return std::set{s->faces[face].vertex[edge], s->faces[face].vertex[next(edge)]};
                    };
                    CHECK(ends(f, e) == ends(link.face(), link.edge()));
                    if (s->faces[f].link[e][0].face() == f) CHECK(link == SideEdge(f, e, 1 - side));
                }
    }
}

TEST_CASE("around a non-manifold edge each side is linked to the next face in space")
{
    for (const std::vector<double>& angles : {std::vector<double>{0, 90, 200},
                                              {5, 350, 120, 60},
                                              {0, 180, 90, 270},
                                              {30, 31, 32, 210, 211, 100},
                                              {0, 1e-7, 180}}) {
        const auto s = surface_of(make_book(angles));
        REQUIRE(s->faces.size() == angles.size());
        for (uint32_t f = 0; f < s->faces.size(); ++f)
            for (uint32_t side = 0; side < 2; ++side) {
                uint32_t edge = 0;
                while (s->faces[f].vertex[edge] > 1 || s->faces[f].vertex[next(edge)] > 1) ++edge;
                const SideEdge link = s->faces[f].link[edge][side];
                // Turning away from this side: counter-clockwise if the side's normal points that way around z.
                const double angle = glm::radians(angles[f]);
                const dvec3 turning(-std::sin(angle), std::cos(angle), 0);
                const double direction = glm::dot(s->facet_normal(f, side), turning) > 0 ? 1 : -1;
                double nearest = 1e9;
                uint32_t expected = f;
                for (uint32_t g = 0; g < angles.size(); ++g) {
                    if (g == f) continue;
                    double turn = std::fmod(direction * (angles[g] - angles[f]), 360.0);
                    if (turn < 0) turn += 360;
                    if (turn < nearest) nearest = turn, expected = g;
                }
                CAPTURE(f, side, angles.size());
                CHECK(link.face() == expected);
                // And it arrives on the side that looks back.
                const double there = glm::radians(angles[expected]);
                const dvec3 back = -direction * dvec3(-std::sin(there), std::cos(there), 0);
                CHECK(glm::dot(s->facet_normal(link.face(), link.side()), back) > 0);
            }
    }
}

TEST_CASE("vertex normals are weighted by angle, whatever the triangulation and winding")
{
    // At a box's corner the three sides meet at right angles: however the squares are cut, each counts alike.
    const double third = 1 / std::sqrt(3.0);
    Mesh box = make_box();
    const std::array<uint32_t, 3> first = box.triangles[0], second = box.triangles[1]; // {a, b, d}, {a, d, c}
    box.triangles[0] = {first[0], first[1], second[2]};
    box.triangles[1] = {first[1], first[2], second[2]};
    for (size_t i = 0; i < box.triangles.size(); i += 3) std::swap(box.triangles[i][0], box.triangles[i][1]);
    const auto s = surface_of(box);
    for (uint32_t f = 0; f < s->faces.size(); ++f) {
        const dvec3 middle = s->vertex_m(f, 0) + s->vertex_m(f, 1) + s->vertex_m(f, 2);
        const uint32_t outside = glm::dot(s->faces[f].normal, middle) > 0 ? 0 : 1;
        for (uint32_t i = 0; i < 3; ++i) {
            const dvec3 outward = glm::sign(s->vertex_m(f, i)) * third;
            const dvec3& out = s->fans[s->fan_of(f, i, outside)].normal;
            const dvec3& in = s->fans[s->fan_of(f, i, 1 - outside)].normal;
            CHECK(glm::length(out - outward) < 1e-12);
            CHECK(glm::length(in + outward) < 1e-12);
        }
    }
}

TEST_CASE("faces that pierce each other are found, and only those")
{
    const SurfaceResult boxes = build_surface(make_crossing_boxes());
    CHECK(boxes.report.pierced > 0);
    CHECK(boxes.report.warning().find("cut or touch others") != std::string::npos);

    // Two triangles, one stuck through the other's middle.
    Mesh cross;
    cross.positions_m = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, -1}, {1, 1, 1}, {-3, 1, 1}};
    cross.triangles = {{0, 1, 2}, {3, 4, 5}};
    CHECK(build_surface(cross).report.pierced == 2);
    cross.positions_m[3].z = 0; // now it only touches
    CHECK(build_surface(cross).report.pierced == 2);
    cross.positions_m[3].z = 0.5; // now it stays above
    CHECK(build_surface(cross).report.pierced == 0);
    CHECK(build_surface(make_star(3)).report.pierced == 0);
    CHECK(build_surface(make_stairs()).report.pierced == 0);
    CHECK(build_surface(make_stairs()).report.border_edges == 0);
}

TEST_CASE("cracks between borders are closed, and only cracks")
{
    // Every triangle with corners of its own, each off by up to 4e-7 of the size, as a file of rounded numbers has it.
    const Mesh whole = make_icosphere(3);
    Mesh apart;
    std::mt19937 random(5);
    const auto jitter = [&] { return 4e-7 / std::sqrt(3.0) * (double(random()) / 2147483648.0 - 1); };
    for (const auto& triangle : whole.triangles) {
        const uint32_t first = uint32_t(apart.positions_m.size());
        for (uint32_t i : triangle)
            apart.positions_m.push_back(whole.positions_m[i] + dvec3(jitter(), jitter(), jitter()));
        apart.triangles.push_back({first, first + 1, first + 2});
    }
    const SurfaceResult mended = build_surface(apart);
    CHECK(mended.report.cracks_closed == apart.positions_m.size() - whole.positions_m.size());
    CHECK(mended.report.border_edges == 0);
    CHECK(mended.surface->faces.size() == whole.triangles.size());

    // T-junctions: rows of 2, 4, 8 and 16 cells share 3 lines; what is left open is the outline.
    Mesh rows;
    for (const NamedMesh& hard : make_hard_meshes())
        if (hard.name == "T-junctions") rows = hard.mesh;
    rows.uv.resize(rows.positions_m.size());
    for (size_t i = 0; i < rows.uv.size(); ++i) rows.uv[i] = {rows.positions_m[i].x, rows.positions_m[i].y};
    const SurfaceResult rowed = build_surface(rows);
    CHECK(rowed.report.cracks_closed == 2 + 4 + 8);
    CHECK(rowed.report.border_edges == 2 + 16 + 4 * 2);
    CHECK(rowed.surface->faces.size() == 2 * (2 + 4 + 8 + 16) + 2 + 4 + 8);
    for (uint32_t f = 0; f < rowed.surface->faces.size(); ++f)
        for (uint32_t i = 0; i < 3; ++i)
            CHECK(glm::length(rowed.surface->uv[rowed.surface->uv_of[f][i]] -
                              glm::dvec2(rowed.surface->vertex_m(f, i))) < 1e-9);

    // A hand that is drawn along the lines, pressing down and exactly on them, stays on top.
    const auto point = make_point(rowed.surface);
    EndContact& contact = *point;
    int lost = 0, ticks = 0;
    for (int row = 1; row < 4; ++row) {
        contact.update({0.01, row, 1});
        for (double x = 0.01; x < 3.99; x += 0.003, ++ticks)
            lost += !contact.update({x, row + 1e-7 * (ticks % 3 - 1), 0.3 * std::sin(row) - 0.1}).touching;
        contact.update({3.98, row, 1});
    }
    CHECK(lost == 0);

    // An edge of a border that is shorter than a crack is wide stays.
    Mesh narrow;
    narrow.positions_m = {{0, 0, 0}, {1, 0, 0}, {1, 3e-7, 0}, {0, 1, 0}};
    narrow.triangles = {{0, 1, 2}, {0, 2, 3}};
    const SurfaceResult kept = build_surface(narrow);
    CHECK(kept.report.cracks_closed == 0);
    CHECK(kept.surface->faces.size() == 2);

    for (const Mesh& mesh : {make_plane(4), make_bumpy_sphere(2), make_star(3), make_stairs()})
        CHECK(build_surface(mesh).report.cracks_closed == 0);
}

TEST_CASE("sheets that cross in a vertex cut each other, those that only touch there do not")
{
    for (const NamedMesh& hard : make_hard_meshes()) {
        if (hard.name != "balls that cross in a vertex") continue;
        const SurfaceResult built = build_surface(hard.mesh);
        CHECK(built.report.pierced > 0);
        CHECK_FALSE(built.surface->is_clean());
        CHECK(built.report.border_edges == 0);
    }
    const SurfaceResult cubes = build_surface(make_touching_cubes(Touching::corners));
    CHECK(cubes.surface->is_clean());
}

TEST_CASE("a border's corner that stands on a closed sheet: both its sides and the sheet bound one space")
{
    Mesh mesh; // a shallow roof with its top in the origin, and a flap that stands on the top, over one of its faces
    mesh.positions_m = {{0, 0, 0},     {1, 0, -0.1},   {0, 1, -0.1},  {-1, 0, -0.1},
                        {0, -1, -0.1}, {1, 0.2, 0.15}, {0.2, 1, 0.15}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 1}, {0, 5, 6}};
    const auto s = surface_of(mesh);
    const auto corner = [&](uint32_t face) {
        for (uint32_t i = 0; i < 3; ++i)
            if (glm::length(s->vertex_m(face, i)) < 1e-9) return i;
        return 3u;
    };
    const uint32_t flap = 4;
    std::set<uint32_t> ring;
    for (uint32_t fan = s->fan_of(flap, corner(flap), 0); ring.insert(fan).second;) fan = s->fans[fan].next;
    CHECK(ring.contains(s->fan_of(flap, corner(flap), 1)));
    CHECK(ring.contains(s->fan_of(0, corner(0), 0))); // the roof from above
    CHECK_FALSE(ring.contains(s->fan_of(0, corner(0), 1)));

    // What slides down on the flap to its corner is held by the roof there.
    const auto point = make_point(s);
    EndContact& contact = *point;
    contact.update({0.3, 0.3, 0.5});
    for (int i = 0; i <= 300; ++i) contact.update({0.3 - 0.001 * i, 0.3 - 0.001 * i, 0.01 - 0.0001 * i});
    REQUIRE(contact.contact().touching);
    for (int i = 1; i <= 20; ++i) contact.update({-0.001 * i, -0.001 * i, -0.02 - 0.01 * i});
    CHECK(contact.contact().touching);
    CHECK(std::abs(contact.contact().proxy_m.z) < 0.1);
}

TEST_CASE("texture coordinates that corners of a vertex share are held once")
{
    const Mesh mesh = make_sphere(40, 20); // its seam has two of them at each vertex, its poles forty
    const auto s = surface_of(mesh);
    std::set<std::array<double, 5>> given, held;
    for (const auto& corners : mesh.triangles)
        for (const uint32_t i : corners) {
            const dvec3 p = s->lattice.snap_vertex(mesh.positions_m[i]);
            given.insert({p.x + 0.0, p.y + 0.0, p.z + 0.0, mesh.uv[i].x, mesh.uv[i].y});
        }
    for (uint32_t f = 0; f < s->faces.size(); ++f)
        for (uint32_t i = 0; i < 3; ++i) {
            const dvec3& p = s->vertices[s->faces[f].vertex[i]];
            const glm::dvec2& uv = s->uv[s->uv_of[f][i]];
            held.insert({p.x, p.y, p.z, uv.x, uv.y});
        }
    CHECK((held == given));
    CHECK(s->uv.size() == given.size());
}

TEST_CASE("faces that are cut where cracks close keep their smoothing group")
{
    Mesh mesh; // rows of triangles between whole numbers of y, with T-junctions between them
    for (const NamedMesh& hard : make_hard_meshes())
        if (hard.name == "T-junctions") mesh = hard.mesh;
    const auto row = [](double y) { return uint32_t(y) + 1; };
    for (const auto& [a, b, c] : mesh.triangles) {
        const auto& p = mesh.positions_m;
        mesh.smoothing_groups.push_back(row((p[a].y + p[b].y + p[c].y) / 3));
    }
    Surface surface;
    MeshReport report;
    BuildWork work(mesh.triangles.size());
    REQUIRE(repair(mesh, surface, report));
    link_faces(surface, Edges(surface, 0), report, 0);
    close_cracks(surface, report, work);
    CHECK(surface.faces.size() > mesh.triangles.size());
    REQUIRE(surface.smoothing_groups.size() == surface.faces.size());
    for (uint32_t f = 0; f < surface.faces.size(); ++f) {
        const double y = (surface.vertex_m(f, 0).y + surface.vertex_m(f, 1).y + surface.vertex_m(f, 2).y) / 3;
        CHECK(surface.smoothing_groups[f] == row(y));
    }
}
