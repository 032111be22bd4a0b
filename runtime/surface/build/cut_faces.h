// Faces that are cut along each other, for imprint.cpp: who was cut into what, which pieces have which vertex, and
// which edges came about by it. Lattice units. Internal to the runtime.
#pragma once

#include "runtime/surface/corner.h"
#include "runtime/surface/surface.h"

#include <glm/glm.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <deque>
#include <set>
#include <span>
#include <utility>
#include <vector>

namespace haptel::runtime {

using Corners = std::array<uint32_t, 3>;
using Edge = std::array<uint32_t, 2>; // waiting to be looked at: the earlier vertex first

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

class CutFaces {
protected:
    // A face each, cut into nothing yet.
    explicit CutFaces(Surface& surface);

    const glm::dvec3& at(uint32_t vertex) const { return surface_.vertices[vertex]; }
    uint32_t part_of(uint32_t piece) const { return surface_.origins[pieces_[piece].root].part; }

    template <class Visit>
    void for_each_edge(uint32_t piece, Visit&& visit) const
    {
        const Corners& v = pieces_[piece].vertex;
        for (uint32_t i = 0; i < 3; ++i) visit(Edge{std::min(v[i], v[next(i)]), std::max(v[i], v[next(i)])});
    }

    uint32_t add_piece(const Corners& v, uint32_t root);
    void forget(uint32_t piece);
    // The whole pieces that have the edge.
    std::vector<uint32_t> pieces_of(const Edge& edge) const;
    uint32_t tip_of(uint32_t piece, const Edge& edge) const;
    uint32_t add_vertex(const glm::dvec3& place);
    // The later of two corners becomes the earlier.
    void weld(uint32_t one, uint32_t other);
    // An edge at a corner beside it; near its ends there is no room for one more. False: it was cut there before. Of a
    // piece as thin as the tolerance either diagonal has a corner beside it, and each cut would bring back the other.
    bool cut_at(const Edge& edge, uint32_t vertex);
    // All pieces that have the edge, in two.
    void cut(const Edge& edge, uint32_t vertex);
    // One piece in three.
    void cut(uint32_t piece, uint32_t vertex);
    template <size_t count>
    void replace(uint32_t piece, const Corners (&by)[count]);
    // Turns edges opposite to the vertex, within the face that they were cut from, until the pieces around it are as
    // fat as can be (Lawson 1977): thin ones would meet others within the tolerance again and again.
    void fatten(uint32_t vertex);
    // Whether the vertices, of an edge or of a piece, are in the plane of a face.
    bool lies_in(std::span<const uint32_t> vertices, uint32_t root) const;
    // The pieces of one face that have the edge.
    std::vector<uint32_t> pieces_of(const Edge& edge, uint32_t root) const;
    // More than zero: `c` lies to the left of the way from a to b, seen against the normal.
    double side(const glm::dvec3& normal, uint32_t a, uint32_t b, uint32_t c) const;
    // The inner edges of the face, right end first, that one between two of its corners crosses; nothing: it crosses
    // another edge or a corner, or ends elsewhere.
    std::vector<Edge> crossed_by(const Edge& edge, uint32_t root) const;
    // Makes the edge one of the pieces that the face was cut into, by turning the inner edges that it crosses (Sloan
    // 1993): cut there they would be turned anew, and crossed anew, without end. False: it could not be.
    bool lay_in(const Edge& edge, uint32_t root);
    // The two pieces at an edge become those at the one that joins their tips.
    void turn(const std::vector<uint32_t>& both, const Edge& from, const Edge& to);
    double area(uint32_t piece) const { return glm::length(across(pieces_[piece].vertex)); }
    glm::dvec3 across(const Corners& v) const { return glm::cross(at(v[1]) - at(v[0]), at(v[2]) - at(v[0])); }
    // Whether both are in one plane.
    bool lie_on_each_other(uint32_t one, uint32_t other) const;
    // Whether the edge came about by cutting faces: each part that has it goes on beyond it in the same face.
    bool is_inner(const Edge& edge) const;
    // Whether both ends are on one face of another part: that is cut along this edge, too, or is about to be.
    bool may_be_common(const Edge& edge, uint32_t part) const;
    // Whether the angles at the two tips are together more than a half turn.
    bool opens_less(uint32_t tip, uint32_t other, const Edge& edge) const;
    bool is_thin(const Corners& v) const;
    bool face_alike(const Corners& a, const Corners& b) const { return glm::dot(across(a), across(b)) > 0; }
    void look_at_edges_of(const Corners& v);

    Surface& surface_;
    double tolerance_;
    std::vector<Piece> pieces_;                    // first the faces as they came
    std::vector<std::vector<uint32_t>> pieces_at_; // whole ones, by vertex
    Queue edges_;                                  // to be looked at
    std::set<Corners> cut_at_;                     // edges, each with the corner that it was cut at
};

} // namespace haptel::runtime
