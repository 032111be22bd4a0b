// Imprints the parts of a joined surface on each other: where they touch or cross within rounding they are given common
// vertices and edges, so that links lead from one part to the other and nothing pierces anything there.
//
// Each edge is held against the faces of the other parts; the lowest features that meet become one, or are cut in a
// new vertex, and the edges that this makes are looked at in their turn. Faces are cut in two or three pieces; corners
// move by corners_reach tolerances at most at a time. Ends when nothing meets any more that is not common, or when it
// was too much: what is left pierces.
#include "runtime/box_tree.h"
#include "runtime/fan.h"
#include "runtime/meeting.h"
#include "runtime/predicates.h"
#include "runtime/surface_build.h"

#include <algorithm>
#include <deque>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <utility>

namespace haptel::runtime {

namespace {

using Corners = std::array<uint32_t, 3>;
using Edge = std::array<uint32_t, 2>; // waiting to be looked at: the earlier vertex first

// What parts that are to meet may miss each other by, in lattice units: what a query of the tree is sure to find, times
// corners_reach; and of the smallest part's size, for small parts among large ones.
constexpr double tolerance_max = 65536, share_of_part = 1e-6;

// More cuts than this for each edge at the start: something goes round in a circle. More pieces looked at: so much lies
// on each other that it takes too long. What is left then pierces, and walls hold it.
constexpr size_t most_cuts = 1000, most_cuts_per_edge = 1, most_looks = 1'000'000, most_looks_per_edge = 200;

struct Box {
    glm::dvec3 minimum, maximum;

    bool meets(const Box& other, double margin) const
    {
        return glm::all(glm::lessThanEqual(minimum - margin, other.maximum)) &&
               glm::all(glm::lessThanEqual(other.minimum - margin, maximum));
    }
};

// A face of the surface as it came, or what was cut from one.
struct Piece {
    Corners vertex;
    uint32_t root;            // the face that it came from
    uint32_t first_child = 0; // of those that it was cut into, in turn
    uint32_t children = 0;    // 0: it is whole
    bool flat = false;        // it lost its area
    bool near_others = false; // a face as it came: near other parts
    uint64_t seen = 0;        // by which query
    Box box;                  // as it was made; corners move by little
};

// Edges in the order in which they came, each once.
class Queue {
public:
    void insert(const Edge& edge)
    {
        if (waiting_.insert(edge).second) order_.push_back(edge);
    }
    bool empty() const { return order_.empty(); }
    size_t size() const { return order_.size(); }
    Edge first() const { return order_.front(); }
    void drop_first()
    {
        waiting_.erase(order_.front());
        order_.pop_front();
    }
    auto begin() const { return order_.begin(); }
    auto end() const { return order_.end(); }

private:
    std::set<Edge> waiting_;
    std::deque<Edge> order_;
};

class Imprint final : public SegmentVisitor {
public:
    Imprint(Surface& surface, const BoxTree& tree) : surface_(surface), tree_(tree), pieces_at_(surface.vertices.size())
    {
        for (uint32_t f = 0; f < surface.faces.size(); ++f) add_piece(surface.faces[f].vertex, f);
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
                while (!edges_.empty() && !cut_first(edges_.first())) edges_.drop_first();
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

    const glm::dvec3& at(uint32_t vertex) const { return surface_.vertices[vertex]; }
    uint32_t part_of(uint32_t piece) const { return surface_.origins[pieces_[piece].root].part; }

    void find_near_others()
    {
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

    uint32_t add_piece(const Corners& v, uint32_t root)
    {
        Piece piece{v, root, 0, 0, v[0] == v[1] || v[1] == v[2] || v[2] == v[0], false, 0, {}};
        piece.box = {glm::min(glm::min(at(v[0]), at(v[1])), at(v[2])),
                     glm::max(glm::max(at(v[0]), at(v[1])), at(v[2]))};
        const auto index = uint32_t(pieces_.size());
        pieces_.push_back(piece);
        for (uint32_t corner : v)
            if (!piece.flat) pieces_at_[corner].push_back(index);
        return index;
    }

    void forget(uint32_t piece)
    {
        for (uint32_t corner : pieces_[piece].vertex) std::erase(pieces_at_[corner], piece);
    }

    // The whole pieces that have the edge.
    std::vector<uint32_t> pieces_of(const Edge& edge) const
    {
        std::vector<uint32_t> found;
        for (uint32_t piece : pieces_at_[edge[0]]) {
            const Corners& v = pieces_[piece].vertex;
            if (std::find(v.begin(), v.end(), edge[1]) != v.end()) found.push_back(piece);
        }
        return found;
    }

    uint32_t tip_of(uint32_t piece, const Edge& edge) const
    {
        const Corners& v = pieces_[piece].vertex;
        return *std::find_if(v.begin(), v.end(), [&](uint32_t i) { return i != edge[0] && i != edge[1]; });
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
        std::sort(near_.begin(), near_.end()); // the tree has no order of its own
    }

    double visit(uint32_t face) noexcept override
    {
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

    uint32_t add_vertex(const glm::dvec3& place)
    {
        constexpr double spacing = Lattice::vertex_spacing;
        surface_.vertices.push_back(glm::round(place / spacing) * spacing + 0.0);
        pieces_at_.emplace_back();
        return uint32_t(surface_.vertices.size() - 1);
    }

    // The later of two corners becomes the earlier.
    void weld(uint32_t one, uint32_t other)
    {
        const auto [kept, gone] = std::minmax(one, other);
        for (uint32_t piece : std::vector<uint32_t>(pieces_at_[gone])) {
            forget(piece);
            Corners& v = pieces_[piece].vertex;
            pieces_[piece].flat = std::find(v.begin(), v.end(), kept) != v.end();
            std::replace(v.begin(), v.end(), gone, kept);
            if (pieces_[piece].flat) continue;
            for (uint32_t corner : v) pieces_at_[corner].push_back(piece);
            look_at_edges_of(v);
        }
    }

    // An edge at a corner beside it; near its ends there is no room for one more. False: it was cut there before. Of a
    // piece as thin as the tolerance either diagonal has a corner beside it, and each cut would bring back the other.
    bool cut_at(const Edge& edge, uint32_t vertex)
    {
        if (!cut_at_.insert({std::min(edge[0], edge[1]), std::max(edge[0], edge[1]), vertex}).second) return false;
        for (uint32_t end : edge)
            if (glm::distance(at(end), at(vertex)) < corners_reach * tolerance_) {
                weld(end, vertex);
                return true;
            }
        cut(edge, vertex);
        return true;
    }

    // All pieces that have the edge, in two.
    void cut(const Edge& edge, uint32_t vertex)
    {
        for (uint32_t piece : pieces_of(edge)) {
            Corners halves[2] = {pieces_[piece].vertex, pieces_[piece].vertex};
            std::replace(halves[0].begin(), halves[0].end(), edge[0], vertex);
            std::replace(halves[1].begin(), halves[1].end(), edge[1], vertex);
            replace(piece, halves);
        }
        fatten(vertex);
    }

    // One piece in three.
    void cut(uint32_t piece, uint32_t vertex)
    {
        if (pieces_[piece].children > 0) return; // along with the edge
        Corners thirds[3];
        for (uint32_t i = 0; i < 3; ++i) {
            thirds[i] = pieces_[piece].vertex;
            thirds[i][i] = vertex;
        }
        replace(piece, thirds);
        fatten(vertex);
    }

    template <size_t count>
    void replace(uint32_t piece, const Corners (&by)[count])
    {
        forget(piece);
        const auto first = uint32_t(pieces_.size());
        for (const Corners& corners : by) {
            add_piece(corners, pieces_[piece].root);
            look_at_edges_of(corners);
        }
        pieces_[piece].first_child = first;
        pieces_[piece].children = count;
    }

    // Turns edges opposite to the vertex, within the face that they were cut from, until the pieces around it are as
    // fat as can be (Lawson 1977): thin ones would meet others within the tolerance again and again.
    void fatten(uint32_t vertex)
    {
        std::vector<uint32_t> around(pieces_at_[vertex]);
        while (!around.empty()) {
            const uint32_t piece = around.back();
            around.pop_back();
            if (pieces_[piece].children > 0 || pieces_[piece].flat) continue;
            Corners v = pieces_[piece].vertex; // turned so that the vertex comes first
            while (v[0] != vertex) std::rotate(v.begin(), v.begin() + 1, v.end());
            const Edge edge{v[1], v[2]};
            const std::vector<uint32_t> both = pieces_of(edge);
            if (both.size() != 2 || pieces_[both[0]].root != pieces_[both[1]].root) continue;
            if (may_be_common(edge, part_of(piece))) continue;
            const uint32_t tip = tip_of(both[both[0] == piece], edge);
            if (!pieces_of({vertex, tip}).empty()) continue; // it would be there twice
            const Corners turned[2] = {{vertex, v[1], tip}, {vertex, tip, v[2]}};
            if (!opens_less(vertex, tip, edge) || !face_alike(turned[0], v) || !face_alike(turned[1], v) ||
                is_thin(turned[0]) || is_thin(turned[1]))
                continue;
            forget(both[0]);
            forget(both[1]);
            const auto first = uint32_t(pieces_.size());
            for (const Corners& corners : turned) around.push_back(add_piece(corners, pieces_[piece].root));
            for (uint32_t old : both) pieces_[old].first_child = first, pieces_[old].children = 2;
            edges_.insert({std::min(vertex, tip), std::max(vertex, tip)});
        }
    }

    bool lies_in(const Edge& edge, uint32_t root) const
    {
        const Corners& v = pieces_[root].vertex;
        const glm::dvec3 normal = glm::normalize(across(v));
        return std::all_of(edge.begin(), edge.end(), [&](uint32_t end) {
            return std::abs(glm::dot(at(end) - at(v[0]), normal)) <= corners_reach * tolerance_;
        });
    }

    // The pieces of one face that have the edge.
    std::vector<uint32_t> pieces_of(const Edge& edge, uint32_t root) const
    {
        std::vector<uint32_t> found = pieces_of(edge);
        std::erase_if(found, [&](uint32_t piece) { return pieces_[piece].root != root; });
        return found;
    }

    // More than zero: `c` lies to the left of the way from a to b, seen against the normal.
    double side(const glm::dvec3& normal, uint32_t a, uint32_t b, uint32_t c) const
    {
        return glm::dot(glm::cross(at(b) - at(a), at(c) - at(a)), normal);
    }

    // The inner edges of the face, right end first, that one between two of its corners crosses; nothing: it crosses
    // another edge or a corner, or ends elsewhere.
    std::vector<Edge> crossed_by(const Edge& edge, uint32_t root) const
    {
        const glm::dvec3 normal = across(pieces_[root].vertex);
        const auto left = [&](uint32_t vertex) { return side(normal, edge[0], edge[1], vertex); };
        std::vector<Edge> crossed;
        for (uint32_t piece : pieces_at_[edge[0]]) {
            if (pieces_[piece].root != root) continue;
            Corners v = pieces_[piece].vertex;
            while (v[0] != edge[0]) std::rotate(v.begin(), v.begin() + 1, v.end());
            if (left(v[1]) < 0 && left(v[2]) > 0 && side(normal, v[1], v[2], edge[1]) < 0)
                crossed.push_back({v[1], v[2]});
        }
        if (crossed.size() != 1) return {};
        for (uint32_t before = edge[0]; crossed.size() < pieces_.size();) {
            const Edge last = crossed.back();
            const std::vector<uint32_t> both = pieces_of(last, root);
            if (both.size() != 2 || !is_inner(last)) return {};
            const uint32_t one = tip_of(both[0], last), tip = one == before ? tip_of(both[1], last) : one;
            if (tip == edge[1]) return crossed;
            if (left(tip) == 0) return {};
            before = last[left(tip) > 0];
            crossed.push_back(left(tip) < 0 ? Edge{tip, last[1]} : Edge{last[0], tip});
        }
        return {};
    }

    // Makes the edge one of the pieces that the face was cut into, by turning the inner edges that it crosses (Sloan
    // 1993): cut there they would be turned anew, and crossed anew, without end. False: it could not be.
    bool lay_in(const Edge& edge, uint32_t root)
    {
        const glm::dvec3 normal = across(pieces_[root].vertex);
        const auto parts = [&](const Edge& by, uint32_t p, uint32_t q) {
            return side(normal, by[0], by[1], p) * side(normal, by[0], by[1], q) < 0;
        };
        std::vector<Edge> crossed = crossed_by(edge, root);
        if (crossed.empty()) return false;
        const size_t most = crossed.size() + 4 * crossed.size() * crossed.size() + 4;
        for (size_t k = 0; k < crossed.size(); ++k) {
            const Edge from = crossed[k];
            const std::vector<uint32_t> both = pieces_of(from, root);
            if (both.size() != 2 || crossed.size() > most) return false;
            const Edge to{tip_of(both[0], from), tip_of(both[1], from)};
            if (parts(to, from[0], from[1]) && pieces_of(to, root).empty() && !is_thin({to[0], to[1], from[0]}) &&
                !is_thin({to[0], to[1], from[1]})) {
                turn(both, from, to);
                const bool ends = to[0] == edge[0] || to[1] == edge[0] || to[0] == edge[1] || to[1] == edge[1];
                if (!ends && parts(edge, to[0], to[1])) crossed.push_back(to);
            } else {
                crossed.push_back(from); // when others are out of the way
            }
        }
        return true;
    }

    // The two pieces at an edge become those at the one that joins their tips.
    void turn(const std::vector<uint32_t>& both, const Edge& from, const Edge& to)
    {
        Corners turned[2] = {pieces_[both[0]].vertex, pieces_[both[1]].vertex};
        std::replace(turned[0].begin(), turned[0].end(), from[0], to[1]);
        std::replace(turned[1].begin(), turned[1].end(), from[1], to[0]);
        forget(both[0]);
        forget(both[1]);
        const auto first = uint32_t(pieces_.size());
        for (const Corners& corners : turned) add_piece(corners, pieces_[both[0]].root);
        for (uint32_t old : both) pieces_[old].first_child = first, pieces_[old].children = 2;
        edges_.insert({std::min(to[0], to[1]), std::max(to[0], to[1])});
    }

    template <class Visit>
    void for_each_edge(uint32_t piece, Visit&& visit) const
    {
        const Corners& v = pieces_[piece].vertex;
        for (uint32_t i = 0; i < 3; ++i) visit(Edge{std::min(v[i], v[next(i)]), std::max(v[i], v[next(i)])});
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

    double area(uint32_t piece) const { return glm::length(across(pieces_[piece].vertex)); }
    glm::dvec3 across(const Corners& v) const { return glm::cross(at(v[1]) - at(v[0]), at(v[2]) - at(v[0])); }

    // Whether the middle of the piece is within the outline of the face as it came.
    bool is_on(uint32_t face, uint32_t piece) const
    {
        const Corners &v = pieces_[face].vertex, &p = pieces_[piece].vertex;
        const glm::dvec3 middle = (at(p[0]) + at(p[1]) + at(p[2])) / 3.0, normal = across(v);
        for (uint32_t i = 0; i < 3; ++i)
            if (glm::dot(glm::cross(normal, at(v[next(i)]) - at(v[i])), middle - at(v[i])) <= 0) return false;
        return true;
    }

    // Whether both are in one plane.
    bool lie_on_each_other(uint32_t one, uint32_t other) const
    {
        const auto is_in_plane = [&](uint32_t face, uint32_t piece) {
            const Corners& v = pieces_[face].vertex;
            const glm::dvec3 normal = glm::normalize(across(v));
            for (uint32_t corner : pieces_[piece].vertex)
                if (std::abs(glm::dot(at(corner) - at(v[0]), normal)) > corners_reach * tolerance_) return false;
            return true;
        };
        const uint32_t a = pieces_[one].root, b = pieces_[other].root;
        return is_in_plane(a, other) && is_in_plane(b, one);
    }

    // Whether the edge came about by cutting faces: each part that has it goes on beyond it in the same face.
    bool is_inner(const Edge& edge) const
    {
        const std::vector<uint32_t> all = pieces_of(edge);
        return std::all_of(all.begin(), all.end(), [&](uint32_t one) {
            uint32_t of_part = 0, of_root = 0;
            for (uint32_t other : all) {
                of_part += part_of(other) == part_of(one);
                of_root += pieces_[other].root == pieces_[one].root;
            }
            return of_part == 2 && of_root == 2;
        });
    }

    // Whether both ends are on one face of another part: that is cut along this edge, too, or is about to be.
    bool may_be_common(const Edge& edge, uint32_t part) const
    {
        for (uint32_t one : pieces_at_[edge[0]])
            for (uint32_t other : pieces_at_[edge[1]])
                if (pieces_[one].root == pieces_[other].root && part_of(one) != part) return true;
        return false;
    }

    // Whether the angles at the two tips are together more than a half turn.
    bool opens_less(uint32_t tip, uint32_t other, const Edge& edge) const
    {
        const auto angle = [&](uint32_t i) {
            const glm::dvec3 a = at(edge[0]) - at(i), b = at(edge[1]) - at(i);
            return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
        };
        return angle(tip) + angle(other) > 3.14159265358979 + 1e-6;
    }
    bool is_thin(const Corners& v) const
    {
        for (uint32_t i = 0; i < 3; ++i)
            if (is_beside(at(v[i]), at(v[next(i)]), at(v[previous(i)]), 1.5 * tolerance_)) return true;
        return false;
    }
    bool face_alike(const Corners& a, const Corners& b) const { return glm::dot(across(a), across(b)) > 0; }

    void look_at_edges_of(const Corners& v)
    {
        for (uint32_t i = 0; i < 3; ++i) edges_.insert({std::min(v[i], v[next(i)]), std::max(v[i], v[next(i)])});
    }

    Surface& surface_;
    const BoxTree& tree_; // of the faces as they came
    double tolerance_ = tolerance_max;
    std::vector<Piece> pieces_;                    // first the faces as they came
    std::vector<std::vector<uint32_t>> pieces_at_; // whole ones, by vertex
    Queue edges_;                                  // to be looked at

    Now now_ = Now::corners;
    std::set<std::pair<Edge, uint32_t>> not_laid_; // edges that could not be laid in a face
    std::set<Corners> cut_at_;                     // edges, each with the corner that it was cut at

    uint64_t query_ = 0;
    size_t looks_ = 0;            // pieces held against edges
    Box box_{};                   // of the edge looked at
    std::vector<uint32_t> parts_; // that have it
    std::vector<uint32_t> near_;
};

} // namespace

void imprint(Surface& surface, std::string& error)
{
    const std::unique_ptr<const BoxTree> tree = BoxTree::build(surface.vertices, surface.faces, error);
    if (!tree) return;
    Imprint imprint(surface, *tree);
    if (imprint.run()) imprint.drop_covered(); // else what covers each other has not the same outlines
    imprint.write_faces();
    drop_flat_faces(surface);
    drop_repeated_faces(surface);
}

std::vector<std::pair<uint32_t, uint32_t>> meeting_parts(Surface& surface, std::string& error)
{
    std::vector<std::pair<uint32_t, uint32_t>> pairs;
    const std::unique_ptr<const BoxTree> tree = BoxTree::build(surface.vertices, surface.faces, error);
    if (!tree) return pairs;
    Imprint(surface, *tree).for_each_meeting([&](uint32_t one, uint32_t other) {
        pairs.push_back(std::minmax(one, other));
    });
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    return pairs;
}

} // namespace haptel::runtime
