#include "runtime/geometry/predicates.h"

#include "runtime/geometry/lattice.h"
#include "tests/runtime/geometry/big_integer.h"
#include "tests/support/catch.h"

#include <random>

using namespace haptel::runtime;
using haptel::test::BigInteger;

namespace {

struct BigVector {
    BigInteger x, y, z;

    explicit BigVector(const glm::dvec3& v) : x(int64_t(v.x)), y(int64_t(v.y)), z(int64_t(v.z)) {}
    BigVector(BigInteger a, BigInteger b, BigInteger c) : x(std::move(a)), y(std::move(b)), z(std::move(c)) {}
};

BigVector operator-(const BigVector& a, const BigVector& b)
{
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
BigInteger dot(const BigVector& a, const BigVector& b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
BigVector cross(const BigVector& a, const BigVector& b)
{
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

// The rule for ties taken literally: e = 2^-640, everything scaled by e^-3, probes moved by (e, e^2, e^3).
constexpr size_t words = 20;
BigVector scaled(const glm::dvec3& v)
{
    const BigVector big(v);
    return {big.x.shifted(3 * words), big.y.shifted(3 * words), big.z.shifted(3 * words)};
}
BigVector moved(const glm::dvec3& v)
{
    const BigVector big = scaled(v);
    return {big.x + BigInteger(1).shifted(2 * words), big.y + BigInteger(1).shifted(words), big.z + BigInteger(1)};
}

struct Points {
    std::mt19937_64 random{7};

    double coordinate(double bound)
    {
        return std::round(std::uniform_real_distribution<double>(-bound, bound)(random));
    }
    glm::dvec3 probe(double bound = Lattice::workspace)
    {
        return {coordinate(bound), coordinate(bound), coordinate(bound)};
    }
    glm::dvec3 vertex(double bound = Lattice::extent) { return Lattice::vertex_spacing * probe(bound / 64 - 1); }
    // Mostly ties and near ties: a small grid, offsets of a unit, points of one plane.
    glm::dvec3 nearby(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c)
    {
        switch (random() % 5) {
        case 0: return a;
        case 1: return glm::round(0.5 * (a + b));
        case 2: return glm::round((a + b + c) / 3.0) + probe(1);
        case 3: return a + (b - a) * 2.0 - (c - a);
        default: return probe(3 * Lattice::vertex_spacing);
        }
    }
};

} // namespace

TEST_CASE("orientations and tie breaks agree with integers of any size")
{
    Points points;
    int ties = 0, exact_needed = 0;
    for (int i = 0; i < 4000; ++i) {
        const double bound = i % 3 == 0 ? Lattice::extent : i % 3 == 1 ? 1e6 : 256;
        const glm::dvec3 a = points.vertex(bound), b = points.vertex(bound), c = points.vertex(bound);
        if (exact_normal(a, b, c).is_zero()) continue;
        const glm::dvec3 p =
            glm::clamp(i % 2 ? points.nearby(a, b, c) : points.probe(), -Lattice::workspace, Lattice::workspace);
        const glm::dvec3 q =
            glm::clamp(i % 4 < 2 ? points.nearby(b, c, a) : points.probe(), -Lattice::workspace, Lattice::workspace);

        const BigVector big_normal = cross(BigVector(b) - BigVector(a), BigVector(c) - BigVector(a));
        const int truth = dot(big_normal, BigVector(p) - BigVector(a)).sign();
        CAPTURE(i);
        REQUIRE(orientation(a, b, c, p) == truth);
        ties += truth == 0;

        const BigVector tied_normal = cross(scaled(b) - scaled(a), scaled(c) - scaled(a));
        REQUIRE(side_of_plane(a, b, c, p) == dot(tied_normal, moved(p) - scaled(a)).sign());

        if (p == q) continue;
        const BigInteger line = dot(cross(moved(q) - moved(p), scaled(b) - scaled(a)), scaled(a) - moved(p));
        REQUIRE(side_of_line(p, q, a, b) == line.sign());
        REQUIRE(side_of_line(p, q, b, a) == -line.sign());
        exact_needed += line_orientation(p, q, a, b) == 0;
    }
    REQUIRE(ties > 200);
    REQUIRE(exact_needed > 200);
}

TEST_CASE("a segment on one side of a triangle does not cross it, one from side to side does")
{
    constexpr double one = 65536; // of the lattice
    const glm::dvec3 a(0), b(8 * one, 0, 0), c(0, 8 * one, 0);
    Crossing crossing;
    CHECK_FALSE(crosses(one * glm::dvec3(1, 1, 1), one * glm::dvec3(1, 1, 5), a, b, c, crossing));
    CHECK_FALSE(crosses(one * glm::dvec3(1, 1, -1), one * glm::dvec3(90, 1, -5), a, b, c, crossing));
    CHECK_FALSE(crosses(one * glm::dvec3(90, 1, 1), one * glm::dvec3(90, 1, -3), a, b, c, crossing)); // beside it
    CHECK(crosses(one * glm::dvec3(1, 1, 1), one * glm::dvec3(1, 1, -3), a, b, c, crossing));
    CHECK(crossing.fraction() == 0.25);
}

TEST_CASE("crossings of a segment are ordered as exact fractions, ties included")
{
    Points points;
    int equal = 0, compared = 0;
    for (int i = 0; i < 20000; ++i) {
        // Three of the six corners are shared at most, so that many crossings coincide in a corner or on an edge.
        const double bound = i % 2 ? Lattice::extent : 512;
        const glm::dvec3 s = points.vertex(bound);
        const glm::dvec3 t[2][3] = {{s, points.vertex(bound), points.vertex(bound)},
                                    {s, points.vertex(bound), points.vertex(bound)}};
        const glm::dvec3 p = points.probe(2 * bound);
        const glm::dvec3 q = i % 4 < 2 ? 2.0 * s - p : points.probe(2 * bound);
        Crossing crossing[2];
        bool both = true;
        for (int k = 0; k < 2; ++k) {
            if (exact_normal(t[k][0], t[k][1], t[k][2]).is_zero())
                both = false;
            else
                both = crosses(p, q, t[k][0], t[k][1], t[k][2], crossing[k]) && both;
            crossing[k].face = uint32_t(k);
        }
        if (!both) continue;
        ++compared;

        BigInteger numerator[2], denominator[2];
        for (int k = 0; k < 2; ++k) {
            const BigVector n = cross(scaled(t[k][1]) - scaled(t[k][0]), scaled(t[k][2]) - scaled(t[k][0]));
            numerator[k] = dot(n, scaled(t[k][0]) - moved(p));
            denominator[k] = dot(n, moved(q) - moved(p));
            if (denominator[k].sign() < 0) {
                numerator[k] = -numerator[k];
                denominator[k] = -denominator[k];
            }
        }
        const int truth = (numerator[0] * denominator[1] - numerator[1] * denominator[0]).sign();
        equal += crossing[0].fraction() == crossing[1].fraction();
        CAPTURE(i);
        REQUIRE(truth != 0);
        REQUIRE(earlier(crossing[0], crossing[1]) == (truth < 0));
        REQUIRE(earlier(crossing[1], crossing[0]) == (truth > 0));
    }
    REQUIRE(compared > 200);
    REQUIRE(equal > 50);
}
