#include "jit/fit/spectrum_misfit.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace haptel::jit {

namespace {

constexpr double least_power = 1e-30; // in the square of any unit
constexpr double off_sure_db = 0.2;   // what no model of a surface is nearer than: no band counts for all others
// Of the strongest band's power, as recorded: what is weaker is drowned, and no logarithm is of 0.
constexpr double drowned = 1e-4;

// Along the stroke's direction, on a square whose side is as long as its passes: in the places of their pieces along
// it, and anywhere across.
std::vector<haptel_point> lines_over(const Stroke& stroke, std::size_t count, std::size_t lines)
{
    std::vector<haptel_point> points;
    const double side_m = stroke.pass_m();
    const auto samples = static_cast<std::size_t>(std::llround(side_m / stroke.step_m()));
    const std::vector<std::size_t> pieces = pieces_of(samples, count);
    const auto& [x, y] = stroke.direction;
    for (std::size_t line = 0; line < lines; ++line) {
        // not at even distances, which could be a texture's own
        const double across_m = side_m * (std::fmod(0.5 + static_cast<double>(line) / std::numbers::phi, 1.0) - 0.5);
        for (std::size_t i = 0; i < count; ++i) {
            haptel_point point{};
            const double along_m =
                stroke.step_m() * static_cast<double>(pieces[line * pieces.size() / lines] + i) - side_m / 2;
            point.p[0] = along_m * x - across_m * y;
            point.p[1] = along_m * y + across_m * x;
            point.n[2] = 1;
            point.tangent[0] = point.bitangent[1] = 1;
            point.uv[0] = point.p[0] / stroke.box_m() + 0.5;
            point.uv[1] = point.p[1] / stroke.box_m() + 0.5;
            point.uv_dp[0][0] = point.uv_dp[1][1] = 1 / stroke.box_m();
            point.velocity[0] = stroke.speed_m_per_s * x;
            point.velocity[1] = stroke.speed_m_per_s * y;
            points.push_back(point);
        }
    }
    return points;
}

double decibels(double ratio)
{
    return 10 * std::log10(ratio);
}

} // namespace

double Stroke::power_of_height(double cycles_per_m) const
{
    if (of == Of::force) return 1 / (stiffness_n_per_m * stiffness_n_per_m);
    return std::pow(2 * std::numbers::pi * cycles_per_m * speed_m_per_s, -4);
}

SpectrumMisfit::SpectrumMisfit(const ParameterGradient& of, const Stroke& stroke, std::size_t samples,
                               std::size_t how_many)
    : texture(of)
    , count(samples)
    , lines(how_many)
    , spectrum(samples, stroke.step_m(),
               thirds_of_octaves(felt_from_hz / stroke.speed_m_per_s, felt_to_hz / stroke.speed_m_per_s, samples,
                                 stroke.step_m()))
    , points(lines_over(stroke, samples, how_many))
    , heights_m(samples * how_many)
{
    const auto as_height = [&](double cycles_per_m) { return stroke.power_of_height(cycles_per_m); };
    measured = spectrum.mean_powers(stroke.passes, as_height);
    noise = spectrum.noise(as_height);
    const std::vector<double> recorded = spectrum.mean_powers(stroke.passes, [](double) { return 1.0; });
    const double drowned_power = std::max(drowned * (recorded.empty() ? 0 : std::ranges::max(recorded)), least_power);
    for (const Band& band : bands()) unfelt.push_back(drowned_power * as_height(band.middle()));
    // The power of a band that n independent values make has a standard deviation of 1/sqrt(n) of itself.
    const double recorded_s = static_cast<double>(stroke.samples()) / stroke.rate_hz,
                 made_s = static_cast<double>(count * lines) / stroke.rate_hz;
    double square = 0;
    for (const Band& band : bands()) {
        const double hz = (band.to - band.from) * stroke.speed_m_per_s,
                     off = decibels(1 + std::sqrt(1 / (hz * recorded_s) + 1 / (hz * made_s)));
        weights.push_back(1 / std::hypot(off, off_sure_db));
        square += weights.back() * weights.back() / static_cast<double>(rows());
    }
    for (double& weight : weights) weight /= std::sqrt(square);
}

std::vector<double> SpectrumMisfit::height_powers(const void* block)
{
    texture.heights(points, block, heights_m);
    std::vector<double> made(rows());
    for (std::size_t line = 0; line < lines; ++line) {
        const std::vector<double> one = spectrum.powers(std::span(heights_m).subspan(line * count, count));
        for (std::size_t band = 0; band < rows(); ++band) made[band] += one[band] / static_cast<double>(lines);
    }
    return made;
}

double SpectrumMisfit::above_db(double made, std::size_t band) const
{
    return decibels((made + unfelt[band]) / (measured[band] + unfelt[band]));
}

// The noise that brings the two nearest to each other; never more than what was measured.
double SpectrumMisfit::noise_beside(std::span<const double> made) const
{
    double most = INFINITY;
    for (std::size_t band = 0; band < rows(); ++band) most = std::min(most, measured[band] / noise[band]);
    const auto apart = [&](double power) {
        double sum = 0;
        for (std::size_t band = 0; band < rows(); ++band)
            sum += std::pow(weights[band] * above_db(made[band] + power * noise[band], band), 2);
        return sum;
    };
    double low = 0, high = 1;      // by the root, which the eye of a search sees evenly
    for (int i = 0; i < 40; ++i) { // golden section
        const double span = (high - low) / std::numbers::phi, a = high - span, b = low + span;
        (apart(most * a * a) < apart(most * b * b) ? high : low) = apart(most * a * a) < apart(most * b * b) ? b : a;
    }
    const double found = most * std::pow((low + high) / 2, 2);
    return apart(found) < apart(0) ? found : 0;
}

void SpectrumMisfit::compare(std::span<const double> made, std::span<double> to) const
{
    for (std::size_t band = 0; band < rows(); ++band) to[band] = weights[band] * above_db(made[band], band);
}

std::vector<double> SpectrumMisfit::off_db(const void* block)
{
    std::vector<double> off(rows());
    residuals(block, off);
    for (std::size_t band = 0; band < rows(); ++band) off[band] /= weights[band];
    return off;
}

void SpectrumMisfit::residuals(const void* block, std::span<double> to)
{
    std::vector<double> made = height_powers(block);
    const double beside = noise_beside(made);
    for (std::size_t band = 0; band < rows(); ++band) made[band] += beside * noise[band];
    compare(made, to);
}

void SpectrumMisfit::gradient(const void* block, std::span<double> to, std::span<double> by_parameters)
{
    const std::size_t parameters = texture.parameters().size();
    std::vector<double> moves(heights_m.size() * parameters), made(rows());
    texture.gradient(points, block, heights_m, moves);
    std::ranges::fill(by_parameters, 0.0);
    for (std::size_t line = 0; line < lines; ++line) {
        const std::vector<double> one = spectrum.powers(std::span(heights_m).subspan(line * count, count));
        for (std::size_t band = 0; band < rows(); ++band) made[band] += one[band] / static_cast<double>(lines);
        for (std::size_t j = 0; j < parameters; ++j) {
            const std::vector<double> moved =
                spectrum.moves(std::span(moves).subspan(j * heights_m.size() + line * count, count));
            for (std::size_t band = 0; band < rows(); ++band)
                by_parameters[j * rows() + band] += moved[band] / static_cast<double>(lines);
        }
    }
    const double beside = noise_beside(made);
    for (std::size_t band = 0; band < rows(); ++band) {
        made[band] += beside * noise[band];
        for (std::size_t j = 0; j < parameters; ++j)
            by_parameters[j * rows() + band] *= weights[band] * 10 / (std::numbers::ln10 * (made[band] + unfelt[band]));
    }
    compare(made, to);
}

double SpectrumMisfit::unlikeness(const void* block)
{
    const std::vector<double> apart = off_db(block);
    const double mean = std::reduce(apart.begin(), apart.end()) / static_cast<double>(rows());
    double square = 0;
    for (const double each : apart) square += std::pow(each - mean, 2);
    return std::sqrt(square / static_cast<double>(rows()));
}

} // namespace haptel::jit
