#include "runtime/surface/discs.h"

#include "runtime/surface/in_parallel.h"

#include <algorithm>
#include <limits>

namespace haptel::runtime {

namespace {

// Past what rounding to single precision takes from a size.
float rounded_up(double size)
{
    return float(size * (1 + 1e-6) + 1);
}

// Around all triangles that for_each(visit) visits by their corners.
template <class ForEach>
BoxTree::Disc disc_around(ForEach&& for_each)
{
    glm::dvec3 sum(0), low(std::numeric_limits<double>::infinity()), high = -low;
    for_each([&](const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
        sum += glm::cross(b - a, c - a);
        low = glm::min(low, glm::min(a, glm::min(b, c)));
        high = glm::max(high, glm::max(a, glm::max(b, c)));
    });
    const double length = glm::length(sum);
    BoxTree::Disc disc;
    disc.axis = length > 0 ? glm::vec3(sum / length) : glm::vec3(0, 0, 1);
    const glm::dvec3 axis = glm::normalize(glm::dvec3(disc.axis)), middle = 0.5 * (low + high);
    double least = std::numeric_limits<double>::infinity(), most = -least;
    for_each([&](const auto&... corners) {
        for (const glm::dvec3& corner : {corners...}) {
            const double height = glm::dot(axis, corner - middle);
            least = std::min(least, height);
            most = std::max(most, height);
        }
    });
    disc.centre = glm::vec3(middle + 0.5 * (least + most) * axis);
    const glm::dvec3 centre(disc.centre);
    double radius = 0, half_height = 0;
    for_each([&](const auto&... corners) {
        for (const glm::dvec3& corner : {corners...}) {
            const double height = glm::dot(axis, corner - centre);
            half_height = std::max(half_height, std::fabs(height));
            radius = std::max(radius, glm::length(corner - centre - height * axis));
        }
    });
    disc.radius = rounded_up(radius);
    disc.half_height = rounded_up(half_height);
    return disc;
}

} // namespace

std::vector<BoxTree::Disc> discs_of(const std::vector<glm::dvec3>& vertices, const std::vector<Face>& faces,
                                    const std::vector<BoxTree::Node>& nodes, unsigned threads)
{
    // A node's children come after it, and all that is behind one of few faces right behind it.
    std::vector<std::size_t> behind(nodes.size()), end(nodes.size());
    const auto is_empty = [&](const BoxTree::Node& node, uint32_t k) { return !(node.low[0][k] <= node.high[0][k]); };
    for (std::size_t i = nodes.size(); i-- > 0;) {
        end[i] = i + 1;
        for (uint32_t k = 0; k < BoxTree::width; ++k) {
            const uint32_t child = nodes[i].child[k];
            if (is_empty(nodes[i], k)) continue;
            behind[i] += child & BoxTree::is_face ? 1 : behind[child];
            if (!(child & BoxTree::is_face)) end[i] = std::max(end[i], end[child]);
        }
    }
    std::vector<BoxTree::Disc> discs(nodes.size());
    each_in_parallel(nodes.size(), threads, [&](uint32_t i) {
        if (behind[i] > 0 && behind[i] <= BoxTree::Disc::faces_most)
            discs[i] = disc_around([&](auto&& visit) {
                for (std::size_t node = i; node < end[i]; ++node)
                    for (uint32_t k = 0; k < BoxTree::width; ++k) {
                        const uint32_t child = nodes[node].child[k];
                        if (is_empty(nodes[node], k) || !(child & BoxTree::is_face)) continue;
                        const auto& corners = faces[child & ~BoxTree::is_face].vertex;
                        visit(vertices[corners[0]], vertices[corners[1]], vertices[corners[2]]);
                    }
            });
    });
    return discs;
}

} // namespace haptel::runtime
