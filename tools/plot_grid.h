// A texture's samples over the window that is drawn, taken by all of the machine's processors.
#pragma once

#include "tools/plot_texture.h"

#include <cmath>
#include <limits>
#include <vector>

namespace haptel::tools::plot {

// Smallest, largest, root mean square and mean of finite values.
struct Range {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    double sum = 0, squares = 0, count = 0;
    void add(double value)
    {
        if (!std::isfinite(value)) return;
        low = std::min(low, value), high = std::max(high, value);
        sum += value, squares += value * value, ++count;
    }
    double mean() const { return count > 0 ? sum / count : 0; }
    double rms() const { return count > 0 ? std::sqrt(squares / count) : 0; }
    double deviation() const { return count > 0 ? std::sqrt(std::max(squares / count - mean() * mean(), 0.0)) : 0; }
};

double slope_of(const haptel_sample& sample);

std::vector<haptel_sample> samples_at(const TextureView& view, std::span<const glm::dvec3> points_m);

// Samples at the centres of `columns` x `rows` equal cells of the window, the upper left one first.
class Grid {
public:
    Grid(const TextureView& view, int columns, int rows);
    const haptel_sample& at(int column, int row) const { return samples_[index(column, row)]; }
    glm::dvec3 point(int column, int row) const;

    Range height, slope;

private:
    std::size_t index(int column, int row) const
    {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column);
    }
    glm::dvec3 center_m_;
    double window_m_;
    int columns_, rows_;
    std::vector<haptel_sample> samples_;
};

} // namespace haptel::tools::plot
