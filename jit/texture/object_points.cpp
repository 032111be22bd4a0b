#include "jit/texture/object_points.h"

#include <cmath>

namespace haptel::jit {

namespace {

constexpr double minute_s = 60;

// The positive roots of x^(d + 1) = x + 1.
constexpr double golden[] = {1.6180339887498949, 1.3247179572447460, 1.2207440846057596};

// The `index`-th of `dimension`, in [0, 1).
double share(uint64_t index, int dimensions, int dimension)
{
    double step = 1;
    for (int i = 0; i <= dimension; ++i) step /= golden[dimensions - 1];
    const double whole = 0.5 + static_cast<double>(index) * step;
    return whole - std::floor(whole);
}

// Somewhere between two figures; between 0 and another where they are not known.
double between(double minimum, double maximum, double otherwise, double share)
{
    if (!std::isfinite(minimum) || !std::isfinite(maximum)) return share * otherwise;
    return minimum + share * (maximum - minimum);
}

} // namespace

haptel_point ObjectPoints::next()
{
    ++index;
    haptel_point point{};
    for (int k = 0; k < 3; ++k)
        point.p[k] = between(request.box_minimum_m[k], request.box_maximum_m[k], 1, share(index, 3, k));
    // Of another count than the places', by arithmetic that is the same everywhere.
    double length = 0;
    for (int k = 0; k < 3; ++k) {
        point.n[k] = share(3 * index, 3, k) - 0.5;
        length += point.n[k] * point.n[k];
    }
    for (double& n : point.n) n /= std::sqrt(length);
    for (int k = 0; k < 2; ++k) {
        point.uv[k] = between(request.uv.minimum[k], request.uv.maximum[k], 1, share(index, 2, k));
        for (int j = 0; j < 3; ++j)
            point.uv_dp[k][j] = between(request.uv.dp_minimum[k][j], request.uv.dp_maximum[k][j], 100,
                                        share((k == 0 ? 5 : 7) * index, 3, j));
    }
    point.time_s = minute_s * share(index, 1, 0);
    return point;
}

} // namespace haptel::jit
