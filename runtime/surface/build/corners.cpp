#include "runtime/surface/build/build.h"
#include "runtime/surface/build/by_number.h"

#include <algorithm>
#include <cstring>
#include <vector>

namespace haptel::runtime {

ByNumber corners_by_vertex(const Surface& surface)
{
    return ByNumber(surface.vertices.size(), 3 * surface.faces.size(),
                    [&](uint32_t code) { return surface.faces[code / 3].vertex[code % 3]; });
}

void gather_uv(Surface& surface, const ByNumber& corners)
{
    const auto& given = surface.corner_uv;
    if (given.empty()) return;
    // Twice: so that no room is taken in vain.
    std::vector<uint32_t> order;
    const auto for_each_vertex = [&](auto&& visit) { // visit(corner, whether it is the first with these coordinates)
        for (std::size_t vertex = 0; vertex < corners.numbers(); ++vertex) {
            const auto at = [&](uint32_t code) { return given[code / 3][code % 3]; };
            const auto is_less = [&](uint32_t a, uint32_t b) {
                return std::memcmp(&given[a / 3][a % 3], &given[b / 3][b % 3], sizeof(glm::dvec2)) < 0;
            };
            const auto of = corners.of(vertex);
            order.assign(of.begin(), of.end());
            std::sort(order.begin(), order.end(), is_less);
            for (std::size_t k = 0; k < order.size(); ++k) visit(order[k], k == 0 || at(order[k]) != at(order[k - 1]));
        }
    };
    std::size_t count = 0;
    for_each_vertex([&](uint32_t, bool is_first) { count += is_first; });
    surface.uv.reserve(count);
    surface.uv_of.resize(surface.faces.size());
    for_each_vertex([&](uint32_t code, bool is_first) {
        if (is_first) surface.uv.push_back(given[code / 3][code % 3]);
        surface.uv_of[code / 3][code % 3] = static_cast<uint32_t>(surface.uv.size() - 1);
    });
    surface.corner_uv = {};
}

} // namespace haptel::runtime
