#include "tools/plot/plot_section.h"

#include "tools/plot/plot_axes.h"
#include "tools/plot/plot_faults.h"
#include "tools/plot/plot_grid.h"
#include "tools/plot/plot_pixels.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <vector>

namespace haptel::tools::plot {

namespace {

constexpr Rect upper_rect{66, 58, 424, 196}, lower_rect{66, 270, 424, 196};

struct Line {
    glm::dvec3 from_m, direction; // of length 1
    double length_m, first_m;     // first_m: what the axis calls its beginning
    bool is_along_x;
};

Line line_of(const TextureView& view)
{
    if (!view.section_m)
        return {view.center_m - glm::dvec3(view.window_m / 2, 0, 0),
                {1, 0, 0},
                view.window_m,
                view.center_m.x - view.window_m / 2,
                true};
    const auto& [from_m, to_m] = *view.section_m;
    return {from_m, glm::normalize(to_m - from_m), glm::distance(from_m, to_m), 0, false};
}

// A place of the line and what is found there.
struct Along {
    double at_m, height_m, slope;
    uint32_t faults;
};

double slope_along(const haptel_sample& sample, const glm::dvec3& direction)
{
    return glm::dot(glm::dvec3(sample.gradient[0], sample.gradient[1], sample.gradient[2]), direction);
}

// Of the values of one column of pixels those that an eye can tell apart: the first, the extremes, the last.
template <typename Value>
std::vector<Along> reduced(const std::vector<Along>& all, std::size_t per_column, const Value& value)
{
    std::vector<Along> kept;
    for (std::size_t begin = 0; begin < all.size(); begin += per_column) {
        const auto first = all.begin() + static_cast<std::ptrdiff_t>(begin);
        const auto end = all.begin() + static_cast<std::ptrdiff_t>(std::min(begin + per_column, all.size()));
        auto [low, high] =
            std::minmax_element(first, end, [&](const Along& a, const Along& b) { return value(a) < value(b); });
        if (high < low) std::swap(low, high);
        for (const auto& one : {first, low, high, end - 1}) kept.push_back(*one);
    }
    return kept;
}

std::string point_text(const glm::dvec3& p_m)
{
    return fmt::format("({:.3g}, {:.3g}, {:.3g}) mm", 1e3 * p_m.x, 1e3 * p_m.y, 1e3 * p_m.z);
}

} // namespace

Picture draw_section(const TextureView& view)
{
    Picture picture(512, 512, view.size_px / 512.0);
    const Line line = line_of(view);
    // As many as a pixel needs, and no fewer than make a smooth curve.
    const int columns = std::max(1, static_cast<int>(std::lround(upper_rect.width * picture.pixels_per_point())));
    Canvas canvas = canvas_of(view, columns);
    canvas.side_m = line.length_m;
    canvas.point = [&](const glm::dvec2& at) {
        return view.on_plane(line.from_m + (at.x + line.length_m / 2) * line.direction);
    };
    canvas.samples = [&](std::span<const haptel_point> points, std::span<haptel_sample> samples) {
        view.samples(points, samples);
        for (haptel_sample& sample : samples) { // across the line it is of no concern
            const glm::dvec3 along = slope_along(sample, line.direction) * line.direction;
            for (int i = 0; i < 3; ++i) sample.gradient[i] = along[i];
        }
    };
    const Fineness fine = fineness(canvas, Shown::gradient);
    constexpr int least = 4000;
    const int per_column = std::max(least / columns + 1, fine.each_way);

    std::vector<glm::dvec3> points_m;
    const int count = columns * per_column;
    for (int i = 0; i <= count; ++i) points_m.push_back(line.from_m + line.length_m * i / count * line.direction);
    Range heights, slopes;
    std::vector<Along> all;
    double faulty = 0;
    uint32_t faults = 0;
    for (const haptel_sample& sample : samples_at(view, points_m)) {
        const double share = static_cast<double>(all.size()) / count;
        all.push_back({line.first_m + line.length_m * share, sample.height_m, slope_along(sample, line.direction),
                       sample.faults});
        faulty += sample.faults != 0, faults |= sample.faults;
        if (sample.faults) continue;
        heights.add(all.back().height_m);
        slopes.add(all.back().slope);
    }
    faulty /= count + 1;
    if (heights.count == 0) heights.add(0), slopes.add(0);

    const LengthUnit unit = length_unit(std::max(std::abs(heights.low), std::abs(heights.high)));
    const LengthUnit along = length_unit(line.length_m);
    const Axis x{fmt::format("{} ({})", line.is_along_x ? "x" : "along the section", along.name),
                 line.first_m * along.per_m, (line.first_m + line.length_m) * along.per_m};
    const Axes upper{
        upper_rect, x,
        fitted(fmt::format("height ({})", unit.name), heights.low * unit.per_m, heights.high * unit.per_m)};
    const Axes lower{lower_rect, x,
                     fitted(line.is_along_x ? "slope dh/dx" : "slope along it", slopes.low, slopes.high)};
    const auto draw = [&](const Axes& axes, double Along::* value, double per_unit, const Color& color, bool x_labels) {
        AxesStyle style;
        style.x_labels = x_labels;
        draw_grid(picture, axes, style);
        picture.begin_clip(axes.rect);
        for (const Along& one : all)
            if (one.faults) {
                const double at = axes.at(one.at_m * along.per_m, 0).x;
                const int column = static_cast<int>(at * picture.pixels_per_point());
                for (double y = axes.rect.y; y < axes.rect.bottom(); y += 1 / picture.pixels_per_point())
                    picture.fill({at, y, 1 / picture.pixels_per_point(), 1 / picture.pixels_per_point()},
                                 hatch(picture, column, static_cast<int>(y * picture.pixels_per_point())));
            }
        std::vector<Point> points; // up to the next fault
        const auto draw_points = [&] {
            picture.polyline(points, color, 1.2);
            points.clear();
        };
        for (const Along& one :
             reduced(all, static_cast<std::size_t>(per_column), [&](const Along& a) { return a.*value; })) {
            if (one.faults)
                draw_points();
            else
                points.push_back(axes.at(one.at_m * along.per_m, one.*value * per_unit));
        }
        draw_points();
        picture.end_clip();
        draw_axes(picture, axes, style);
    };
    draw(upper, &Along::height_m, unit.per_m, accent, false);
    draw(lower, &Along::slope, 1, accent_2, true);
    const std::string where =
        line.is_along_x
            ? fmt::format("at y = {:.4g} {}", view.center_m.y * along.per_m, along.name)
            : "from " + point_text(line.from_m) + " to " + point_text(line.from_m + line.length_m * line.direction);
    draw_title(picture, view.title,
               fmt::format("section {}   {}{}", where,
                           line.is_along_x ? statistics(heights, slopes)
                                           : "peak to valley " + length_text(heights.high - heights.low),
                           faults_text(faulty)));
    tell_faults(view, faulty, faults);
    tell_fineness(view, canvas, fine, fmt::format("each pixel shows the range of {} samples", per_column));
    return picture;
}

} // namespace haptel::tools::plot
