// Fans are made vertex by vertex, in pieces of vertices beside each other: no fan is of two. Faces get their numbers
// within the piece first.
#include "runtime/surface/build/build.h"
#include "runtime/surface/build/by_number.h"
#include "runtime/surface/build/fan_parts.h"
#include "runtime/surface/build/groups.h"
#include "runtime/surface/in_parallel.h"

#include <algorithm>
#include <span>
#include <utility>

namespace haptel::runtime {

namespace {

constexpr uint32_t no_fan = ~0u;

// The fans at one vertex. Two that share a face are the two sides of one sheet; sheets meet in the vertex only.
class SheetsAtVertex {
public:
    SheetsAtVertex(const Surface& surface, SomeFans& some, uint32_t first_fan)
        : surface_(surface)
        , some_(some)
        , first_fan_(first_fan)
        , fans_(std::span(some.fans).subspan(first_fan))
        , sheet_(fans_.size())
        , circle_(fans_.size())
    {
        Groups sheets(fans_.size());
        for (uint32_t i = 0; i < fans_.size(); ++i)
            for_each_sector(surface_, start(i), [&](const Sector& sector) {
                ++sectors_;
                const Face& face = surface_.faces[sector.face];
                sheets.unite(i, some_.fan_of(face.fan_or_part[sector.corner][1 - sector.side]) - first_fan_);
            });
        for (uint32_t i = 0; i < fans_.size(); ++i) sheet_[i] = sheets.first(i);
    }

    // Joins the fans of different sheets that see each other, unless a third sheet stands between.
    void join(BuildWork::Share& work)
    {
        const size_t count = fans_.size();
        if (std::all_of(sheet_.begin(), sheet_.end(), [](uint32_t sheet) { return sheet == 0; })) return;
        if (!work.spend(8 * sectors_ * count)) return;
        // From along each fan, which of the other sheets' fans are seen.
        std::vector<std::vector<bool>> seen_from(count, std::vector<bool>(count));
        for (size_t j = 0; j < count; ++j) {
            const glm::dvec3 along = direction(j);
            for (size_t k = 0; k < count; ++k)
                if (sheet_[k] != sheet_[j]) seen_from[j][k] = sees(k, along);
        }
        for (uint32_t i = 0; i < count; ++i)
            for (uint32_t j = 0; j < i; ++j) {
                if (sheet_[i] == sheet_[j] || !seen_from[j][i] || !seen_from[i][j]) continue;
                if (circle_.are_together(i, j)) continue;
                if (!work.spend(1 + count / 8)) return;
                if (!same_space(seen_from[i], seen_from[j], i, j)) continue;
                circle_.unite(i, j);
                std::swap(fans_[i].next, fans_[j].next);
            }
    }

private:
    Sector start(size_t i) const
    {
        const SideEdge& at = fans_[i].start;
        return {at.face(), at.edge(), at.side()};
    }

    // Some direction from the vertex along the sheet of the fan.
    glm::dvec3 direction(size_t i) const
    {
        const auto [a, b] = Spokes(surface_, start(i));
        return glm::normalize(a) + glm::normalize(b);
    }

    // Whether the direction, which is not on the fan's sheet, leads to the side that the fan sees: of an open fan both
    // sides are one space, around its borders.
    bool sees(size_t i, const glm::dvec3& direction) const
    {
        NearestInFan nearest;
        const bool closed = nearest.consider(surface_, start(i), direction);
        if (!closed) return true;
        if (nearest.way == 0) return glm::dot(fans_[i].normal, direction) > 0;
        const Sector& sector = nearest.sector;
        glm::dvec3 outward = surface_.facet_normal(sector.face, sector.side);
        if (nearest.edge != NearestInFan::into_sector) {
            const SideEdge link = surface_.faces[sector.face].link[nearest.edge][sector.side];
            outward += surface_.facet_normal(link.face(), link.side());
        }
        return glm::dot(outward, direction) > 0;
    }

    // Whether every third sheet sees both or neither.
    bool same_space(const std::vector<bool>& of_i, const std::vector<bool>& of_j, size_t i, size_t j) const
    {
        for (size_t k = 0; k < fans_.size(); ++k)
            if (of_i[k] != of_j[k] && sheet_[k] != sheet_[i] && sheet_[k] != sheet_[j]) return false;
        return true;
    }

    const Surface& surface_;
    SomeFans& some_;
    uint32_t first_fan_;
    std::span<Fan> fans_;
    std::vector<uint32_t> sheet_; // for each fan the first of its sheet
    Groups circle_;               // of `next`
    size_t sectors_ = 0;          // of all fans
};

} // namespace

void make_fans(Surface& surface, const ByNumber& corners, double crease_deg, BuildWork& work)
{
    if (!work.begin("which of its sheets meet in a vertex")) return;
    std::vector<Face>& faces = surface.faces;
    for (Face& face : faces) face.fan_or_part = {{{no_fan, no_fan}, {no_fan, no_fan}, {no_fan, no_fan}}};
    std::vector<SomeFans> pieces(pieces_of(surface.vertices.size()));
    in_pieces(surface.vertices.size(), work.threads(), [&](std::size_t begin, std::size_t end, std::size_t piece) {
        SomeFans& some = pieces[piece];
        BuildWork::Share share(work);
        FanMaker maker(surface, crease_deg, some);
        for (std::size_t vertex = begin; vertex < end && !work.over(); ++vertex) {
            const auto first_fan = static_cast<uint32_t>(some.fans.size());
            for (const uint32_t code : corners.of(vertex))
                for (uint32_t side = 0; side < 2; ++side)
                    if (faces[code / 3].fan_or_part[code % 3][side] == no_fan) maker.make({code / 3, code % 3, side});
            if (some.fans.size() - first_fan > 2) SheetsAtVertex(surface, some, first_fan).join(share);
        }
    });
    if (work.over()) return;

    std::vector<uint32_t> first_fan(pieces.size()), first_part(pieces.size());
    std::size_t fans = 0, parts = 0;
    for (std::size_t piece = 0; piece < pieces.size(); ++piece) {
        first_fan[piece] = static_cast<uint32_t>(std::exchange(fans, fans + pieces[piece].fans.size()));
        first_part[piece] = static_cast<uint32_t>(std::exchange(parts, parts + pieces[piece].parts.size()));
    }
    surface.fans.reserve(fans);
    surface.fan_parts.reserve(parts);
    for (std::size_t piece = 0; piece < pieces.size(); ++piece) {
        for (Fan fan : pieces[piece].fans) {
            fan.next += first_fan[piece];
            surface.fans.push_back(fan);
        }
        for (FanPart part : pieces[piece].parts) {
            part.fan += first_fan[piece];
            surface.fan_parts.push_back(part);
        }
        pieces[piece] = {};
    }
    each_in_parallel(faces.size(), work.threads(), [&](uint32_t f) {
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const std::size_t piece = faces[f].vertex[corner] / items_per_piece;
            for (uint32_t& number : faces[f].fan_or_part[corner])
                number += (number & Surface::is_part ? first_part : first_fan)[piece];
        }
    });
}

} // namespace haptel::runtime
