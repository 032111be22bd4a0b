// Closes cracks: borders that lie on each other but share no vertices, so that a point could slip between them. Of two
// kinds: corners of two borders that are nearly one (files round coordinates), and a corner of one border on the edge
// of another (a T-junction). The first are welded, the second become corners of both faces.
#include "runtime/geometry/predicates.h"
#include "runtime/surface/build/build.h"
#include "runtime/surface/build/edges.h"
#include "runtime/surface/corner.h"
#include "runtime/surface/swept_region.h"

#include <algorithm>
#include <numeric>
#include <optional>
#include <span>
#include <utility>

namespace haptel::runtime {

namespace {

// 1e-6 of the object's size: what six decimal digits, or single precision, cannot tell apart.
constexpr double crack = 0x1p21;

// What a node that a border comes near takes, in looks: it comes from memory where there are millions.
constexpr size_t looks_per_node = 8;

// Triangles without area in the corners, so that the tree of boxes tells which of them lie near a segment: at least all
// within a crack of it.
class CornersNear {
public:
    CornersNear(const Surface& surface, const std::vector<uint32_t>& corners, BuildWork& work)
        : points_(corners.size()), work_(work)
    {
        for (size_t k = 0; k < corners.size(); ++k) points_[k].vertex = {corners[k], corners[k], corners[k]};
        tree_.emplace(surface.vertices, points_, box_tree_of(surface.vertices, points_, work.threads()),
                      work.threads());
    }
    template <class Visit>
    void visit(const glm::dvec3& from, const glm::dvec3& to, Visit&& visit_one) const
    {
        struct Counted {
            SweptRegion region;
            BuildWork& work;
            uint32_t met(const BoxTree::Node& node) const { return work.spend(looks_per_node) ? region.met(node) : 0; }
        };
        (void)tree_->for_each(Counted{SweptRegion(from, to, from, to, crack), work_}, [&](uint32_t k) {
            visit_one(points_[k].vertex[0]);
            return true;
        });
    }

private:
    std::vector<Face> points_;
    BuildWork& work_;
    std::optional<BoxTree> tree_;
};

class CrackFiller {
public:
    CrackFiller(Surface& surface, BuildWork& work) : surface_(surface), work_(work) { find(); }

    // Each corner of a border becomes the first one that is near it, unless an edge of the border joins them.
    size_t weld()
    {
        std::vector<std::pair<uint32_t, uint32_t>> joined;
        for (HalfEdge border : borders_) joined.emplace_back(std::minmax(begin(border), end(border)));
        std::sort(joined.begin(), joined.end());

        std::vector<uint32_t> becomes(surface_.vertices.size());
        std::iota(becomes.begin(), becomes.end(), 0u);
        size_t welded = 0;
        const CornersNear corners(surface_, corners_, work_);
        for (uint32_t corner : corners_) {
            if (work_.over()) return 0;
            uint32_t first = corner;
            corners.visit(at(corner), at(corner), [&](uint32_t other) {
                if (other < first && becomes[other] == other && glm::distance(at(corner), at(other)) <= crack &&
                    !std::binary_search(joined.begin(), joined.end(), std::pair(other, corner)))
                    first = other;
            });
            becomes[corner] = first;
            welded += first != corner;
        }
        if (welded == 0) return 0;
        for (Face& face : surface_.faces)
            for (uint32_t& corner : face.vertex) corner = becomes[corner];
        drop_flat_faces(surface_, work_.threads()); // that lost their area when a corner moved
        find();
        return welded;
    }

    // Cuts each face along whose border edge corners of other borders lie, at the first of them.
    size_t cut()
    {
        size_t cuts = 0;
        const CornersNear corners(surface_, corners_, work_);
        std::vector<bool> touched(surface_.faces.size());
        for (HalfEdge border : borders_) {
            if (work_.over()) return 0;
            if (touched[border.face()]) continue; // its other edges: next time
            uint32_t corner = 0;
            double share = 1;
            if (!first_corner_on(border, corners, corner, share)) continue;
            touched[border.face()] = true;
            cut(border, corner, share);
            ++cuts;
        }
        if (cuts > 0) {
            drop_flat_faces(surface_, work_.threads());
            find();
        }
        return cuts;
    }

private:
    const glm::dvec3& at(uint32_t vertex) const { return surface_.vertices[vertex]; }
    uint32_t begin(HalfEdge border) const { return surface_.faces[border.face()].vertex[border.edge()]; }
    uint32_t end(HalfEdge border) const { return surface_.faces[border.face()].vertex[next(border.edge())]; }

    void find()
    {
        work_.spend(3 * surface_.faces.size());
        borders_.clear();
        const Edges edges(surface_, work_.threads());
        for (std::size_t low = 0; low < edges.vertices(); ++low)
            edges.visit(low, [&](std::span<const uint32_t> codes) {
                if (codes.size() == 1) borders_.push_back({codes[0]});
            });
        corners_.clear();
        for (HalfEdge border : borders_) {
            corners_.push_back(begin(border));
            corners_.push_back(end(border));
        }
        std::sort(corners_.begin(), corners_.end());
        corners_.erase(std::unique(corners_.begin(), corners_.end()), corners_.end());
    }

    bool first_corner_on(HalfEdge border, const CornersNear& corners, uint32_t& corner, double& share) const
    {
        const glm::dvec3 &a = at(begin(border)), &b = at(end(border)), along = b - a;
        const uint32_t tip = surface_.faces[border.face()].vertex[previous(border.edge())];
        const double length = glm::length(along);
        corners.visit(a, b, [&](uint32_t candidate) {
            const glm::dvec3 beside = at(candidate) - a;
            const double way = glm::dot(beside, along) / length;
            if (candidate == tip || way <= crack || way >= length - crack || way / length >= share ||
                glm::length(beside - way / length * along) > crack)
                return;
            corner = candidate;
            share = way / length;
        });
        return share < 1;
    }

    void cut(HalfEdge border, uint32_t corner, double share)
    {
        const uint32_t first = border.edge(), second = next(border.edge());
        Face rest = surface_.faces[border.face()];
        rest.vertex[first] = corner;
        surface_.faces[border.face()].vertex[second] = corner;
        surface_.faces.push_back(rest);
        if (auto& groups = surface_.smoothing_groups; !groups.empty())
            groups.push_back(uint32_t{groups[border.face()]});
        if (surface_.corner_uv.empty()) return;
        std::array<glm::dvec2, 3> rest_uv = surface_.corner_uv[border.face()];
        const glm::dvec2 uv = glm::mix(rest_uv[first], rest_uv[second], share);
        rest_uv[first] = uv;
        surface_.corner_uv[border.face()][second] = uv;
        surface_.corner_uv.push_back(rest_uv);
    }

    Surface& surface_;
    BuildWork& work_;
    std::vector<HalfEdge> borders_;
    std::vector<uint32_t> corners_; // of the borders, ascending
};

} // namespace

void close_cracks(Surface& surface, MeshReport& report, BuildWork& work)
{
    if (!work.begin("which of its borders lie on each other") || report.border_edges == 0) return;
    CrackFiller filler(surface, work);
    report.cracks_closed = filler.weld();
    // A round cuts each face once. More corners on one face than rounds: the rest stays open.
    for (int round = 0; round < 64 && !work.over(); ++round) {
        const size_t cuts = filler.cut();
        report.cracks_closed += cuts;
        if (cuts == 0) break;
    }
}

} // namespace haptel::runtime
