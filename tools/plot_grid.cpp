#include "tools/plot_grid.h"

#include "tools/terminal.h"

#include <atomic>
#include <thread>

namespace haptel::tools::plot {

double slope_of(const haptel_sample& sample)
{
    return std::hypot(sample.gradient[0], sample.gradient[1]);
}

std::vector<haptel_sample> samples_at(const TextureView& view, std::span<const glm::dvec3> points_m)
{
    std::vector<haptel_sample> samples(points_m.size());
    view.samples(points_m, samples);
    return samples;
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
    std::atomic<int> next_row = 0;
    const auto draw_rows = [&](Progress* progress) {
        std::vector<glm::dvec3> points(static_cast<std::size_t>(columns));
        for (int row = next_row++; row < rows; row = next_row++) {
            for (int column = 0; column < columns; ++column)
                points[static_cast<std::size_t>(column)] = point(column, row);
            view.samples(points, std::span(samples_).subspan(index(0, row), points.size()));
            if (progress) progress->show(static_cast<double>(row) / rows);
        }
    };
    {
        std::vector<std::jthread> others;
        for (unsigned i = 1; i < std::thread::hardware_concurrency(); ++i) others.emplace_back(draw_rows, nullptr);
        Progress progress;
        draw_rows(&progress);
    }
    for (const haptel_sample& sample : samples_) {
        height.add(sample.height_m);
        slope.add(slope_of(sample));
    }
}

} // namespace haptel::tools::plot
