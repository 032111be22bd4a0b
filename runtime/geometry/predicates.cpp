#include "runtime/geometry/predicates.h"

#include "runtime/geometry/lattice.h"

#include <cmath>

namespace haptel::runtime {

namespace {

__extension__ typedef unsigned __int128 UInt128;

// A 3x3 determinant of exact differences has five roundings on its longest path: 5 * 2^-53 of the permanent, and
// the permanent itself is rounded. 8 * 2^-53 is on the safe side.
constexpr double filter = 8.0 * 0x1p-53;

// Vertices sit on every 64th point: differences of two are divided by it to stay within 128 bits below.
constexpr double per_spacing = 1.0 / Lattice::vertex_spacing;

int sign(Int128 v)
{
    return v > 0 ? 1 : v < 0 ? -1 : 0;
}

struct Exact3 {
    Int128 x, y, z;
    explicit Exact3(const glm::dvec3& v) : x(int64_t(v.x)), y(int64_t(v.y)), z(int64_t(v.z)) {}
};

ExactNormal cross(const Exact3& a, const Exact3& b)
{
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

Int128 dot(const ExactNormal& n, const Exact3& v)
{
    return n.x * v.x + n.y * v.y + n.z * v.z;
}

// Sign of u x v . w, or 0 where rounding may have decided.
int rounded_sign(const glm::dvec3& u, const glm::dvec3& v, const glm::dvec3& w)
{
    const double yz = u.y * v.z, zy = u.z * v.y, zx = u.z * v.x, xz = u.x * v.z, xy = u.x * v.y, yx = u.y * v.x;
    const double determinant = (yz - zy) * w.x + (zx - xz) * w.y + (xy - yx) * w.z;
    const double permanent = (std::abs(yz) + std::abs(zy)) * std::abs(w.x) +
                             (std::abs(zx) + std::abs(xz)) * std::abs(w.y) +
                             (std::abs(xy) + std::abs(yx)) * std::abs(w.z);
    const double bound = filter * permanent;
    return determinant > bound ? 1 : determinant < -bound ? -1 : 0;
}

struct UInt256 {
    UInt128 high, low;
};

UInt256 product(UInt128 a, UInt128 b)
{
    const UInt128 mask = ~uint64_t(0);
    const UInt128 a0 = a & mask, a1 = a >> 64, b0 = b & mask, b1 = b >> 64;
    const UInt128 low = a0 * b0, cross1 = a1 * b0 + (low >> 64);
    const UInt128 cross0 = a0 * b1 + (cross1 & mask);
    return {a1 * b1 + (cross1 >> 64) + (cross0 >> 64), cross0 << 64 | (low & mask)};
}

// Sign of a*b - c*d.
int compare_products(Int128 a, Int128 b, Int128 c, Int128 d)
{
    const int left = sign(a) * sign(b), right = sign(c) * sign(d);
    if (left != right) return left < right ? -1 : 1;
    if (left == 0) return 0;
    const auto magnitude = [](Int128 v) { return v < 0 ? -UInt128(v) : UInt128(v); };
    const UInt256 l = product(magnitude(a), magnitude(b)), r = product(magnitude(c), magnitude(d));
    const int larger = l.high != r.high ? (l.high > r.high ? 1 : -1) : l.low != r.low ? (l.low > r.low ? 1 : -1) : 0;
    return left * larger;
}

} // namespace

int ExactNormal::first_sign() const noexcept
{
    return x != 0 ? sign(x) : y != 0 ? sign(y) : sign(z);
}

glm::dvec3 ExactNormal::unit() const noexcept
{
    return glm::normalize(glm::dvec3(double(x), double(y), double(z)));
}

ExactNormal exact_normal(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) noexcept
{
    return cross(Exact3((b - a) * per_spacing), Exact3((c - a) * per_spacing));
}

int orientation(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& p) noexcept
{
    if (const int rounded = rounded_sign(b - a, c - a, p - a)) return rounded;
    return sign(dot(exact_normal(a, b, c), Exact3(p - a)));
}

int side_of_plane(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& p) noexcept
{
    if (const int exact = orientation(a, b, c, p)) return exact;
    return exact_normal(a, b, c).first_sign();
}

int line_orientation(const glm::dvec3& p, const glm::dvec3& q, const glm::dvec3& e0, const glm::dvec3& e1) noexcept
{
    if (const int rounded = rounded_sign(e1 - e0, e0 - p, q - p)) return rounded;
    return sign(dot(cross(Exact3((e1 - e0) * per_spacing), Exact3(e0 - p)), Exact3(q - p)));
}

int side_of_line(const glm::dvec3& p, const glm::dvec3& q, const glm::dvec3& e0, const glm::dvec3& e1) noexcept
{
    if (const int exact = line_orientation(p, q, e0, e1)) return exact;
    // (q-p) x (e1-e0) . (e0-p) changes by -(q-p) x (e1-e0) . (e, e^2, e^3) when p and q move.
    return -cross(Exact3(q - p), Exact3((e1 - e0) * per_spacing)).first_sign();
}

bool crosses(const glm::dvec3& p, const glm::dvec3& q, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c,
             Crossing& crossing) noexcept
{
    const int side_p = side_of_plane(a, b, c, p);
    if (side_p == side_of_plane(a, b, c, q)) return false;
    const int ab = side_of_line(p, q, a, b);
    if (ab != side_of_line(p, q, b, c) || ab != side_of_line(p, q, c, a)) return false;
    ExactNormal n = exact_normal(a, b, c);
    if (side_p > 0) n = {-n.x, -n.y, -n.z}; // along the segment, so that the denominator is positive
    crossing.side = side_p > 0 ? 0 : 1;
    crossing.numerator = dot(n, Exact3(a - p));
    crossing.denominator = dot(n, Exact3(q - p)); // not 0: ties move both ends alike
    crossing.normal = n;
    return true;
}

bool earlier(const Crossing& a, const Crossing& b) noexcept
{
    const double difference = a.fraction() - b.fraction();
    if (std::abs(difference) > filter) return difference < 0; // three roundings of each, one of both
    if (const int exact = compare_products(a.numerator, b.denominator, b.numerator, a.denominator)) return exact < 0;
    // Equal: the moved segment meets a plane earlier by normal . (e, e^2, e^3) / denominator.
    const Int128* const na[] = {&a.normal.x, &a.normal.y, &a.normal.z};
    const Int128* const nb[] = {&b.normal.x, &b.normal.y, &b.normal.z};
    for (int k = 0; k < 3; ++k)
        if (const int moved = compare_products(*na[k], b.denominator, *nb[k], a.denominator)) return moved > 0;
    // Faces of one plane: the lower number lies in front, as seen against the first component of the normal.
    return a.normal.points_forward() ? a.face > b.face : a.face < b.face;
}

} // namespace haptel::runtime
