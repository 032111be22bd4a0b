// Imprints the parts of a joined surface on each other: where they touch or cross within rounding they are given common
// vertices and edges, so that links lead from one part to the other and nothing pierces anything there.
//
// Each edge is held against the faces of the other parts; the lowest features that meet become one, or are cut in a
// new vertex, and the edges that this makes are looked at in their turn. Faces are cut in two or three pieces; corners
// move by corners_reach tolerances at most at a time. Ends when nothing meets any more that is not common, or when it
// was too much: what is left pierces.
#include "runtime/geometry/predicates.h"
#include "runtime/surface/box_tree.h"
#include "runtime/surface/build/build.h"
#include "runtime/surface/build/cut_faces.h"
#include "runtime/surface/build/meeting.h"
#include "runtime/surface/corner.h"

#include <algorithm>
#include <limits>
#include <map>
#include <set>
#include <utility>

namespace haptel::runtime {

namespace {

// What parts that are to meet may miss each other by, in lattice units: what a query of the tree is sure to find, times
// corners_reach; and of the smallest part's size, for small parts among large ones.
constexpr double tolerance_max = 65536, share_of_part = 1e-6;

// More cuts than this for each edge at the start: something goes round in a circle. More pieces looked at: so much lies
// on each other that it takes too long. What is left then pierces, and walls hold it.
constexpr size_t most_cuts = 1000, most_cuts_per_edge = 1, most_looks = 1'000'000, most_looks_per_edge = 200;

// What they take, in looks.
constexpr size_t looks_per_cut = 100, looks_per_meeting = 2;

class Imprint final : public SegmentVisitor, private CutFaces {
public:
    Imprint(Surface& surface, const BoxTree& tree, BuildWork& work) : CutFaces(surface), tree_(tree), work_(work)
    {
        find_near_others();
    }

    // The meetings that there are now, without changing anything: visit(part, other part).
    template <class Visit>
    void for_each_meeting(Visit&& visit)
    {
        for (const Piece& piece : pieces_)
            if (piece.near_others) look_at_edges_of(piece.vertex);
        std::set<std::pair<uint32_t, uint32_t>> known;
        for (const Edge& edge : edges_) {
            if (work_.over()) return;
            find(edge);
            for (uint32_t piece : near_) {
                const auto is_known = [&](uint32_t part) { return known.contains({part, part_of(piece)}); };
                if (std::all_of(parts_.begin(), parts_.end(), is_known) ||
                    meeting_of(surface_.vertices, edge, pieces_[piece].vertex, tolerance_).of == Meeting::Of::nothing)
                    continue;
                for (uint32_t part : parts_)
                    if (known.insert({part, part_of(piece)}).second) visit(part, part_of(piece));
            }
        }
        for (const auto& pieces : pieces_at_)
            for (uint32_t piece : pieces)
                if (part_of(piece) != part_of(pieces.front())) visit(part_of(pieces.front()), part_of(piece));
    }

    // Corners first, then the parts' own edges, then those that cutting made: or edges would be cut ever closer to a
    // corner that is not there yet. False: it was too much.
    bool run()
    {
        for (const Now now : {Now::corners, Now::own_edges, Now::all}) {
            now_ = now;
            for (const Piece& piece : pieces_)
                if (piece.children == 0 && !piece.flat && pieces_[piece.root].near_others)
                    look_at_edges_of(piece.vertex);
            const size_t most = most_cuts + most_cuts_per_edge * edges_.size();
            const size_t most_seen = looks_ + most_looks + most_looks_per_edge * edges_.size();
            for (size_t cuts = 0; !edges_.empty(); ++cuts) {
                if (cuts == most || looks_ > most_seen) return false;
                if (!work_.spend(looks_per_cut)) return false;
                while (!edges_.empty() && !work_.over() && !cut_first(edges_.first())) edges_.drop_first();
            }
        }
        return true;
    }

    // Of what lies on each other in several parts only the first one's is left. Edges of parts that do are imprinted on
    // each other, so that cells come about that both cover, each with other inner edges.
    void drop_covered()
    {
        std::map<uint32_t, std::vector<uint32_t>> pieces_of_root;
        for (uint32_t i = 0; i < pieces_.size(); ++i)
            if (pieces_[i].children == 0 && !pieces_[i].flat) pieces_of_root[pieces_[i].root].push_back(i);
        for (const auto& [root, pieces] : pieces_of_root) {
            std::set<uint32_t> others;
            for (uint32_t piece : pieces)
                for_each_edge(piece, [&](const Edge& edge) {
                    for (uint32_t neighbour : pieces_of(edge))
                        if (part_of(neighbour) < part_of(piece) && lie_on_each_other(piece, neighbour))
                            others.insert(pieces_[neighbour].root);
                });
            for (uint32_t other : others) drop_covered_by(other, pieces);
        }
    }

    // What the faces were cut into, in their order.
    void write_faces()
    {
        std::vector<uint32_t> whole;
        for (uint32_t i = 0; i < pieces_.size(); ++i)
            if (pieces_[i].children == 0 && !pieces_[i].flat) whole.push_back(i);
        std::stable_sort(whole.begin(), whole.end(),
                         [&](uint32_t a, uint32_t b) { return pieces_[a].root < pieces_[b].root; });
        const std::vector<Origin> origins = std::move(surface_.origins);
        surface_.faces.clear();
        surface_.origins.clear();
        for (uint32_t i : whole) {
            surface_.faces.emplace_back().vertex = pieces_[i].vertex;
            surface_.origins.push_back(origins[pieces_[i].root]);
        }
    }

private:
    enum class Now { corners, own_edges, all }; // what is being imprinted

    void find_near_others()
    {
        tolerance_ = tolerance_max;
        constexpr double infinity = std::numeric_limits<double>::infinity();
        std::vector<Box> boxes; // of the parts
        for (uint32_t f = 0; f < pieces_.size(); ++f) {
            const uint32_t part = part_of(f);
            if (part >= boxes.size()) boxes.resize(part + 1, {glm::dvec3(infinity), glm::dvec3(-infinity)});
            boxes[part].minimum = glm::min(boxes[part].minimum, pieces_[f].box.minimum);
            boxes[part].maximum = glm::max(boxes[part].maximum, pieces_[f].box.maximum);
        }
        for (const Box& box : boxes)
            if (box.minimum.x < infinity)
                tolerance_ = std::min(tolerance_, share_of_part * glm::distance(box.minimum, box.maximum));
        for (uint32_t f = 0; f < pieces_.size(); ++f) {
            bool& near = pieces_[f].near_others;
            for (uint32_t part = 0; part < boxes.size() && !near; ++part)
                near = part != part_of(f) && pieces_[f].box.meets(boxes[part], corners_reach * tolerance_);
        }
    }

    // Into near_ what of other parts lies about the edge, into parts_ the parts that have it.
    void find(const Edge& edge)
    {
        near_.clear();
        parts_.clear();
        ++query_;
        for (uint32_t piece : pieces_of(edge)) parts_.push_back(part_of(piece));
        box_ = {glm::min(at(edge[0]), at(edge[1])), glm::max(at(edge[0]), at(edge[1]))};
        if (!parts_.empty()) tree_.segment(at(edge[0]), at(edge[1]), *this);
        looks_ += near_.size();
        work_.spend(looks_per_meeting * near_.size());
        std::sort(near_.begin(), near_.end()); // the tree has no order of its own
    }

    double visit(uint32_t face) noexcept override
    {
        if (!work_.spend()) return 0;
        if (std::find(parts_.begin(), parts_.end(), part_of(face)) == parts_.end()) collect(face);
        return 1.0;
    }

    void collect(uint32_t piece)
    {
        Piece& data = pieces_[piece];
        if (data.flat || data.seen == query_ || !data.box.meets(box_, corners_reach * tolerance_)) return;
        data.seen = query_;
        if (data.children == 0) near_.push_back(piece);
        for (uint32_t k = 0; k < data.children; ++k) collect(data.first_child + k);
    }

    // False: the edge meets nothing.
    bool cut_first(const Edge& edge)
    {
        find(edge);
        for (uint32_t piece : near_) {
            const Corners v = pieces_[piece].vertex;
            const Meeting meeting = meeting_of(surface_.vertices, edge, v, tolerance_);
            const Edge other{v[meeting.index], v[next(meeting.index)]};
            const bool crossing = meeting.of == Meeting::Of::edges || meeting.of == Meeting::Of::edge_and_face;
            if (crossing && now_ == Now::corners) continue;
            if (crossing && now_ == Now::own_edges &&
                (is_inner(edge) || (meeting.of == Meeting::Of::edges && is_inner(other))))
                continue;
            if (meeting.of == Meeting::Of::edges) {
                const bool inner = is_inner(edge), other_inner = is_inner(other);
                if (inner && other_inner && lie_on_each_other(pieces_of(edge).front(), piece))
                    continue; // neither is of a part's own: see drop_covered()
                // An inner edge needs no vertex where it crosses a part's own, it is turned out of the way.
                const uint32_t root = pieces_[inner ? pieces_of(edge).front() : piece].root;
                if (inner && !other_inner && lies_in(other, root)) {
                    edges_.insert({std::min(other[0], other[1]), std::max(other[0], other[1])});
                    continue; // when it is the other's turn
                }
                if (!inner && other_inner && lies_in(edge, root) && !not_laid_.contains({edge, root})) {
                    if (!lay_in(edge, root)) not_laid_.insert({edge, root});
                    return true;
                }
            }
            switch (meeting.of) {
            case Meeting::Of::nothing: continue;
            case Meeting::Of::corners: weld(edge[meeting.end], v[meeting.index]); break;
            case Meeting::Of::corner_and_edge:
                if (!cut_at(other, edge[meeting.end])) continue;
                break;
            case Meeting::Of::edge_and_corner:
                if (!cut_at(edge, v[meeting.index])) continue;
                break;
            case Meeting::Of::corner_and_face: cut(piece, edge[meeting.end]); break;
            case Meeting::Of::edges: {
                const uint32_t vertex = add_vertex(meeting.at);
                cut(edge, vertex);
                cut(other, vertex);
                break;
            }
            case Meeting::Of::edge_and_face: {
                const uint32_t vertex = add_vertex(meeting.at);
                cut(edge, vertex);
                cut(piece, vertex);
                break;
            }
            }
            return true;
        }
        return false;
    }

    // The pieces in cells, parted by the edges that they have in common with the other face: cells within that go.
    void drop_covered_by(uint32_t other, const std::vector<uint32_t>& pieces)
    {
        const auto is_common = [&](const Edge& edge) {
            const std::vector<uint32_t> all = pieces_of(edge);
            return std::any_of(all.begin(), all.end(), [&](uint32_t i) { return pieces_[i].root == other; });
        };
        std::set<uint32_t> left(pieces.begin(), pieces.end());
        while (!left.empty()) {
            std::vector<uint32_t> cell{*left.begin()};
            left.erase(left.begin());
            bool closed = true;
            for (size_t k = 0; k < cell.size(); ++k)
                for_each_edge(cell[k], [&](const Edge& edge) {
                    if (is_common(edge)) return;
                    for (uint32_t neighbour : pieces_of(edge)) {
                        if (left.erase(neighbour)) cell.push_back(neighbour);
                        closed = closed && pieces_[neighbour].root == pieces_[cell[k]].root;
                    }
                });
            const uint32_t largest =
                *std::max_element(cell.begin(), cell.end(), [&](uint32_t a, uint32_t b) { return area(a) < area(b); });
            if (!closed || !is_on(other, largest)) continue;
            for (uint32_t piece : cell) {
                forget(piece);
                pieces_[piece].flat = true;
            }
        }
    }

    // Whether the middle of the piece is within the outline of the face as it came.
    bool is_on(uint32_t face, uint32_t piece) const
    {
        const Corners &v = pieces_[face].vertex, &p = pieces_[piece].vertex;
        const glm::dvec3 middle = (at(p[0]) + at(p[1]) + at(p[2])) / 3.0, normal = across(v);
        for (uint32_t i = 0; i < 3; ++i)
            if (glm::dot(glm::cross(normal, at(v[next(i)]) - at(v[i])), middle - at(v[i])) <= 0) return false;
        return true;
    }

    const BoxTree& tree_; // of the faces as they came
    BuildWork& work_;

    Now now_ = Now::corners;
    std::set<std::pair<Edge, uint32_t>> not_laid_; // edges that could not be laid in a face

    uint64_t query_ = 0;
    size_t looks_ = 0;            // pieces held against edges
    Box box_{};                   // of the edge looked at
    std::vector<uint32_t> parts_; // that have it
    std::vector<uint32_t> near_;
};

} // namespace

void imprint(Surface& surface, std::string& error, BuildWork& work)
{
    if (!work.begin("where its parts touch and cross")) return;
    const std::unique_ptr<const BoxTree> tree = BoxTree::build(surface.vertices, surface.faces, error);
    if (!tree) return;
    Imprint imprint(surface, *tree, work);
    const bool is_whole = imprint.run();
    if (work.over()) return;
    if (is_whole) imprint.drop_covered(); // else what covers each other has not the same outlines
    imprint.write_faces();
    drop_flat_faces(surface);
    drop_repeated_faces(surface);
}

std::vector<std::pair<uint32_t, uint32_t>> meeting_parts(Surface& surface, std::string& error, BuildWork& work)
{
    std::vector<std::pair<uint32_t, uint32_t>> pairs;
    const std::unique_ptr<const BoxTree> tree = BoxTree::build(surface.vertices, surface.faces, error);
    if (!tree || !work.begin("which of its parts meet")) return pairs;
    Imprint(surface, *tree, work).for_each_meeting([&](uint32_t one, uint32_t other) {
        pairs.push_back(std::minmax(one, other));
    });
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    return pairs;
}

} // namespace haptel::runtime
