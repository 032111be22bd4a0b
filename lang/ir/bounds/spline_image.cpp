#include "lang/ir/bounds/spline_image.h"

#include "lang/ir/bounds/spline_extremes.h"
#include "lang/math/spline.h"

#include <algorithm>
#include <cmath>

namespace haptel::ir {
namespace {

constexpr int64_t scan_max = 1024; // cells: wider places have the bounds of the whole image

// Many lines of numbers side by side, solved together: number i of line k is at first[i * step + k].
struct Lines {
    double* first;
    size_t count, step, lines;

    double* at(size_t i) const { return first + i * step; }
};

// Solves (c[i-1] + 4 c[i] + c[i+1]) / 6 = f[i] in place, where c[-1] = c[0] and c[n] = c[n-1].
void solve_mirrored(const Lines& all)
{
    const size_t n = all.count;
    if (n == 1) return;
    std::vector<double> pivots(n, 5.0);
    for (size_t k = 0; k < all.lines; ++k) all.first[k] *= 6;
    for (size_t i = 1; i < n; ++i) {
        pivots[i] = (i + 1 == n ? 5.0 : 4.0) - 1 / pivots[i - 1];
        double *line = all.at(i), *last = all.at(i - 1);
        for (size_t k = 0; k < all.lines; ++k) line[k] = 6 * line[k] - last[k] / pivots[i - 1];
    }
    for (size_t k = 0; k < all.lines; ++k) all.at(n - 1)[k] /= pivots[n - 1];
    for (size_t i = n - 1; i-- > 0;) {
        double *line = all.at(i), *next = all.at(i + 1);
        for (size_t k = 0; k < all.lines; ++k) line[k] = (line[k] - next[k]) / pivots[i];
    }
}

// The same where c[-1] = c[n-1] and c[n] = c[0]: that of the mirrored line, and a correction that makes up for the
// corners (Sherman and Morrison).
void solve_tiled(const Lines& all)
{
    const size_t n = all.count;
    if (n == 1) return;
    // M = mirrored + u v^T, u = (1, 0 ... 0, -1), v = (-1, 0 ... 0, 1): the corners, and 4 instead of 5 on the diagonal
    std::vector<double> corner(n, 0.0), share(all.lines);
    corner[0] = 1;
    corner[n - 1] = -1;
    for (double& c : corner) c /= 6;
    solve_mirrored({corner.data(), n, 1, 1});
    solve_mirrored(all);
    for (size_t k = 0; k < all.lines; ++k)
        share[k] = (all.at(n - 1)[k] - all.first[k]) / (1 + corner[n - 1] - corner[0]);
    for (size_t i = 0; i < n; ++i)
        for (size_t k = 0; k < all.lines; ++k) all.at(i)[k] -= share[k] * corner[i];
}

// The same where the first and the last number of each line stay as they are, and are what the line is made of outside.
// Each diagonal element is 4 and its neighbours are 1: it has a solution for every line, of one number, too.
void solve_clamped(const Lines& all)
{
    std::vector<double> pivots(all.count, 1.0);
    for (size_t i = 1; i + 1 < all.count; ++i) {
        pivots[i] = i == 1 ? 4 : 4 - 1 / pivots[i - 1];
        double *line = all.at(i), *last = all.at(i - 1);
        for (size_t k = 0; k < all.lines; ++k) line[k] = 6 * line[k] - last[k] / pivots[i - 1];
    }
    for (size_t i = all.count - 1; i-- > 1;) {
        double *line = all.at(i), *next = all.at(i + 1);
        for (size_t k = 0; k < all.lines; ++k) line[k] = (line[k] - next[k]) / pivots[i];
    }
}

// Along the rows, then along the columns.
template <typename Solve>
void solve_both(std::vector<double>& all, size_t columns, size_t rows, const Solve& solve)
{
    for (size_t row = 0; row < rows; ++row) solve(Lines{all.data() + row * columns, columns, 1, 1});
    solve(Lines{all.data(), rows, columns, columns});
}

// With the texels at the edges once more around them.
std::vector<double> framed(std::span<const double> texels, size_t columns, size_t rows)
{
    std::vector<double> all;
    all.reserve((columns + 2) * (rows + 2));
    for (size_t j = 0; j < rows + 2; ++j) {
        const auto row = texels.subspan(std::clamp<size_t>(j, 1, rows) * columns - columns, columns);
        all.push_back(row.front());
        all.insert(all.end(), row.begin(), row.end());
        all.push_back(row.back());
    }
    return all;
}

// Where spline() looks for places in there, with the rounding of bringing them back into the image.
PlaceRange places(const Interval& at, int64_t count, bool repeats)
{
    const auto size = static_cast<double>(count);
    const double low = repeats ? at.minimum : std::clamp(at.minimum, -3.0, size + 2);
    const double high = repeats ? at.maximum : std::clamp(at.maximum, -3.0, size + 2);
    const double rounding = 1e-15 * (2 * size + std::max(std::fabs(low), std::fabs(high)));
    return {low - rounding, high + rounding};
}

// Infinite or beyond what can be counted where that is too many.
double cells(PlaceRange at)
{
    return at.high - at.low + 2;
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
    const auto columns = static_cast<size_t>(width), rows = static_cast<size_t>(height);
    auto& [clamped, tiled, mirrored] = made->coefficients;
    clamped = framed(texels, columns, rows);
    solve_both(clamped, columns + 2, rows + 2, solve_clamped);
    tiled = mirrored = {texels.begin(), texels.end()};
    solve_both(tiled, columns, rows, solve_tiled);
    solve_both(mirrored, columns, rows, solve_mirrored);
    made->image = {
        {clamped.data(), tiled.data(), mirrored.data()}, static_cast<int32_t>(width), static_cast<int32_t>(height)};
    return made;
}

const Interval& SplineImage::over_all(uint32_t orders) const
{
    const uint32_t edge = spline_edge(orders);
    const uint32_t by_x = spline_order_along(orders, 0), by_y = spline_order_along(orders, 1);
    Known& all = known[edge][by_x][by_y];
    std::call_once(all.asked, [&] {
        // beyond the image: where a tiled or mirrored one goes on and a clamped one becomes flat
        const auto range = [](int32_t count) { return PlaceRange{-3.0, count + 2.0}; };
        all.found = spline_extremes(image, range(image.width), range(image.height), orders);
        if (edge != HAPTEL_EDGE_MIRRORED || (by_x % 2 == 0 && by_y % 2 == 0)) return;
        const double size = size_of(all.found);
        all.found = {-size, size}; // in the copies that are turned round
    });
    return all.found;
}

Interval SplineImage::bounds(const Interval& x, const Interval& y, uint32_t orders) const
{
    if (x.is_empty() || y.is_empty()) return {infinity, -infinity, true};
    const bool repeats = spline_edge(orders) != HAPTEL_EDGE_CLAMPED;
    const bool may_be_nan =
        x.may_be_nan || y.may_be_nan ||
        (repeats && !(std::isfinite(x.maximum - x.minimum) && std::isfinite(y.maximum - y.minimum)));
    if (spline_order_along(orders, 0) > 3 || spline_order_along(orders, 1) > 3) return {0, 0, may_be_nan};

    const PlaceRange columns = places(x, image.width, repeats), rows = places(y, image.height, repeats);
    const auto is_far = [](PlaceRange at) { return !(std::fabs(at.low) < 1e9 && std::fabs(at.high) < 1e9); };
    const bool is_wide = is_far(columns) || is_far(rows) || cells(columns) * cells(rows) > scan_max;
    Interval found = is_wide ? over_all(orders) : spline_extremes(image, columns, rows, orders);
    found.may_be_nan = may_be_nan;
    return found;
}

} // namespace haptel::ir
