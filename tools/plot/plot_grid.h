// A texture's samples over the window that is drawn, taken by all of the machine's processors, and how they look lit.
#pragma once

#include "tools/plot/plot_texture.h"

#include <cmath>
#include <functional>
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

// "peak to valley 50 µm  ·  rms ...": for a subtitle.
std::string statistics(const Range& height, const Range& slope);

std::vector<haptel_sample> samples_at(const TextureView& view, std::span<const glm::dvec3> points_m);

// The colour of stone whose outward normal this is (any length), seen from +z and lit from the upper left.
Color lit(const glm::dvec3& normal);

// Slopes of fine textures are too small to see: they are drawn 1, 2, 5, 10 ... times as steep, as long as they stay
// within reason.
double exaggeration_for(double slope_rms);

constexpr int samples_per_pixel = 2; // each way

// Shared out among the processors; long ones show how far they are.
void for_each_row(int rows, const std::function<void(int)>& draw);

// Samples at the centres of `columns` x `rows` equal cells of the window, the upper left one first.
class Grid {
public:
    Grid(const TextureView& view, int columns, int rows);
    const haptel_sample& at(int column, int row) const { return samples_[index(column, row)]; }
    glm::dvec3 point(int column, int row) const;

    Range height, slope; // where they are no fault
    double faulty = 0;   // share of the samples with a fault, and
    uint32_t faults = 0; // all of them

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
