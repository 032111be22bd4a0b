// How far a spline goes within a rectangle of places. In each cell it, and each of its derivatives, is a polynomial and
// lies in the hull of its Bezier points, of which those at the corners are values of it. Where the hull goes further
// than what is known to be reached, the patch is halved: the hulls of its parts are closer by the square of their size.
#include "lang/ir/bounds/spline_image.h"
#include "lang/math/spline.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace haptel::ir {
namespace {

constexpr int64_t scan_max = 1024; // cells: wider places have the bounds of the whole image
constexpr int halvings_max = 4;
constexpr double near = 1.0 / 64; // of what is reached: not worth halving
// Of the few operations here and of those of spline(), whose weights sum up to at most 8 along each axis, by the
// largest coefficient.
constexpr double spline_rounding = 4e-13;

// Cells along one axis, of places in texels, and the coefficients that they are made of: cell c of c - 1 .. c + 2.
struct Axis {
    std::vector<int64_t> texel; // three more than cells
    double from, to;            // place in the first and in the last cell, 0 to 1

    Axis(const Interval& at, int64_t count, uint32_t edge)
    {
        const auto first = static_cast<int64_t>(std::floor(at.minimum)),
                   last = static_cast<int64_t>(std::floor(at.maximum));
        for (int64_t index = first - 1; index <= last + 2; ++index) texel.push_back(spline_texel(index, count, edge));
        from = std::clamp(at.minimum - static_cast<double>(first), 0.0, 1.0);
        to = std::clamp(at.maximum - static_cast<double>(last), 0.0, 1.0);
    }
    size_t cells() const { return texel.size() - 3; }
};

// Bezier points of the polynomial of this degree that four coefficients make: the spline or, of lower degree, one of
// its derivatives.
template <size_t degree>
using Points = std::array<double, degree + 1>;

template <size_t degree>
Points<degree> bezier(double a, double b, double c, double d)
{
    if constexpr (degree == 3) {
        const double left = (2 * b + c) / 3, right = (b + 2 * c) / 3;
        return {((a + 2 * b) / 3 + left) / 2, left, right, (right + (2 * c + d) / 3) / 2};
    } else if constexpr (degree == 2) {
        return {(c - a) / 2, c - b, (d - b) / 2};
    } else if constexpr (degree == 1) {
        return {(c - b) - (b - a), (d - c) - (c - b)};
    } else {
        return {(d - c) - 2 * (c - b) + (b - a)};
    }
}

// To the part of a cell that lies in there (de Casteljau, with a place of its own for each step).
template <size_t degree>
void cut(Points<degree>& points, const Axis& axis, size_t cell)
{
    const double from = cell == 0 ? axis.from : 0, to = cell + 1 == axis.cells() ? axis.to : 1;
    if (from == 0 && to == 1) return;
    const Points<degree> whole = points;
    for (size_t i = 0; i <= degree; ++i) {
        Points<degree> step = whole;
        for (size_t left = degree; left > 0; --left) {
            const double at = left > i ? from : to;
            for (size_t j = 0; j < left; ++j) step[j] = (1 - at) * step[j] + at * step[j + 1];
        }
        points[i] = step[0];
    }
}

template <size_t degree_x, size_t degree_y>
class Search {
public:
    Interval over(const haptel_image& image, uint32_t edge, const Axis& x, const Axis& y)
    {
        const int64_t stride = spline_stride(image.width, edge);
        std::vector<Points<degree_x>> lines[spline_support];
        for (auto& line : lines) line.resize(x.cells());
        halvings_left = 1000 + 2 * x.cells() * y.cells();
        for (size_t row = 0; row < y.texel.size(); ++row) {
            read(image.coefficients[edge] + y.texel[row] * stride, x, lines[row % spline_support]);
            if (row + 1 < spline_support) continue;
            const size_t cell = row + 1 - spline_support;
            const auto& a = lines[cell % 4];
            const auto& b = lines[(cell + 1) % 4];
            const auto& c = lines[(cell + 2) % 4];
            const auto& d = lines[(cell + 3) % 4];
            for (size_t i = 0; i < x.cells(); ++i) {
                Patch patch;
                for (size_t k = 0; k <= degree_x; ++k) {
                    patch[k] = bezier<degree_y>(a[i][k], b[i][k], c[i][k], d[i][k]);
                    cut<degree_y>(patch[k], y, cell);
                }
                look(patch, halvings_max);
            }
        }
        const double error = size == 0 ? 0 : size * spline_rounding + std::numeric_limits<double>::min();
        return {low - error, high + error};
    }

private:
    using Patch = std::array<Points<degree_y>, degree_x + 1>;

    void read(const double* coefficients, const Axis& x, std::vector<Points<degree_x>>& line)
    {
        double a = coefficients[x.texel[0]], b = coefficients[x.texel[1]], c = coefficients[x.texel[2]];
        size = std::max({size, std::fabs(a), std::fabs(b), std::fabs(c)});
        for (size_t i = 0; i < line.size(); ++i) {
            const double d = coefficients[x.texel[i + 3]];
            size = std::max(size, std::fabs(d));
            line[i] = bezier<degree_x>(a, b, c, d);
            cut<degree_x>(line[i], x, i);
            a = b, b = c, c = d;
        }
    }

    void look(const Patch& patch, int halvings)
    {
        double least = infinity, greatest = -infinity;
        for (const auto& points : patch)
            for (const double point : points) {
                least = point < least ? point : least;
                greatest = point > greatest ? point : greatest;
            }
        if (least >= low && greatest <= high) return;
        for (const Points<degree_y>* points : {&patch.front(), &patch.back()}) {
            reached_low = std::min({reached_low, points->front(), points->back()});
            reached_high = std::max({reached_high, points->front(), points->back()});
        }
        const double more = std::max((reached_high - reached_low) * near, size * spline_rounding);
        if (halvings == 0 || halvings_left == 0 || (least >= reached_low - more && greatest <= reached_high + more)) {
            low = std::min(low, least);
            high = std::max(high, greatest);
            return;
        }
        --halvings_left;
        halve_by_x(patch, halvings - 1);
    }

    // What is linear has its extremes at its ends: no half is closer than the whole.
    void halve_by_x(const Patch& patch, int halvings)
    {
        if constexpr (degree_x < 2) return halve_by_y(patch, halvings);
        Patch left, right = patch;
        for (size_t i = 0; i <= degree_x; ++i) {
            left[i] = right[0];
            for (size_t j = 0; j + i < degree_x; ++j)
                for (size_t k = 0; k <= degree_y; ++k) right[j][k] = (right[j][k] + right[j + 1][k]) / 2;
        }
        halve_by_y(left, halvings);
        halve_by_y(right, halvings);
    }
    void halve_by_y(const Patch& patch, int halvings)
    {
        if constexpr (degree_y < 2) return look(patch, degree_x < 2 ? 0 : halvings);
        Patch below, above = patch;
        for (size_t i = 0; i <= degree_y; ++i)
            for (size_t k = 0; k <= degree_x; ++k) {
                below[k][i] = above[k][0];
                for (size_t j = 0; j + i < degree_y; ++j) above[k][j] = (above[k][j] + above[k][j + 1]) / 2;
            }
        look(below, halvings);
        look(above, halvings);
    }

    double low = infinity, high = -infinity;                 // what is found
    double reached_low = infinity, reached_high = -infinity; // values at corners
    double size = 0;                                         // of the largest coefficient
    size_t halvings_left = 0; // so that a picture whose every cell goes further than the last one takes no hours
};

template <size_t order_x, size_t order_y>
Interval extremes_of(const haptel_image& image, uint32_t edge, const Axis& x, const Axis& y)
{
    return Search<3 - order_x, 3 - order_y>().over(image, edge, x, y);
}

// Everything that spline(image, x, y, orders) can be in there, its rounding included, and up to a few percent more.
Interval extremes(const haptel_image& image, const Interval& x, const Interval& y, uint32_t orders)
{
    static constexpr decltype(&extremes_of<0, 0>) by_order[4][4] = {
        {extremes_of<0, 0>, extremes_of<0, 1>, extremes_of<0, 2>, extremes_of<0, 3>},
        {extremes_of<1, 0>, extremes_of<1, 1>, extremes_of<1, 2>, extremes_of<1, 3>},
        {extremes_of<2, 0>, extremes_of<2, 1>, extremes_of<2, 2>, extremes_of<2, 3>},
        {extremes_of<3, 0>, extremes_of<3, 1>, extremes_of<3, 2>, extremes_of<3, 3>},
    };
    const uint32_t edge = spline_edge(orders);
    return by_order[spline_order_along(orders, 0)][spline_order_along(orders, 1)](
        image, edge, Axis(x, image.width, edge), Axis(y, image.height, edge));
}

// Where spline() looks for places in there, with the rounding of bringing them back into the image.
Interval places(const Interval& at, int64_t count, bool repeats)
{
    const auto size = static_cast<double>(count);
    const double low = repeats ? at.minimum : std::clamp(at.minimum, -3.0, size + 2);
    const double high = repeats ? at.maximum : std::clamp(at.maximum, -3.0, size + 2);
    const double rounding = 1e-15 * (2 * size + std::max(std::fabs(low), std::fabs(high)));
    return {low - rounding, high + rounding};
}

// How many there are, at most; infinite if that is too many.
double cells(const Interval& at)
{
    return size_of(at) < 1e9 ? at.maximum - at.minimum + 2 : infinity;
}

} // namespace

const Interval& SplineImage::over_all(uint32_t orders) const
{
    const uint32_t edge = spline_edge(orders);
    const uint32_t by_x = spline_order_along(orders, 0), by_y = spline_order_along(orders, 1);
    const haptel_image& image = view();
    Known& all = known[edge][by_x][by_y];
    std::call_once(all.asked, [&] {
        // beyond the image: where a tiled or mirrored one goes on and a clamped one becomes flat
        const auto range = [](int32_t count) { return Interval{-3.0, count + 2.0}; };
        all.found = extremes(image, range(image.width), range(image.height), orders);
        if (edge != HAPTEL_EDGE_MIRRORED || (by_x % 2 == 0 && by_y % 2 == 0)) return;
        const double size = size_of(all.found);
        all.found = {-size, size}; // in the copies that are turned round
    });
    return all.found;
}

Interval SplineImage::bounds(const Interval& x, const Interval& y, uint32_t orders) const
{
    if (x.is_empty() || y.is_empty()) return no_number;
    const bool repeats = spline_edge(orders) != HAPTEL_EDGE_CLAMPED;
    const bool may_be_nan =
        x.may_be_nan || y.may_be_nan ||
        (repeats && !(std::isfinite(x.maximum - x.minimum) && std::isfinite(y.maximum - y.minimum)));
    if (spline_order_along(orders, 0) > 3 || spline_order_along(orders, 1) > 3) return {0, 0, may_be_nan};

    const haptel_image& image = view();
    const Interval columns = places(x, image.width, repeats), rows = places(y, image.height, repeats);
    const bool is_wide = cells(columns) * cells(rows) > scan_max;
    Interval found = is_wide ? over_all(orders) : extremes(image, columns, rows, orders);
    found.may_be_nan = may_be_nan;
    return found;
}

} // namespace haptel::ir
