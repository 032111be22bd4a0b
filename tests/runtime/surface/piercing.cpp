// Sheets that pierce each other without sharing an edge: where the proxy is, against the nearest point of the cell that
// the sheets bound, and how the force changes from tick to tick.
#include "runtime/contact/end_contact.h"

#include "tests/runtime/surface/meshes.h"
#include "tests/support/catch.h"

#include <algorithm>
#include <cmath>
#include <random>

using namespace haptel::runtime;
using namespace haptel::test;
using glm::dvec3;

namespace {

// Squares of side 2 through the origin, facing their normals.
Mesh make_sheets(const std::vector<dvec3>& normals)
{
    Mesh mesh;
    for (const dvec3& n : normals) {
        const dvec3 u = glm::normalize(glm::cross(n, std::abs(n.x) < 0.6 ? dvec3(1, 0.1, 0) : dvec3(0.1, 1, 0)));
        const dvec3 v = glm::cross(n, u);
        const uint32_t first = uint32_t(mesh.positions_m.size());
        for (const dvec3& corner : {-u - v, u - v, u + v, v - u}) mesh.positions_m.push_back(corner);
        mesh.triangles.push_back({first, first + 1, first + 2});
        mesh.triangles.push_back({first, first + 2, first + 3});
    }
    return mesh;
}

// The point nearest to p where all normal . x >= r: by trying every set of planes that may hold it, moved to where they
// are those through the origin, which they all go through if there are no more than three.
dvec3 nearest_in_cell(const std::vector<dvec3>& normals, const dvec3& hand, double r)
{
    glm::dmat3 rows(normals[0], normals[1], normals.size() > 2 ? normals[2] : glm::cross(normals[0], normals[1]));
    const dvec3 apex = glm::inverse(glm::transpose(rows)) * dvec3(r, r, normals.size() > 2 ? r : 0.0);
    const dvec3 p = hand - apex;
    const auto inside = [&](const dvec3& x) {
        for (const dvec3& n : normals)
            if (glm::dot(n, x) < -1e-12) return false;
        return true;
    };
    if (inside(p)) return hand;
    dvec3 best(0);
    const auto offer = [&](const dvec3& x) {
        if (inside(x) && glm::length(x - p) < glm::length(best - p)) best = x;
    };
    for (const dvec3& n : normals) offer(p - glm::dot(p, n) * n);
    for (const dvec3& n : normals)
        for (const dvec3& m : normals) {
            const dvec3 line = glm::cross(n, m);
            if (glm::length(line) > 1e-9) offer(glm::dot(p, line) / glm::dot(line, line) * line);
        }
    return best + apex;
}

std::vector<std::vector<dvec3>> cells()
{
    std::vector<std::vector<dvec3>> cells;
    for (double degrees : {1.0, 20.0, 80.0, 90.0, 130.0, 160.0, 177.0}) { // between the normals
        const double angle = glm::radians(degrees);
        cells.push_back({{0.1, 0, 1}, {0.1 * std::cos(angle), std::sin(angle), std::cos(angle)}});
    }
    cells.push_back({{1, 0.2, 1}, {-0.7, 0.8, 1}, {-0.1, -1, 0.9}}); // a corner
    cells.push_back({{1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
    cells.push_back({{1, 0, 0.2}, {-0.6, 0.9, 0.2}, {-0.4, -0.9, 0.2}}); // a deep one
    cells.push_back({{0.1, 0, 1}, {-0.05, 0.1, 1}, {-0.05, -0.1, 1}});   // a shallow one
    for (std::vector<dvec3>& normals : cells)
        for (dvec3& n : normals) n = glm::normalize(n);
    return cells;
}

} // namespace

TEST_CASE("where sheets pierce each other the proxy is the nearest point of their cell, in every tick")
{
    for (const std::vector<dvec3>& normals : cells()) {
        dvec3 up(0);
        for (const dvec3& n : normals) up += n;
        up = glm::normalize(up);
        const auto surface = surface_of(make_sheets(normals));
        const auto point = make_point(surface);
        EndContact& contact = *point;
        const Lattice& lattice = surface->lattice;
        std::mt19937_64 random(3);
        std::normal_distribution<double> normal;
        dvec3 hand = 0.1 * up;
        contact.update(hand);
        dvec3 force_before(0), hand_before = hand;
        double off = 0, sharpest = 0, lag = 0, apart = 0;
        int touching = 0;
        const double stiffness_n_per_m = 500;
        for (int i = 0; i < 4000; ++i) {
            const double pace = i % 1000 < 500 ? 1e-3 : 0.02; // a stroke, and jumps
            hand += pace * dvec3(normal(random), normal(random), normal(random));
            if (glm::length(hand + 0.1 * up) > 0.25) hand = -0.1 * up + 0.8 * (hand + 0.1 * up);
            const Contact& touch = contact.update(hand);
            touching += touch.touching;
            if (touch.touching) lag = std::max(lag, glm::length(touch.lag_m)); // the normal bears it all
            const dvec3 at = lattice.metres(contact.proxy().at);
            off = std::max(off,
                           glm::distance(at, nearest_in_cell(normals, hand, Lattice::point_radius * lattice.unit_m)));
            dvec3 pushes(0); // of all that hold it, as of a point
            for (const Contact& row : contact.contacts()) pushes += row.depth_m * row.normal;
            const bool is_deep = std::ranges::all_of(
                contact.contacts(), [](const Contact& row) { return row.depth_m > 1e-3 && !row.on_crease; });
            if (touch.touching && is_deep)
                apart = std::max(apart, glm::distance(pushes, nearest_in_cell(normals, hand, 0) - hand));
            // The projection onto a convex cell draws no two points apart, nor does what is left of them.
            const dvec3 force = stiffness_n_per_m * (at - hand);
            sharpest = std::max(sharpest, glm::length(force - force_before) -
                                              stiffness_n_per_m * glm::length(hand - hand_before));
            force_before = force;
            hand_before = hand;
        }
        CAPTURE(normals.size(), glm::degrees(std::acos(glm::dot(normals[0], normals[1]))));
        CHECK(touching > 2000);
        CHECK(off < 5e-9); // rounding, over the sine of the angle between the sheets
        // Sheets that are hardly apart hold the ball far before where they meet.
        if (glm::dot(normals[0], normals[1]) > -0.9) CHECK(apart < Lattice::point_radius * lattice.unit_m);
        CHECK(sharpest < stiffness_n_per_m * 1e-8);
        CHECK(contact.counters().walks_cut == 0);
    }
}

TEST_CASE(
    "the force never grows by more than stiffness times the way of the hand, on sheets that pierce each other too")
{
    uint64_t touching = 0;
    for (const auto& [name, mesh] : make_hard_meshes()) {
        const auto surface = surface_of(mesh);
        const dvec3 middle = surface->lattice.centre_m;
        const double size = 0.5 * glm::length(surface->box_maximum_m - surface->box_minimum_m);
        const auto point = make_point(surface);
        EndContact& contact = *point;
        std::mt19937_64 random(9);
        std::normal_distribution<double> normal;
        dvec3 direction(0, 0, 1), heading(1, 0, 0);
        double depth_before = 0, steepest = 0;
        dvec3 hand_before = middle + 2.0 * size * direction;
        contact.update(hand_before);
        for (int i = 0; i < 20000; ++i) {
            heading = glm::normalize(heading + 0.05 * dvec3(normal(random), normal(random), normal(random)));
            direction = glm::normalize(direction + 2e-3 * heading);
            const double height = 0.55 + 0.4 * std::cos(1e-3 * i); // in and out
            const dvec3 hand = middle + height * size * direction;
            const Contact& touch = contact.update(hand);
            const double depth = glm::distance(surface->lattice.metres(contact.proxy().at), touch.hand_m);
            steepest = std::max(steepest, depth - depth_before - glm::length(hand - hand_before));
            depth_before = depth;
            hand_before = hand;
            touching += touch.touching;
        }
        CAPTURE(name);
        CHECK(steepest < 1e-8 * size);
        CHECK(contact.counters().walks_cut == 0);
    }
    CHECK(touching > 20000);
}
