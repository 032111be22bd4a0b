// Heights measured at points of a texture: what no height map knows, where its zero is, does not count.
#pragma once

#include "jit/fit/misfit.h"
#include "jit/fit/parameter_gradient.h"

#include <vector>

namespace haptel::jit {

class HeightMisfit final : public Misfit {
public:
    HeightMisfit(const ParameterGradient& texture, std::span<const haptel_point> points,
                 std::span<const double> heights_m);
    std::size_t rows() const override { return measured_m.size(); }
    void residuals(const void* block, std::span<double> rows) override;
    void gradient(const void* block, std::span<double> rows, std::span<double> by_parameters) override;
    double unlikeness(const void* block) override; // 1 - the square of the correlation
    double scale() const override { return scale_m; }

private:
    const ParameterGradient& texture;
    const PointArrays points;
    std::vector<double> measured_m, made_m; // the mean of the former is 0
    double scale_m = 0;
};

// Takes the mean away.
void centre(std::span<double> values);

} // namespace haptel::jit
