#include "tools/plot/plot_pixels.h"

#include "tools/plot/plot_axes.h"
#include "tools/plot/plot_grid.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <vector>

namespace haptel::tools::plot {

namespace {

// 0 .. 1, the same in each run.
double random_share(uint64_t number)
{
    uint64_t x = number + 0x9E3779B97F4A7C15u; // splitmix64
    x = (x ^ x >> 30) * 0xBF58476D1CE4E5B9u;
    x = (x ^ x >> 27) * 0x94D049BB133111EBu;
    return static_cast<double>((x ^ x >> 31) >> 11) * 0x1p-53;
}

// A slope as it is seen lit: what is steeper than what is exaggerated for looks all the same, so that the edges of a
// hole do not count for all of the rest.
glm::dvec3 value_of(const haptel_sample& sample, Shown what, double exaggeration)
{
    if (what == Shown::height) return {sample.height_m, 0, 0};
    const glm::dvec3 seen = exaggeration * glm::dvec3(sample.gradient[0], sample.gradient[1], sample.gradient[2]);
    return seen / std::sqrt(1 + glm::dot(seen, seen));
}

// How much the texture changes over a distance along an axis, by its variance: 1 - cos(2 pi distance / length) for
// waves of one length, 1 for what has nothing in common any more.
double change_over(const Canvas& canvas, Shown what, int axis, double distance_m)
{
    constexpr int pairs = 1000; // the mean is right to some 4 %
    std::vector<haptel_point> points;
    for (uint64_t i = 0; i < pairs; ++i) {
        glm::dvec2 at(random_share(2 * i) - 0.5, random_share(2 * i + 1) - 0.5);
        at *= canvas.side_m;
        const auto first = canvas.point(at);
        at[axis] += distance_m;
        const auto second = canvas.point(at);
        if (!first || !second) continue;
        points.push_back(*first);
        points.push_back(*second);
    }
    std::vector<haptel_sample> samples(points.size());
    canvas.samples(points, samples);
    Range slopes;
    for (const haptel_sample& sample : samples) slopes.add(slope_of(sample));
    const double steeper = exaggeration_for(slopes.rms());
    glm::dvec3 mean(0);
    double changes = 0, count = 0, variance = 0;
    const auto for_each_pair = [&](const auto& visit) {
        for (std::size_t i = 0; i < samples.size(); i += 2)
            if (!samples[i].faults && !samples[i + 1].faults)
                visit(value_of(samples[i], what, steeper), value_of(samples[i + 1], what, steeper));
    };
    for_each_pair(
        [&](const glm::dvec3& a, const glm::dvec3& b) { mean += a, changes += glm::dot(b - a, b - a), ++count; });
    if (count == 0) return 0;
    mean /= count;
    for_each_pair([&](const glm::dvec3& a, const glm::dvec3&) { variance += glm::dot(a - mean, a - mean) / count; });
    // What is the same everywhere but for rounding has no features.
    return variance > 1e-28 * glm::dot(mean, mean) ? changes / count / (2 * variance) : 0;
}

} // namespace

Canvas canvas_of(const TextureView& view, int pixels)
{
    return {view.window_m, pixels,
            [&view](const glm::dvec2& at) { return view.on_plane(view.center_m + glm::dvec3(at, 0)); }, view.samples};
}

Fineness fineness(const Canvas& canvas, Shown what)
{
    constexpr int to_a_wave = 8;
    const double most = 1 - std::cos(2 * std::numbers::pi / to_a_wave);
    // From the finest up: a distance of a whole wave would look like none.
    Fineness found{0, samples_most};
    for (int axis = 0; axis < 2; ++axis) {
        constexpr double finer = std::numbers::sqrt2;
        double step_m = canvas.pixel_m() / (4 * samples_most);
        while (step_m < canvas.side_m / to_a_wave && change_over(canvas, what, axis, step_m) <= most) step_m *= finer;
        const double length_m = to_a_wave * step_m / finer;
        found.feature_m = axis == 0 ? length_m : std::min(found.feature_m, length_m);
    }
    const double needed = std::ceil(4 * canvas.pixel_m() / found.feature_m);
    found.each_way = static_cast<int>(std::clamp(needed, 1.0, double{samples_most}));
    return found;
}

std::string averaged(const Fineness& fine)
{
    return fmt::format("{} samples averaged per pixel", fine.each_way * fine.each_way);
}

void tell_fineness(const TextureView& view, const Canvas& canvas, const Fineness& fine, const std::string& done,
                   std::string_view pixels)
{
    if (!view.say || fine.each_way <= samples_per_pixel) return;
    // Four pixels to a wave, by a length of one digit.
    const double shows_m = fine.feature_m / 4 * canvas.pixels;
    const double digit_m = std::pow(10, std::floor(std::log10(shows_m)));
    view.say(fmt::format("features of {}{} are finer than two {} of {}: {}; zoom with {} to see them",
                         fine.each_way < samples_most ? "" : "at most ", length_text(fine.feature_m), pixels,
                         length_text(canvas.pixel_m()), done,
                         (view.section_m ? "a --section of " : "--window ") +
                             fmt::format("{:g}mm", 1e3 * digit_m * std::max(std::floor(shows_m / digit_m), 1.0))));
}

void for_each_pixel(const Canvas& canvas, int samples_each_way, const std::function<void(const PixelSamples&)>& draw)
{
    const int n = canvas.pixels, fine = samples_each_way;
    const double part_m = canvas.pixel_m() / fine;
    for_each_row(n, [&](int row) {
        std::vector<haptel_point> points;
        std::vector<std::size_t> ends; // of each pixel
        for (int column = 0; column < n; ++column) {
            for (int part = 0; part < fine * fine; ++part) {
                const auto sample = ((static_cast<uint64_t>(row) * n + column) * fine * fine + part) * 2;
                const auto within = [&](uint64_t which) { return fine > 2 ? random_share(sample + which) : 0.5; };
                const double right = column * fine + part % fine + within(0),
                             down = row * fine + part / fine + within(1);
                const auto point =
                    canvas.point({right * part_m - canvas.side_m / 2, canvas.side_m / 2 - down * part_m});
                if (point) points.push_back(*point);
            }
            ends.push_back(points.size());
        }
        std::vector<haptel_sample> samples(points.size());
        canvas.samples(points, samples);
        std::size_t begin = 0;
        for (int column = 0; column < n; ++column) {
            const std::size_t count = ends[static_cast<std::size_t>(column)] - begin;
            draw({column, row, std::span(points).subspan(begin, count), std::span(samples).subspan(begin, count),
                  fine * fine - static_cast<int>(count)});
            begin += count;
        }
    });
}

} // namespace haptel::tools::plot
