#include "tools/plot/plot_grid.h"

#include "tools/output/terminal.h"
#include "tools/plot/plot_axes.h"

#include <algorithm>
#include <atomic>
#include <fmt/format.h>
#include <thread>

namespace haptel::tools::plot {

namespace {

constexpr uint32_t not_felt = HAPTEL_FAULT_HEIGHT_NOT_FINITE | HAPTEL_FAULT_GRADIENT_NOT_FINITE; // the gradient

} // namespace

double slope_of(const haptel_sample& sample)
{
    return std::hypot(sample.gradient[0], sample.gradient[1]);
}

std::string statistics(const Range& height, const Range& slope)
{
    const double steepest = std::max(std::abs(slope.low), std::abs(slope.high));
    return fmt::format("peak to valley {}  ·  rms {}  ·  slope rms {:.3g}, largest {:.3g}",
                       length_text(height.high - height.low), length_text(height.deviation()), slope.rms(), steepest);
}

Color lit(const glm::dvec3& normal)
{
    static const glm::dvec3 light = glm::normalize(glm::dvec3(-0.55, 0.6, 0.75)), eye(0, 0, 1);
    const glm::dvec3 n = glm::normalize(normal);
    const double diffuse = std::max(glm::dot(n, light), 0.0);
    const double gloss = std::pow(std::max(glm::dot(n, glm::normalize(light + eye)), 0.0), 30);
    const double shade = 0.16 + 0.92 * diffuse;
    return {0.90 * shade + 0.10 * gloss, 0.83 * shade + 0.10 * gloss, 0.73 * shade + 0.10 * gloss};
}

double exaggeration_for(double slope_rms)
{
    double factor = 1;
    if (!(slope_rms > 0)) return factor;
    for (int i = 0; i < 15; ++i) {
        const double steeper = factor * (i % 3 == 1 ? 2.5 : 2);
        if (slope_rms * steeper > 0.3) break;
        factor = steeper;
    }
    return factor;
}

std::vector<haptel_sample> samples_at(const TextureView& view, std::span<const glm::dvec3> points_m)
{
    std::vector<haptel_point> points;
    for (const glm::dvec3& p : points_m) points.push_back(view.on_plane(p));
    std::vector<haptel_sample> samples(points.size());
    view.samples(points, samples);
    return samples;
}

void for_each_row(int rows, const std::function<void(int)>& draw)
{
    std::atomic<int> next_row = 0;
    const auto draw_rows = [&](Progress* progress) {
        for (int row = next_row++; row < rows; row = next_row++) {
            draw(row);
            if (progress) progress->show(static_cast<double>(row) / rows);
        }
    };
    std::vector<std::jthread> others;
    for (unsigned i = 1; i < std::thread::hardware_concurrency(); ++i) others.emplace_back(draw_rows, nullptr);
    Progress progress;
    draw_rows(&progress);
}

glm::dvec3 Grid::point(int column, int row) const
{
    const glm::dvec2 share((column + 0.5) / columns_ - 0.5, 0.5 - (row + 0.5) / rows_);
    return center_m_ + glm::dvec3(share * window_m_, 0);
}

Grid::Grid(const TextureView& view, int columns, int rows)
    : center_m_(view.center_m)
    , window_m_(view.window_m)
    , columns_(columns)
    , rows_(rows)
    , samples_(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows))
{
    for_each_row(rows, [&](int row) {
        std::vector<haptel_point> points;
        for (int column = 0; column < columns; ++column) points.push_back(view.on_plane(point(column, row)));
        view.samples(points, std::span(samples_).subspan(index(0, row), points.size()));
    });
    for (const haptel_sample& sample : samples_) {
        if (!(sample.faults & HAPTEL_FAULT_HEIGHT_NOT_FINITE)) height.add(sample.height_m);
        if (!(sample.faults & not_felt)) slope.add(slope_of(sample));
        faulty += sample.faults != 0;
        faults |= sample.faults;
    }
    faulty /= static_cast<double>(samples_.size());
}

} // namespace haptel::tools::plot
