#include "lang/ir/spline_image.h"

#include "lang/ir/spline.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace haptel::ir {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr int64_t scan_max = 1024; // texels: wider places have the bounds of the whole image

// Solves (c[i-1] + 4 c[i] + c[i+1]) / 6 = f[i] in place, where c[-1] = c[0] and c[n] = c[n-1]. `pivots` is work space.
void solve_clamped(std::span<double> line, std::vector<double>& pivots)
{
    const size_t n = line.size();
    if (n == 1) return;
    pivots.resize(n);
    pivots[0] = 5;
    line[0] *= 6;
    for (size_t i = 1; i < n; ++i) {
        pivots[i] = (i + 1 == n ? 5.0 : 4.0) - 1 / pivots[i - 1];
        line[i] = 6 * line[i] - line[i - 1] / pivots[i - 1];
    }
    line[n - 1] /= pivots[n - 1];
    for (size_t i = n - 1; i-- > 0;) line[i] = (line[i] - line[i + 1]) / pivots[i];
}

// The same where c[-1] = c[n-1] and c[n] = c[0]: that of the clamped line, and a correction that makes up for the
// corners (Sherman and Morrison).
void solve_tiled(std::span<double> line, std::vector<double>& pivots, std::vector<double>& corner)
{
    const size_t n = line.size();
    if (n == 1) return;
    // M = clamped + u v^T, u = (1, 0 ... 0, -1), v = (-1, 0 ... 0, 1): the corners, and 4 instead of 5 on the diagonal
    corner.assign(n, 0);
    corner[0] = 1;
    corner[n - 1] = -1;
    for (double& c : corner) c /= 6;
    solve_clamped(corner, pivots);
    solve_clamped(line, pivots);
    const double share = (line[n - 1] - line[0]) / (1 + corner[n - 1] - corner[0]);
    for (size_t i = 0; i < n; ++i) line[i] -= share * corner[i];
}

template <typename Solve>
std::vector<double> solved(std::span<const double> texels, int64_t width, int64_t height, const Solve& solve)
{
    std::vector<double> all(texels.begin(), texels.end());
    const auto columns = static_cast<size_t>(width), rows = static_cast<size_t>(height);
    for (size_t row = 0; row < rows; ++row) solve(std::span(all).subspan(row * columns, columns));
    std::vector<double> line(rows);
    for (size_t column = 0; column < columns; ++column) {
        for (size_t row = 0; row < rows; ++row) line[row] = all[row * columns + column];
        solve(std::span(line));
        for (size_t row = 0; row < rows; ++row) all[row * columns + column] = line[row];
    }
    return all;
}

// Cells that places between these lie in.
std::pair<int64_t, int64_t> cells(const Interval& at, int64_t count, bool repeats)
{
    const double low = repeats ? at.minimum : std::clamp(at.minimum, -3.0, static_cast<double>(count) + 2.0);
    const double high = repeats ? at.maximum : std::clamp(at.maximum, -3.0, static_cast<double>(count) + 2.0);
    if (!(std::fabs(low) < 1e9 && std::fabs(high) < 1e9)) return {0, std::numeric_limits<int32_t>::max()};
    // one more on each side, for the rounding of a place that is brought back into the image
    return {static_cast<int64_t>(std::floor(low)) - repeats, static_cast<int64_t>(std::floor(high)) + repeats};
}

} // namespace

std::shared_ptr<const SplineImage> SplineImage::make(std::span<const double> texels, int64_t width, int64_t height,
                                                     std::string& error)
{
    const auto fail = [&](std::string reason) {
        error = std::move(reason);
        return nullptr;
    };
    if (width < 1 || height < 1) return fail("it has no texels");
    if (width > side_max || height > side_max || width * height > texels_max)
        return fail("it is too large: expected at most " + std::to_string(side_max) + " texels a side and " +
                    std::to_string(texels_max) + " in all, found " + std::to_string(width) + " x " +
                    std::to_string(height));
    if (texels.size() != static_cast<size_t>(width * height)) return fail("its rows are not whole");
    for (size_t i = 0; i < texels.size(); ++i)
        if (!(std::fabs(texels[i]) < 1e100)) // so that no sum of texels overflows
            return fail("texel (" + std::to_string(i % static_cast<size_t>(width)) + ", " +
                        std::to_string(i / static_cast<size_t>(width)) + ") is not a number of reasonable size");

    std::shared_ptr<SplineImage> made(new SplineImage);
    std::vector<double> pivots, corner;
    made->clamped = solved(texels, width, height, [&](std::span<double> line) { solve_clamped(line, pivots); });
    made->tiled = solved(texels, width, height, [&](std::span<double> line) { solve_tiled(line, pivots, corner); });
    haptel_image& image = made->image;
    image = {
        {made->clamped.data(), made->tiled.data()}, static_cast<int32_t>(width), static_cast<int32_t>(height), 0, 0};
    for (uint32_t by_x = 0; by_x <= known_order; ++by_x)
        for (uint32_t by_y = 0; by_x + by_y <= known_order; ++by_y)
            for (uint32_t edge = 0; edge < spline_edges; ++edge) {
                Interval& found = made->known[edge][by_x][by_y];
                found = made->differences(spline_order(by_x, by_y, edge), -3, width + 6, -3, height + 6);
                if (edge != HAPTEL_EDGE_MIRRORED || (by_x % 2 == 0 && by_y % 2 == 0)) continue;
                const double size = std::max(std::fabs(found.minimum), std::fabs(found.maximum));
                found = {-size, size}; // in the copies that are turned round
            }
    image.minimum = std::min(made->known[0][0][0].minimum, made->known[1][0][0].minimum);
    image.maximum = std::max(made->known[0][0][0].maximum, made->known[1][0][0].maximum);
    return made;
}

// A derivative of the spline is a mean, with weights of sum 1, of differences of the coefficients: `orders` by column
// and by row, here over all that start in these columns and rows.
Interval SplineImage::differences(uint32_t orders, int64_t first_column, int64_t columns, int64_t first_row,
                                  int64_t rows) const
{
    const uint32_t edge = spline_edge(orders);
    const uint32_t by_x = spline_order_along(orders, 0), by_y = spline_order_along(orders, 1);
    const std::vector<double>& coefficients = edge == HAPTEL_EDGE_TILED ? tiled : clamped;
    constexpr double binomial[4][4] = {{1}, {-1, 1}, {1, -2, 1}, {-1, 3, -3, 1}};
    double low = infinity, high = -infinity, size = 0;
    for (int64_t j = first_row; j < first_row + rows; ++j)
        for (int64_t i = first_column; i < first_column + columns; ++i) {
            double difference = 0;
            for (uint32_t b = 0; b <= by_y; ++b) {
                const int64_t row = spline_texel(j + b, image.height, edge) * image.width;
                for (uint32_t a = 0; a <= by_x; ++a) {
                    const int64_t column = spline_texel(i + a, image.width, edge);
                    const double coefficient = coefficients[static_cast<size_t>(row + column)];
                    difference += binomial[by_x][a] * binomial[by_y][b] * coefficient;
                    size = std::max(size, std::fabs(coefficient));
                }
            }
            low = std::min(low, difference);
            high = std::max(high, difference);
        }
    const double rounding = size == 0 ? 0 : size * 1e-13 + std::numeric_limits<double>::min();
    return {low - rounding, high + rounding};
}

// One more difference at most doubles the width of what is known.
Interval SplineImage::over_all(uint32_t orders) const
{
    uint32_t by_x = spline_order_along(orders, 0), by_y = spline_order_along(orders, 1), more = 0;
    for (; by_x + by_y > known_order; ++more) --(by_x > by_y ? by_x : by_y);
    const Interval& found = known[spline_edge(orders)][by_x][by_y];
    if (more == 0) return found;
    const double size =
        std::ldexp(std::max(std::fabs(found.minimum), std::fabs(found.maximum)), static_cast<int>(more));
    return {-size, size};
}

Interval SplineImage::bounds(const Interval& x, const Interval& y, uint32_t orders) const
{
    if (x.is_empty() || y.is_empty()) return {infinity, -infinity, true};
    const bool repeats = spline_edge(orders) != HAPTEL_EDGE_CLAMPED;
    const bool may_be_nan =
        x.may_be_nan || y.may_be_nan ||
        (repeats && !(std::isfinite(x.maximum - x.minimum) && std::isfinite(y.maximum - y.minimum)));
    const uint32_t by_x = spline_order_along(orders, 0), by_y = spline_order_along(orders, 1);
    if (by_x > 3 || by_y > 3) return {0, 0, may_be_nan};

    const auto [left, right] = cells(x, image.width, repeats);
    const auto [bottom, top] = cells(y, image.height, repeats);
    // cell c is made of the coefficients c - 1 .. c + 2
    const int64_t columns = right - left + 4 - by_x, rows = top - bottom + 4 - by_y;
    Interval found = over_all(orders);
    if (columns <= scan_max && rows <= scan_max && columns * rows <= scan_max)
        found = intersect(found, differences(orders, left - 1, columns, bottom - 1, rows));
    found.may_be_nan = may_be_nan;
    return found;
}

} // namespace haptel::ir
