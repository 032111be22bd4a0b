#include "runtime/surface/build/cut_faces.h"

#include "runtime/surface/build/meeting.h"

#include <cmath>

namespace haptel::runtime {

CutFaces::CutFaces(Surface& surface) : surface_(surface), tolerance_(0), pieces_at_(surface.vertices.size())
{
    for (uint32_t f = 0; f < surface.faces.size(); ++f) add_piece(surface.faces[f].vertex, f);
}

uint32_t CutFaces::add_piece(const Corners& v, uint32_t root)
{
    Piece piece{v, root, 0, 0, v[0] == v[1] || v[1] == v[2] || v[2] == v[0], false, 0, {}};
    piece.box = {glm::min(glm::min(at(v[0]), at(v[1])), at(v[2])), glm::max(glm::max(at(v[0]), at(v[1])), at(v[2]))};
    const auto index = uint32_t(pieces_.size());
    pieces_.push_back(piece);
    for (uint32_t corner : v)
        if (!piece.flat) pieces_at_[corner].push_back(index);
    return index;
}

void CutFaces::forget(uint32_t piece)
{
    for (uint32_t corner : pieces_[piece].vertex) std::erase(pieces_at_[corner], piece);
}

std::vector<uint32_t> CutFaces::pieces_of(const Edge& edge) const
{
    std::vector<uint32_t> found;
    for (uint32_t piece : pieces_at_[edge[0]]) {
        const Corners& v = pieces_[piece].vertex;
        if (std::find(v.begin(), v.end(), edge[1]) != v.end()) found.push_back(piece);
    }
    return found;
}

uint32_t CutFaces::tip_of(uint32_t piece, const Edge& edge) const
{
    const Corners& v = pieces_[piece].vertex;
    return *std::find_if(v.begin(), v.end(), [&](uint32_t i) { return i != edge[0] && i != edge[1]; });
}

uint32_t CutFaces::add_vertex(const glm::dvec3& place)
{
    constexpr double spacing = Lattice::vertex_spacing;
    surface_.vertices.push_back(glm::round(place / spacing) * spacing + 0.0);
    pieces_at_.emplace_back();
    return uint32_t(surface_.vertices.size() - 1);
}

void CutFaces::weld(uint32_t one, uint32_t other)
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

bool CutFaces::cut_at(const Edge& edge, uint32_t vertex)
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

void CutFaces::cut(const Edge& edge, uint32_t vertex)
{
    for (uint32_t piece : pieces_of(edge)) {
        Corners halves[2] = {pieces_[piece].vertex, pieces_[piece].vertex};
        std::replace(halves[0].begin(), halves[0].end(), edge[0], vertex);
        std::replace(halves[1].begin(), halves[1].end(), edge[1], vertex);
        replace(piece, halves);
    }
    fatten(vertex);
}

void CutFaces::cut(uint32_t piece, uint32_t vertex)
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
void CutFaces::replace(uint32_t piece, const Corners (&by)[count])
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

void CutFaces::fatten(uint32_t vertex)
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
        turn(both, edge, {tip_of(both[0], edge), tip_of(both[1], edge)});
        around.push_back(uint32_t(pieces_.size() - 2));
        around.push_back(uint32_t(pieces_.size() - 1));
    }
}

bool CutFaces::lies_in(std::span<const uint32_t> vertices, uint32_t root) const
{
    const Corners& v = pieces_[root].vertex;
    const glm::dvec3 normal = glm::normalize(across(v));
    return std::all_of(vertices.begin(), vertices.end(), [&](uint32_t vertex) {
        return std::abs(glm::dot(at(vertex) - at(v[0]), normal)) <= corners_reach * tolerance_;
    });
}

std::vector<uint32_t> CutFaces::pieces_of(const Edge& edge, uint32_t root) const
{
    std::vector<uint32_t> found = pieces_of(edge);
    std::erase_if(found, [&](uint32_t piece) { return pieces_[piece].root != root; });
    return found;
}

double CutFaces::side(const glm::dvec3& normal, uint32_t a, uint32_t b, uint32_t c) const
{
    return glm::dot(glm::cross(at(b) - at(a), at(c) - at(a)), normal);
}

std::vector<Edge> CutFaces::crossed_by(const Edge& edge, uint32_t root) const
{
    const glm::dvec3 normal = across(pieces_[root].vertex);
    const auto left = [&](uint32_t vertex) { return side(normal, edge[0], edge[1], vertex); };
    std::vector<Edge> crossed;
    for (uint32_t piece : pieces_at_[edge[0]]) {
        if (pieces_[piece].root != root) continue;
        Corners v = pieces_[piece].vertex;
        while (v[0] != edge[0]) std::rotate(v.begin(), v.begin() + 1, v.end());
        if (left(v[1]) < 0 && left(v[2]) > 0 && side(normal, v[1], v[2], edge[1]) < 0) crossed.push_back({v[1], v[2]});
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

bool CutFaces::lay_in(const Edge& edge, uint32_t root)
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

void CutFaces::turn(const std::vector<uint32_t>& both, const Edge& from, const Edge& to)
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

bool CutFaces::lie_on_each_other(uint32_t one, uint32_t other) const
{
    return lies_in(pieces_[other].vertex, pieces_[one].root) && lies_in(pieces_[one].vertex, pieces_[other].root);
}

bool CutFaces::is_inner(const Edge& edge) const
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

bool CutFaces::may_be_common(const Edge& edge, uint32_t part) const
{
    for (uint32_t one : pieces_at_[edge[0]])
        for (uint32_t other : pieces_at_[edge[1]])
            if (pieces_[one].root == pieces_[other].root && part_of(one) != part) return true;
    return false;
}

bool CutFaces::opens_less(uint32_t tip, uint32_t other, const Edge& edge) const
{
    const auto angle = [&](uint32_t i) {
        const glm::dvec3 a = at(edge[0]) - at(i), b = at(edge[1]) - at(i);
        return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
    };
    return angle(tip) + angle(other) > 3.14159265358979 + 1e-6;
}

bool CutFaces::is_thin(const Corners& v) const
{
    for (uint32_t i = 0; i < 3; ++i)
        if (is_beside(at(v[i]), at(v[next(i)]), at(v[previous(i)]), 1.5 * tolerance_)) return true;
    return false;
}

void CutFaces::look_at_edges_of(const Corners& v)
{
    for (uint32_t i = 0; i < 3; ++i) edges_.insert({std::min(v[i], v[next(i)]), std::max(v[i], v[next(i)])});
}

} // namespace haptel::runtime
