#include "jit/fit/height_misfit.h"

#include <cmath>
#include <numeric>

namespace haptel::jit {

void centre(std::span<double> values)
{
    const double mean = std::reduce(values.begin(), values.end()) / static_cast<double>(values.size());
    for (double& value : values) value -= mean;
}

HeightMisfit::HeightMisfit(const ParameterGradient& of, std::span<const haptel_point> at,
                           std::span<const double> heights_m)
    : texture(of), points(at), measured_m(heights_m.begin(), heights_m.end()), made_m(heights_m.size())
{
    centre(measured_m);
    const double square = std::transform_reduce(measured_m.begin(), measured_m.end(), measured_m.begin(), 0.0);
    scale_m = std::sqrt(square / static_cast<double>(measured_m.size()));
}

void HeightMisfit::residuals(const void* block, std::span<double> rows)
{
    texture.heights(points, block, rows);
    centre(rows);
    for (std::size_t i = 0; i < rows.size(); ++i) rows[i] -= measured_m[i];
}

void HeightMisfit::gradient(const void* block, std::span<double> rows, std::span<double> by_parameters)
{
    texture.gradient(points, block, rows, by_parameters);
    centre(rows);
    for (std::size_t i = 0; i < rows.size(); ++i) rows[i] -= measured_m[i];
    for (std::size_t first = 0; first < by_parameters.size(); first += rows.size())
        centre(by_parameters.subspan(first, rows.size()));
}

double HeightMisfit::unlikeness(const void* block)
{
    texture.heights(points, block, made_m);
    centre(made_m);
    const double made = std::transform_reduce(made_m.begin(), made_m.end(), made_m.begin(), 0.0),
                 both = std::transform_reduce(made_m.begin(), made_m.end(), measured_m.begin(), 0.0),
                 measured = scale_m * scale_m * static_cast<double>(made_m.size());
    if (made == 0 || measured == 0) return 1;
    return both < 0 ? 1 : 1 - both * both / (made * measured);
}

} // namespace haptel::jit
