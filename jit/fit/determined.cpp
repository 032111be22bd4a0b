#include "jit/fit/determined.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Core>
#include <Eigen/SVD>
#include <fmt/format.h>

namespace haptel::jit {

namespace {

constexpr double told = 0.01; // a parameter is known where its value is known to 1 %

// Standard deviations of the real unknowns, in their own units, if each row is off by the misfit at random; infinite
// where a parameter could move without any row.
std::vector<double> deviations(Unknowns& unknowns, Misfit& misfit, const Found& best)
{
    const auto rows = static_cast<Eigen::Index>(misfit.rows()),
               columns = static_cast<Eigen::Index>(unknowns.reals.size());
    std::vector<double> left(misfit.rows());
    Eigen::MatrixXd jacobian(rows, columns);
    misfit.gradient(unknowns.block(best.guess), left, {jacobian.data(), static_cast<std::size_t>(rows * columns)});
    for (Eigen::Index j = 0; j < columns; ++j) {
        const auto at = static_cast<std::size_t>(j);
        jacobian.col(j) *= unknowns.reals[at].slope(best.guess.coordinates[at]);
    }
    const double noise = std::max(best.misfit, misfit_rounding * misfit.scale());
    const Eigen::BDCSVD<Eigen::MatrixXd> parts(jacobian, Eigen::ComputeThinV);
    std::vector<double> found;
    for (Eigen::Index j = 0; j < columns; ++j) {
        double square = 0;
        for (Eigen::Index k = 0; k < parts.singularValues().size(); ++k) {
            const double turn = parts.matrixV()(j, k) * noise;
            if (turn != 0) square += std::pow(turn / parts.singularValues()[k], 2); // infinite where nothing moves
        }
        const auto at = static_cast<std::size_t>(j);
        found.push_back(std::sqrt(square) * unknowns.reals[at].slope(best.guess.coordinates[at]));
    }
    return found;
}

} // namespace

std::vector<Undetermined> undetermined(Unknowns& unknowns, Misfit& misfit, const haptel_texture& texture,
                                       std::span<const Found> all)
{
    std::vector<Undetermined> named;
    const Found& best = all.front();
    std::vector<Found> alike;
    for (const Found& found : all.subspan(1))
        if (fits_as_well(found, best, misfit)) alike.push_back(found);

    const std::vector<double> off = unknowns.reals.empty() ? std::vector<double>() : deviations(unknowns, misfit, best);
    for (std::size_t i = 0; i < unknowns.reals.size(); ++i) {
        const RealUnknown& real = unknowns.reals[i];
        const haptel_parameter& parameter = texture.parameters[real.parameter];
        const double value = real.value(best.guess.coordinates[i]);
        const double unit = std::max(std::abs(value), 1e-3 * (real.maximum - real.minimum));
        const auto other = std::ranges::find_if(alike, [&](const Found& found) {
            return std::abs(real.value(found.guess.coordinates[i]) - value) > told * unit;
        });
        if (!(off[i] <= told * unit))
            named.push_back({parameter.name, std::isfinite(off[i]) && off[i] < real.maximum - real.minimum
                                                 ? fmt::format("known to {:.2g} only", off[i])
                                                 : "nothing that was measured depends on it by itself"});
        else if (other != alike.end())
            named.push_back({parameter.name, fmt::format("{:.4g} fits as well as {:.4g}",
                                                         real.value(other->guess.coordinates[i]), value)});
    }
    for (std::size_t i = 0; i < unknowns.wholes.size(); ++i) {
        const auto other = std::ranges::find_if(
            alike, [&](const Found& found) { return found.guess.wholes[i] != best.guess.wholes[i]; });
        if (other != alike.end())
            named.push_back({texture.parameters[unknowns.wholes[i].parameter].name,
                             fmt::format("{} fits as well as {}", other->guess.wholes[i], best.guess.wholes[i])});
    }
    for (const uint32_t left : unknowns.left)
        named.push_back(
            {texture.parameters[left].name,
             fmt::format("a whole number of more than {} values is not looked for: give it", whole_values_max)});
    return named;
}

} // namespace haptel::jit
