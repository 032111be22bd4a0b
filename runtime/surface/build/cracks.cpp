// Closes cracks: borders that lie on each other but share no vertices, so that a point could slip between them. Of two
// kinds: corners of two borders that are nearly one (files round coordinates), and a corner of one border on the edge
// of another (a T-junction). The first are welded, the second become corners of both faces.
#include "runtime/geometry/predicates.h"
#include "runtime/surface/build/build.h"
#include "runtime/surface/build/edges.h"
#include "runtime/surface/corner.h"

#include <algorithm>
#include <numeric>
#include <span>
#include <utility>

namespace haptel::runtime {

namespace {

// 1e-6 of the object's size: what six decimal digits, or single precision, cannot tell apart.
constexpr double crack = 2097152;

// What a corner that a border comes near takes, in looks: it comes from memory where there are millions.
constexpr size_t looks_per_corner = 3;

// Vertices in a tree of halves, to ask which lie near a segment. A half is parted across its widest side: of vertices
// in a line or a plane that leaves as few to look at as of those in space.
class NearVertices {
public:
    NearVertices(const std::vector<glm::dvec3>& positions, const std::vector<uint32_t>& vertices)
    {
        nodes_.reserve(vertices.size());
        for (uint32_t vertex : vertices) nodes_.push_back({positions[vertex], vertex, 0});
        build(0, nodes_.size());
    }

    // At least all that come within `reach` of the segment, and of others not many.
    template <class Visit>
    void visit_near(const glm::dvec3& from, const glm::dvec3& to, double reach, Visit&& visit_one) const
    {
        near(0, nodes_.size(), from, to - from, 0, 1, 2 * reach, visit_one); // twice: whatever rounding does
    }

private:
    struct Node { // with its position: to follow an index to it costs most of the time
        glm::dvec3 at;
        uint32_t vertex;
        int axis;
    };

    void build(size_t begin, size_t end)
    {
        if (end - begin < 2) return;
        glm::dvec3 minimum = nodes_[begin].at, maximum = minimum;
        for (size_t k = begin + 1; k < end; ++k) {
            minimum = glm::min(minimum, nodes_[k].at);
            maximum = glm::max(maximum, nodes_[k].at);
        }
        const glm::dvec3 size = maximum - minimum;
        const int axis = size.x >= size.y ? (size.x >= size.z ? 0 : 2) : (size.y >= size.z ? 1 : 2);
        const size_t middle = begin + (end - begin) / 2;
        std::nth_element(nodes_.begin() + long(begin), nodes_.begin() + long(middle), nodes_.begin() + long(end),
                         [axis](const Node& a, const Node& b) {
                             return std::pair(a.at[axis], a.vertex) < std::pair(b.at[axis], b.vertex);
                         });
        nodes_[middle].axis = axis;
        build(begin, middle);
        build(middle + 1, end);
    }

    // As far as the segment goes on a side of a vertex, with `reach` more on either side of the plane between.
    template <class Visit>
    void near(size_t begin, size_t end, const glm::dvec3& from, const glm::dvec3& along, double first, double last,
              double reach, Visit& visit_one) const
    {
        if (begin >= end || !(first <= last)) return;
        const size_t middle = begin + (end - begin) / 2;
        const auto& [p, vertex, axis] = nodes_[middle];
        const double from_plane = p[axis] - from[axis], slope = along[axis];
        // Where the segment is up to `reach` above the plane, and down to `reach` below it.
        double below_first = first, below_last = last, above_first = first, above_last = last;
        if (slope != 0) {
            const double leaves = (from_plane + reach) / slope, enters = (from_plane - reach) / slope;
            (slope > 0 ? below_last : below_first) = slope > 0 ? std::min(last, leaves) : std::max(first, leaves);
            (slope > 0 ? above_first : above_last) = slope > 0 ? std::max(first, enters) : std::min(last, enters);
        } else {
            if (from_plane < -reach) below_last = first - 1;
            if (from_plane > reach) above_last = first - 1;
        }
        near(begin, middle, from, along, below_first, below_last, reach, visit_one);
        visit_one(vertex, p);
        near(middle + 1, end, from, along, above_first, above_last, reach, visit_one);
    }

    std::vector<Node> nodes_;
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
        const NearVertices corners(surface_.vertices, corners_);
        for (uint32_t corner : corners_) {
            if (work_.over()) return 0;
            uint32_t first = corner;
            corners.visit_near(at(corner), at(corner), crack, [&](uint32_t other, const glm::dvec3& there) {
                work_.spend();
                if (other < first && becomes[other] == other && glm::distance(at(corner), there) <= crack &&
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
        const NearVertices corners(surface_.vertices, corners_);
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

    bool first_corner_on(HalfEdge border, const NearVertices& corners, uint32_t& corner, double& share) const
    {
        const glm::dvec3 &a = at(begin(border)), &b = at(end(border)), along = b - a;
        const uint32_t tip = surface_.faces[border.face()].vertex[previous(border.edge())];
        const double length = glm::length(along);
        corners.visit_near(a, b, crack, [&](uint32_t candidate, const glm::dvec3& there) {
            work_.spend(looks_per_corner);
            const glm::dvec3 beside = there - a;
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
