#include "lang/ir/bounds/spline_image.h"

#include <algorithm>
#include <cmath>

namespace haptel::ir {
namespace {

// Many lines of numbers side by side, solved together: number i of line k is at first[i * step + k].
struct Lines {
    double* first;
    size_t count, step, lines;

    double* at(size_t i) const { return first + i * step; }
};

// Solves (c[i-1] + 4 c[i] + c[i+1]) / 6 = f[i] in place for `first` <= i < `end`, where the factor is `at_ends` in
// place of 4 in the first and in the last equation, and numbers before and after these are known.
void solve(const Lines& all, size_t first, size_t end, double at_ends)
{
    std::vector<double> pivots(all.count, 1.0);
    for (size_t i = first; i < end; ++i) {
        pivots[i] = i == first || i + 1 == end ? at_ends : 4.0;
        if (i > first) pivots[i] -= 1 / pivots[i - 1];
        double* line = all.at(i);
        const double* last = i > 0 ? all.at(i - 1) : nullptr;
        for (size_t k = 0; k < all.lines; ++k) line[k] = 6 * line[k] - (last ? last[k] / pivots[i - 1] : 0);
    }
    for (size_t i = end; i-- > first;) {
        double* line = all.at(i);
        const double* next = i + 1 < all.count ? all.at(i + 1) : nullptr;
        for (size_t k = 0; k < all.lines; ++k) line[k] = (line[k] - (next ? next[k] : 0)) / pivots[i];
    }
}

// All of them, where c[-1] = c[0] and c[n] = c[n-1].
void solve_mirrored(const Lines& all)
{
    if (all.count > 1) solve(all, 0, all.count, 5);
}

// The first and the last number of each line stay as they are, and are what the line is made of outside.
void solve_clamped(const Lines& all)
{
    solve(all, 1, all.count - 1, 4);
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

} // namespace haptel::ir
