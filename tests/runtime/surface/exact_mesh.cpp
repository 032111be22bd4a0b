#include "tests/runtime/surface/exact_mesh.h"

#include "tests/runtime/geometry/big_integer.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace haptel::test {

using glm::dvec3;

namespace {

constexpr double fine = 1024; // parts of a unit that points are given in

struct BigVector {
    BigInteger x, y, z;
};

BigVector big(const dvec3& v)
{
    return {int64_t(v.x * fine), int64_t(v.y * fine), int64_t(v.z * fine)};
}
BigVector operator-(const BigVector& a, const BigVector& b)
{
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
BigVector cross(const BigVector& a, const BigVector& b)
{
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
BigInteger dot(const BigVector& a, const BigVector& b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

// Everything times 2^1344, so that e, e^2 and e^3 are whole.
constexpr size_t words = 14;
BigVector scaled(const dvec3& v)
{
    const BigVector w = big(v);
    return {w.x.shifted(3 * words), w.y.shifted(3 * words), w.z.shifted(3 * words)};
}
BigVector moved(const dvec3& v)
{
    const BigVector w = scaled(v);
    return {w.x + BigInteger(1).shifted(2 * words), w.y + BigInteger(1).shifted(words), w.z + BigInteger(1)};
}

// u x v . w, and how far rounding may have put it off: sixteen ulps of the sum of all products are more than twice what
// their roundings, and those of differences of points with binary digits, can add up to.
struct Determinant {
    double value, bound;

    Determinant(const dvec3& u, const dvec3& v, const dvec3& w)
    {
        const dvec3 left(u.y * v.z, u.z * v.x, u.x * v.y), right(u.z * v.y, u.x * v.z, u.y * v.x);
        value = glm::dot(left - right, w);
        bound = 0x1p-49 * glm::dot(glm::abs(left) + glm::abs(right), glm::abs(w));
    }
    int sign() const { return value > bound ? 1 : value < -bound ? -1 : 0; }
};

// Side of p in the plane of a, b, c: (b-a) x (c-a) . (p-a).
int plane_sign(const dvec3& a, const dvec3& b, const dvec3& c, const dvec3& p, bool move)
{
    if (const int sign = Determinant(b - a, c - a, p - a).sign()) return sign;
    if (!move) return dot(cross(big(b) - big(a), big(c) - big(a)), big(p) - big(a)).sign();
    return dot(cross(scaled(b) - scaled(a), scaled(c) - scaled(a)), moved(p) - scaled(a)).sign();
}

// Side on which the line p q passes the line a b: (q-p) x (a-p) . (b-p), of one sign for all three edges of a triangle
// that is met.
int line_sign(const dvec3& p, const dvec3& q, const dvec3& a, const dvec3& b, bool move)
{
    if (const int sign = Determinant(q - p, a - p, b - p).sign()) return sign;
    if (!move) return dot(cross(big(q) - big(p), big(a) - big(p)), big(b) - big(p)).sign();
    const BigVector from = moved(p);
    return dot(cross(moved(q) - from, scaled(a) - from), scaled(b) - from).sign();
}

// Where the segment meets a plane that its moved ends lie on either side of, as a fraction of it.
struct Place {
    double rounded, error;

    Place(const dvec3& p, const dvec3& q, const dvec3& a, const dvec3& b, const dvec3& c)
    {
        const Determinant from(b - a, c - a, p - a), to(b - a, c - a, q - a);
        const double difference = std::abs(from.value - to.value);
        rounded = std::abs(from.value) / difference;
        error = 4 * (from.bound + to.bound) / difference + 1e-15;
        if (!(rounded + error < 2)) rounded = 0.5, error = 1; // both are rounding
    }
};

struct ExactPlace {
    BigInteger numerator, denominator; // > 0

    ExactPlace(const dvec3& p, const dvec3& q, const dvec3& a, const dvec3& b, const dvec3& c)
    {
        const BigVector from = moved(p), normal = cross(scaled(b) - scaled(a), scaled(c) - scaled(a));
        numerator = dot(normal, scaled(a) - from);
        denominator = dot(normal, moved(q) - from);
        if (denominator.sign() > 0) return;
        numerator = -numerator;
        denominator = -denominator;
    }
};

bool meets_box(const dvec3& from, const dvec3& to, const dvec3& minimum, const dvec3& maximum, double radius)
{
    double enter = 0, leave = 1;
    for (int k = 0; k < 3; ++k) {
        const double along = to[k] - from[k];
        const double low = minimum[k] - radius - from[k], high = maximum[k] + radius - from[k];
        if (std::abs(along) < 1e-9) {
            if (low > 0 || high < 0) return false;
            continue;
        }
        enter = std::max(enter, std::min(low / along, high / along));
        leave = std::min(leave, std::max(low / along, high / along));
    }
    return enter <= leave + 1e-9;
}

} // namespace

ExactMesh::ExactMesh(const runtime::Surface& surface) : vertices_(surface.vertices)
{
    for (const runtime::Face& face : surface.faces) corners_.push_back(face.vertex);
    order_.resize(corners_.size());
    std::iota(order_.begin(), order_.end(), 0u);
    build(0, uint32_t(order_.size()));
}

void ExactMesh::build(uint32_t begin, uint32_t end)
{
    const size_t self = nodes_.size();
    Node node{dvec3(INFINITY), dvec3(-INFINITY), begin, end};
    for (uint32_t k = begin; k < end; ++k)
        for (uint32_t i = 0; i < 3; ++i) {
            node.minimum = glm::min(node.minimum, corner(order_[k], i));
            node.maximum = glm::max(node.maximum, corner(order_[k], i));
        }
    nodes_.push_back(node);
    if (end - begin <= 4) return;
    const dvec3 sides = node.maximum - node.minimum;
    const int axis = sides.x >= sides.y && sides.x >= sides.z ? 0 : sides.y >= sides.z ? 1 : 2;
    const auto middle = [&](uint32_t f) { return corner(f, 0)[axis] + corner(f, 1)[axis] + corner(f, 2)[axis]; };
    const uint32_t half = begin + (end - begin) / 2;
    std::nth_element(order_.begin() + begin, order_.begin() + half, order_.begin() + end,
                     [&](uint32_t f, uint32_t g) { return middle(f) < middle(g); });
    build(begin, half);
    nodes_[self].second = uint32_t(nodes_.size());
    build(half, end);
}

// Calls visit(face) for the faces whose tree box the segment may come near; until it returns false.
template <class Visit>
void ExactMesh::visit_near(const dvec3& from, const dvec3& to, double radius, Visit&& visit) const
{
    uint32_t stack[64], depth = 0;
    stack[depth++] = 0;
    while (depth > 0) {
        const uint32_t self = stack[--depth];
        const Node& node = nodes_[self];
        if (!meets_box(from, to, node.minimum, node.maximum, radius)) continue;
        if (node.second != 0) {
            stack[depth++] = node.second;
            stack[depth++] = self + 1;
            continue;
        }
        for (uint32_t k = node.begin; k < node.end; ++k)
            if (!visit(order_[k])) return;
    }
}

std::optional<ExactMesh::Hit> ExactMesh::first_crossing(const dvec3& from, const dvec3& to) const
{
    std::optional<Hit> first;
    Place best(from, from, from, from, from);
    visit_near(from, to, 2, [&](uint32_t face) {
        const dvec3 &a = corner(face, 0), &b = corner(face, 1), &c = corner(face, 2);
        const int side = plane_sign(a, b, c, from, true);
        if (side == plane_sign(a, b, c, to, true)) return true;
        const int turn = line_sign(from, to, a, b, true);
        if (turn != line_sign(from, to, b, c, true) || turn != line_sign(from, to, c, a, true)) return true;

        const Place place(from, to, a, b, c);
        const double doubt = place.error + best.error;
        bool earlier = !first || place.rounded < best.rounded - doubt;
        if (!earlier && place.rounded < best.rounded + doubt) {
            const ExactPlace here(from, to, a, b, c);
            const ExactPlace there(from, to, corner(first->face, 0), corner(first->face, 1), corner(first->face, 2));
            const int order = (here.numerator * there.denominator - there.numerator * here.denominator).sign();
            // Faces that lie on each other: the lower number is on top, up being where the first component of the
            // normal that is not 0 is positive.
            const dvec3 n = normal(face);
            const bool forward = n.x != 0 ? n.x > 0 : n.y != 0 ? n.y > 0 : n.z > 0;
            const bool from_above = forward == (side > 0);
            earlier = order < 0 || (order == 0 && (face < first->face) == from_above);
        }
        if (earlier) {
            best = place;
            first = Hit{face, side > 0 ? 0u : 1u};
        }
        return true;
    });
    return first;
}

int ExactMesh::side_of(uint32_t face, const dvec3& point) const
{
    return plane_sign(corner(face, 0), corner(face, 1), corner(face, 2), point, false);
}

bool ExactMesh::touches(uint32_t face, const dvec3& from, const dvec3& to) const
{
    const dvec3 &a = corner(face, 0), &b = corner(face, 1), &c = corner(face, 2);
    const int side_from = side_of(face, from), side_to = side_of(face, to);
    if (side_from * side_to > 0) return false;
    if (side_from == 0 && side_to == 0)
        return meets_box(from, to, glm::min(a, glm::min(b, c)), glm::max(a, glm::max(b, c)), 1);
    const int ab = line_sign(from, to, a, b, false), bc = line_sign(from, to, b, c, false),
              ca = line_sign(from, to, c, a, false);
    return (ab >= 0 && bc >= 0 && ca >= 0) || (ab <= 0 && bc <= 0 && ca <= 0);
}

bool ExactMesh::open(const dvec3& from, const dvec3& to) const
{
    bool open = true;
    visit_near(from, to, 1, [&](uint32_t face) { return open = !touches(face, from, to); });
    return open;
}

bool ExactMesh::touches_only(uint32_t face, const dvec3& from, const dvec3& to) const
{
    bool only = true, touched = false;
    visit_near(from, to, 1, [&](uint32_t other) {
        if (!touches(other, from, to)) return true;
        touched = touched || other == face;
        for (uint32_t i = 0; i < 3; ++i) only = only && (other == face || side_of(face, corner(other, i)) == 0);
        return only;
    });
    return only && touched;
}

bool ExactMesh::holds(const dvec3& point) const
{
    bool held = false;
    visit_near(point, point, 1, [&](uint32_t face) {
        held = side_of(face, point) == 0 && glm::length(point - nearest(face, point)) < 0.5;
        return !held;
    });
    return held;
}

std::vector<uint32_t> ExactMesh::near(const dvec3& point, double radius) const
{
    std::vector<uint32_t> faces;
    visit_near(point, point, radius, [&](uint32_t face) {
        if (glm::length(point - nearest(face, point)) < radius) faces.push_back(face);
        return true;
    });
    return faces;
}

dvec3 ExactMesh::nearest(uint32_t face, const dvec3& p) const
{
    const dvec3 n = normal(face), &a = corner(face, 0), &b = corner(face, 1), &c = corner(face, 2);
    const dvec3 foot = p - glm::dot(p - a, n) * n;
    dvec3 best = foot;
    double distance = INFINITY;
    bool inside = true;
    for (const auto& [from, to] : {std::pair{a, b}, std::pair{b, c}, std::pair{c, a}}) {
        const dvec3 e = to - from;
        inside = inside && glm::dot(glm::cross(n, e), foot - from) >= 0;
        const dvec3 q = from + glm::clamp(glm::dot(p - from, e) / glm::dot(e, e), 0.0, 1.0) * e;
        if (glm::length(p - q) >= distance) continue;
        distance = glm::length(p - q);
        best = q;
    }
    return inside ? foot : best;
}

dvec3 ExactMesh::normal(uint32_t face) const
{
    // Of a sliver a rounded product would be noise. Vertices are multiples of 64 and below 2^40: this is exact.
    __extension__ typedef __int128 Wide;
    const dvec3 u = (corner(face, 1) - corner(face, 0)) / 64.0, v = (corner(face, 2) - corner(face, 0)) / 64.0;
    const auto minor = [](double a, double d, double b, double c) {
        return double(Wide(int64_t(a)) * int64_t(d) - Wide(int64_t(b)) * int64_t(c));
    };
    return glm::normalize(dvec3(minor(u.y, v.z, u.z, v.y), minor(u.z, v.x, u.x, v.z), minor(u.x, v.y, u.y, v.x)));
}

} // namespace haptel::test
