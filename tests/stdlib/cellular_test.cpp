// cellular against points that are worked out here, from the library's tables, over a window wider than any it needs.
#include "tests/stdlib/field.h"
#include "tests/support/catch.h"

#include <algorithm>
#include <cmath>

using namespace haptel::test;

namespace {

double coordinate(int number, int offset, double spread)
{
    return 0.5 + spread * (2 * shuffled(number + offset) / 255.0 - 1);
}

// Distances to the points of all cells within three of q.
std::vector<double> distances(const Vec3& q, bool in_space)
{
    std::vector<double> found;
    const int i0 = static_cast<int>(std::floor(q[0])), j0 = static_cast<int>(std::floor(q[1])),
              k0 = in_space ? static_cast<int>(std::floor(q[2])) : 0, deep = in_space ? 3 : 0;
    for (int i = i0 - 3; i <= i0 + 3; ++i)
        for (int j = j0 - 3; j <= j0 + 3; ++j)
            for (int k = k0 - deep; k <= k0 + deep; ++k) {
                const int number = shuffled(shuffled(shuffled(i) + j) + k);
                const double spread = in_space ? 0.3 : 0.4;
                const double x = i + coordinate(number, 0, spread) - q[0],
                             y = j + coordinate(number, 101, spread) - q[1],
                             z = in_space ? k + coordinate(number, 197, spread) - q[2] : 0;
                found.push_back(std::sqrt(x * x + y * y + z * z));
            }
    return found;
}

// Of all of them, with the factor that ends with the fourth cell.
double rounded_least(const std::vector<double>& all, double k, bool in_space)
{
    const double c = k / (4 * std::log(2.0)), near = in_space ? 1.92 : 1.62, far = in_space ? 2.89 : 2.56;
    double sum = 0;
    for (double d : all) {
        const double t = std::clamp((d * d - near) / (far - near), 0.0, 1.0);
        sum += (1 - t * t * (3 - 2 * t)) * std::exp(-(std::sqrt(d * d + k * k) - k) / c);
    }
    return -c * std::log(sum);
}

} // namespace

TEST_CASE("cellular is the rounded least distance, and cells beyond its window change nothing")
{
    for (const bool in_space : {false, true}) {
        for (const double k : {0.01, 0.1, 0.3}) {
            const Field field("cellular(" + std::string(in_space ? "q" : "q.xy") + ", " + std::to_string(k) + ")");
            for (const Vec3& q : points_within(30, in_space ? 300 : 1000)) {
                const std::vector<double> all = distances(q, in_space);
                const double found = field(q).value, nearest = *std::min_element(all.begin(), all.end());
                CHECK(std::fabs(found - rounded_least(all, k, in_space)) < 1e-12);
                CHECK(found <= nearest + 1e-12);
                CHECK(found >= nearest - 2.5 * k); // the tip and 16 or 64 neighbours
            }
        }
    }
}

TEST_CASE("cellular has a continuous gradient, across cells and windows too")
{
    const double step = 1e-9;
    for (const std::string call : {"cellular(q.xy, 0.2)", "cellular(q, 0.2)"}) {
        const Field field(call);
        for (const Vec3& q : points_within(20, 500)) {
            for (const double side : {0.0, 0.5}) { // where cells meet, and where the window moves on
                const double face = std::floor(q[0]) + side;
                const FieldSample before = field({face - step, q[1], q[2]}), after = field({face + step, q[1], q[2]});
                CHECK(std::fabs(before.value - after.value) < 1e-8);
                for (size_t a = 0; a < 3; ++a) CHECK(std::fabs(before.gradient[a] - after.gradient[a]) < 1e-6);
            }
        }
    }
}

TEST_CASE("cellular: seeds move the points")
{
    const Field zero("cellular(q.xy, 0.1)"), same("cellular(q.xy, 0.1, 0)"), other("cellular(q.xy, 0.1, 5)");
    int different = 0;
    for (const Vec3& q : points_within(20, 100)) {
        CHECK(zero(q).value == same(q).value);
        different += std::fabs(zero(q).value - other(q).value) > 0.01;
    }
    CHECK(different > 80);
}
