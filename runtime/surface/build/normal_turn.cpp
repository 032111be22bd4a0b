#include "runtime/surface/build/build.h"
#include "runtime/surface/in_parallel.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace haptel::runtime {

namespace {

// Largest spectral norm of the derivative of the normal on one face, which is J / |s| without its part along s: s the
// interpolated sum of vertex normals, J its constant derivative.
double turn_max(const Surface& surface, uint32_t face, uint32_t side)
{
    const auto n = surface.shading_normals(face, side);
    // For unit normals and weights of sum 1: |s|^2 = 1 - sum of w_i w_j |n_i - n_j|^2 over the three pairs.
    double apart = 0;
    bool unit = true;
    for (int i = 0; i < 3; ++i) {
        const glm::dvec3 between = n[i] - n[(i + 1) % 3];
        apart = std::max(apart, glm::dot(between, between));
        unit = unit && n[i] != glm::dvec3(0);
    }
    const double shortest_squared = unit ? 1 - apart / 3 : 0; // the sum of w_i w_j over pairs is at most 1/3

    // J in the plane of the face, its columns along the first edge and across it.
    const auto [p, q, r] = surface.corners(face);
    const glm::dvec3 along = q - p, other = r - p;
    const double length = glm::length(along), place = glm::dot(other, along) / length;
    const double height = glm::length(glm::cross(along, other)) / length;
    const glm::dvec3 by_along = (n[1] - n[0]) / length;
    const glm::dvec3 by_across = ((n[2] - n[0]) - place * by_along) / height;
    const double a = glm::dot(by_along, by_along), b = glm::dot(by_across, by_across),
                 c = glm::dot(by_along, by_across);
    const double norm = std::sqrt(0.5 * (a + b + std::hypot(a - b, 2 * c)));
    const double shortest = std::max(std::sqrt(std::max(0.0, shortest_squared)), Surface::least_normal);
    return norm / (shortest * surface.lattice.unit_m);
}

} // namespace

void find_normal_turn(Surface& surface, unsigned threads)
{
    std::vector<double> most(pieces_of(surface.faces.size()));
    in_pieces(surface.faces.size(), threads, [&](std::size_t begin, std::size_t end, std::size_t piece) {
        for (auto f = static_cast<uint32_t>(begin); f < end; ++f)
            for (uint32_t side = 0; side < 2; ++side) most[piece] = std::max(most[piece], turn_max(surface, f, side));
    });
    // Of rounding, here and where the derivative is made.
    surface.normal_turn_max_per_m = *std::max_element(most.begin(), most.end()) * (1 + 1e-9);
}

} // namespace haptel::runtime
