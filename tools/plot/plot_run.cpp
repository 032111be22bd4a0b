#include "tools/plot/plot_run.h"

#include "tools/plot/plot_axes.h"
#include "tools/plot/plot_colors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <vector>

namespace haptel::tools::plot {

namespace {

using runtime::TickRecord;

constexpr double sharpness = 2; // pixels per point

double force_of(const TickRecord& tick)
{
    return glm::length(tick.force_n);
}

// Values over time as one connected line that spends at most four points on a pixel column: first, extremes, last.
template <typename Value>
std::vector<Point> reduced(std::span<const TickRecord> ticks, const Axes& axes, Value&& value)
{
    std::vector<Point> points;
    for (std::size_t i = 0; i < ticks.size();) {
        const double column = std::floor(axes.at(ticks[i].time_s, 0).x * sharpness);
        Point low{0, HUGE_VAL}, high{0, -HUGE_VAL}, last;
        std::size_t j = i;
        for (; j < ticks.size(); ++j) {
            last = axes.at(ticks[j].time_s, value(ticks[j]));
            if (std::floor(last.x * sharpness) != column) break;
            if (j == i) points.push_back(last);
            if (last.y < low.y) low = last;
            if (last.y > high.y) high = last;
        }
        const bool low_first = low.x < high.x;
        points.push_back(low_first ? low : high);
        points.push_back(low_first ? high : low);
        i = std::max(j, i + 1);
    }
    return points;
}

void draw_panel(Picture& picture, const Axes& axes, const std::vector<Point>& line, const Color& color, bool x_labels)
{
    AxesStyle style;
    style.x_labels = x_labels;
    style.x_ticks = 10;
    draw_grid(picture, axes, style);
    picture.begin_clip(axes.rect);
    picture.polyline(line, color, 0.9);
    picture.end_clip();
    draw_axes(picture, axes, style);
}

// Less than 2 % of the ticks in contact have less: beginnings and ends of touches do not take the colours from the
// rest.
double usual_least_force(std::span<const TickRecord> ticks)
{
    std::vector<double> forces;
    for (const TickRecord& tick : ticks)
        if (tick.contact != 0) forces.push_back(force_of(tick));
    if (forces.empty()) return 0;
    const auto least = forces.begin() + static_cast<std::ptrdiff_t>(forces.size() / 50);
    std::nth_element(forces.begin(), least, forces.end());
    return *least;
}

// Grey relief of the textured surface; pale, so that the path stands out.
Image relief(const Axes& axes, const NormalBelow& surface, double metres_per_unit, int columns, int rows)
{
    static const glm::dvec3 light = glm::normalize(glm::dvec3(-0.55, 0.6, 0.75));
    Image image(columns, rows);
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column) {
            Color& pixel = image.at(column, row);
            pixel = {1, 1, 1};
            const double x = axes.x.low + (axes.x.high - axes.x.low) * (column + 0.5) / columns;
            const double y = axes.y.high - (axes.y.high - axes.y.low) * (row + 0.5) / rows;
            if (!surface) continue;
            if (const auto normal = surface(x * metres_per_unit, y * metres_per_unit)) {
                const double shade = 0.62 + 0.33 * std::max(glm::dot(*normal, light), 0.0);
                pixel = {shade, shade, shade};
            }
        }
    return image;
}

} // namespace

Picture draw_force(std::span<const TickRecord> ticks, const std::string& title, double force_limit_n)
{
    Picture picture(640, 400, sharpness);
    double force_max_n = 0, depth_max_m = 0, depth_min_m = 0, seconds = 1e-3, squares = 0;
    std::size_t contact = 0;
    for (const TickRecord& tick : ticks) {
        force_max_n = std::max(force_max_n, force_of(tick));
        depth_max_m = std::max(depth_max_m, tick.depth_m);
        depth_min_m = std::min(depth_min_m, tick.depth_m);
        seconds = std::max(seconds, tick.time_s);
        squares += force_of(tick) * force_of(tick);
        contact += tick.contact != 0;
    }
    const Axis time{"time (s)", 0, seconds};
    const LengthUnit unit = length_unit(depth_max_m);
    Axis force = fitted("force (N)", 0, force_max_n);
    force.low = 0;
    const Axes upper{{62, 52, 558, 178}, time, force};
    const Axes lower{{62, 246, 558, 104},
                     time,
                     fitted(fmt::format("depth ({})", unit.name), depth_min_m * unit.per_m, depth_max_m * unit.per_m)};
    draw_panel(picture, upper, reduced(ticks, upper, force_of), accent, false);
    if (force_limit_n <= force.high) {
        const double y = upper.at(0, force_limit_n).y;
        picture.line({upper.rect.x, y}, {upper.rect.right(), y}, accent_2, 0.8);
        picture.text({upper.rect.right() - 4, y - 4}, "limit", {8, accent_2, Align::right});
    }
    draw_panel(picture, lower, reduced(ticks, lower, [&](const TickRecord& tick) { return tick.depth_m * unit.per_m; }),
               quiet, true);
    const double count = static_cast<double>(std::max<std::size_t>(ticks.size(), 1));
    draw_title(picture, title,
               fmt::format("force on the hand, depth below the base surface   rms {:.3g} N  ·  largest {:.3g} N  ·  "
                           "{:.0f} % of {} ticks "
                           "in contact",
                           std::sqrt(squares / count), force_max_n, 100 * static_cast<double>(contact) / count,
                           ticks.size()));
    return picture;
}

Picture draw_path(std::span<const TickRecord> ticks, const std::string& title, const NormalBelow& surface)
{
    Picture picture(512, 512, sharpness);
    glm::dvec2 low(HUGE_VAL), high(-HUGE_VAL);
    double force_max_n = 0;
    for (const TickRecord& tick : ticks) {
        low = glm::min(low, glm::dvec2(tick.tip_m));
        high = glm::max(high, glm::dvec2(tick.tip_m));
        force_max_n = std::max(force_max_n, force_of(tick));
    }
    if (ticks.empty()) low = glm::dvec2(0), high = glm::dvec2(0);
    const glm::dvec2 middle = (low + high) / 2.0;
    const double side_m = std::max(1.7 * std::max(high.x - low.x, high.y - low.y), 1e-3);
    const LengthUnit unit = length_unit(side_m);
    const auto axis = [&](const char* name, double center) {
        return Axis{fmt::format("{} ({})", name, unit.name), (center - side_m / 2) * unit.per_m,
                    (center + side_m / 2) * unit.per_m};
    };
    const Axes axes{{60, 58, 384, 384}, axis("x", middle.x), axis("y", middle.y)};
    const int pixels = static_cast<int>(axes.rect.width * sharpness);
    picture.image(axes.rect, relief(axes, surface, 1 / unit.per_m, pixels, pixels));

    const Axis force = fitted("force (N)", usual_least_force(ticks), force_max_n);
    picture.begin_clip(axes.rect);
    for (std::size_t i = 1; i < ticks.size(); ++i) {
        const auto at = [&](const TickRecord& tick) {
            return axes.at(tick.tip_m.x * unit.per_m, tick.tip_m.y * unit.per_m);
        };
        const bool touching = ticks[i].contact != 0;
        picture.line(at(ticks[i - 1]), at(ticks[i]),
                     touching ? viridis(force.share(force_of(ticks[i]))) : Color{1, 1, 1, 0.8}, touching ? 2 : 0.7);
    }
    picture.end_clip();
    draw_axes(picture, axes);
    draw_color_bar(picture, {axes.rect.right() + 10, axes.rect.y, 9, axes.rect.height}, force, viridis);
    draw_title(
        picture, title,
        "path of the tip from above (+z), coloured by force, over the texture in relief; pale where it did not touch");
    return picture;
}

Picture draw_tick_histogram(const runtime::Histogram& tick_ns, const std::string& title, double period_s)
{
    Picture picture(512, 360, sharpness);
    const double median_us = static_cast<double>(tick_ns.percentile(0.5)) / 1e3;
    const double p99_us = static_cast<double>(tick_ns.percentile(0.99)) / 1e3;
    const double max_us = static_cast<double>(tick_ns.maximum()) / 1e3;

    // Ten bars to a decade: the histogram's own buckets are finer than the eye wants.
    constexpr int bars_per_decade = 10, decades = 8; // from 10 ns
    constexpr double first_us = 0.01;
    std::array<double, bars_per_decade * decades> bars{};
    double low_us = HUGE_VAL;
    tick_ns.for_each([&](uint64_t first, uint64_t last, uint64_t count) {
        const double us = std::max((static_cast<double>(first) + static_cast<double>(last)) / 2e3, first_us);
        const auto bar = static_cast<std::size_t>(std::log10(us / first_us) * bars_per_decade);
        bars[std::min(bar, bars.size() - 1)] += static_cast<double>(count);
        low_us = std::min(low_us, us);
    });
    const double tallest = std::max(*std::max_element(bars.begin(), bars.end()), 1.0);
    const auto decade = [](double value, bool up) {
        return std::pow(10, up ? std::ceil(std::log10(value) + 1e-9) : std::floor(std::log10(value)));
    };
    const Axes axes{{62, 52, 430, 258},
                    {"time from pose to force (µs)", decade(std::isfinite(low_us) ? low_us : 1, false),
                     std::max(decade(std::max({max_us, period_s * 1e6, 1.0}), true), 10.0), true},
                    {"ticks", 0.5, decade(tallest, true), true}};
    draw_grid(picture, axes);
    for (std::size_t i = 0; i < bars.size(); ++i) {
        if (bars[i] == 0) continue;
        const double from_us = first_us * std::pow(10, static_cast<double>(i) / bars_per_decade);
        const Point left = axes.at(from_us, bars[i]),
                    right = axes.at(from_us * std::pow(10, 1.0 / bars_per_decade), 0.5);
        picture.fill({left.x + 0.5, left.y, right.x - left.x - 1, right.y - left.y}, {0.30, 0.52, 0.74});
    }
    const auto mark = [&](double us, const std::string& name, Align align, const Color& color) {
        if (!(us > axes.x.low && us < axes.x.high)) return;
        const double x = axes.at(us, 1).x;
        picture.line({x, axes.rect.y}, {x, axes.rect.bottom()}, color, 1);
        picture.text({x + (align == Align::left ? 4 : -4), axes.rect.y + 11}, name, {8, color, align});
    };
    mark(median_us, "median", Align::right, ink);
    mark(p99_us, "p99", Align::left, accent_2);
    mark(period_s * 1e6, "period", Align::left, quiet);
    draw_axes(picture, axes);
    draw_title(picture, title,
               fmt::format("tick time of {} ticks   median {:.1f} µs  ·  p99 {:.1f} µs  ·  longest {:.1f} µs",
                           tick_ns.count(), median_us, p99_us, max_us));
    return picture;
}

} // namespace haptel::tools::plot
