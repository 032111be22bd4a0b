#include "jit/fit/spectrum.h"

#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include <unsupported/Eigen/FFT>

namespace haptel::jit {

namespace {

constexpr double third = 1.2599210498948732; // 2^(1/3)
constexpr double frequencies_min = 3;

} // namespace

double Band::middle() const
{
    return std::sqrt(from * to);
}

std::vector<Band> thirds_of_octaves(double from, double to, std::size_t count, double step)
{
    const double apart = 1 / (static_cast<double>(count) * step), highest = 0.9 * 0.5 / step;
    std::vector<Band> bands;
    for (double low = from; low * third <= std::min(to, highest) * (1 + 1e-9); low *= third)
        if (low * (third - 1) >= frequencies_min * apart) bands.push_back({low, low * third});
    return bands;
}

std::vector<std::size_t> pieces_of(std::size_t length, std::size_t count)
{
    const std::size_t rest = length - count, further = (2 * rest + count - 1) / count;
    std::vector<std::size_t> begins{0};
    for (std::size_t piece = 1; piece <= further; ++piece) begins.push_back(rest * piece / further);
    return begins;
}

struct LineSpectrum::Fourier {
    Eigen::FFT<double> transform{Eigen::default_fft_impl<double>(), Eigen::FFT<double>::HalfSpectrum};
};

LineSpectrum::LineSpectrum(std::size_t count, double apart, std::vector<Band> of_bands)
    : all(std::move(of_bands)), step(apart), window(count), band_of(count / 2, -1), fourier(std::make_unique<Fourier>())
{
    for (std::size_t i = 0; i < count; ++i) // with a mean square of 1
        window[i] = (1 - std::cos(2 * std::numbers::pi * (static_cast<double>(i) + 0.5) / static_cast<double>(count))) /
                    std::sqrt(1.5);
    for (std::size_t k = 1; k < band_of.size(); ++k)
        for (std::size_t band = 0; band < all.size(); ++band)
            if (frequency(k) >= all[band].from && frequency(k) < all[band].to) band_of[k] = static_cast<int>(band);
}

LineSpectrum::~LineSpectrum() = default;

std::vector<std::complex<double>> LineSpectrum::transform(std::span<const double> line)
{
    const double mean = std::reduce(line.begin(), line.end()) / static_cast<double>(line.size());
    std::vector<double> values(line.size());
    for (std::size_t i = 0; i < line.size(); ++i) values[i] = window[i] * (line[i] - mean);
    std::vector<std::complex<double>> transformed;
    fourier->transform.fwd(transformed, values);
    return transformed;
}

std::vector<double> LineSpectrum::powers(std::span<const double> line)
{
    line_transform = transform(line);
    std::vector<double> sums(all.size());
    const double scale = 2 / std::pow(static_cast<double>(window.size()), 2); // both halves of the transform
    for (std::size_t k = 1; k < band_of.size(); ++k)
        if (band_of[k] >= 0) sums[static_cast<std::size_t>(band_of[k])] += scale * std::norm(line_transform[k]);
    return sums;
}

std::vector<double> LineSpectrum::moves(std::span<const double> line_moves)
{
    const std::vector<std::complex<double>> moved = transform(line_moves);
    std::vector<double> sums(all.size());
    const double scale = 4 / std::pow(static_cast<double>(window.size()), 2);
    for (std::size_t k = 1; k < band_of.size(); ++k)
        if (band_of[k] >= 0)
            sums[static_cast<std::size_t>(band_of[k])] += scale * (std::conj(line_transform[k]) * moved[k]).real();
    return sums;
}

std::vector<double> LineSpectrum::mean_powers(std::span<const std::vector<double>> records,
                                              const std::function<double(double)>& gain)
{
    std::vector<double> sums(all.size());
    const std::size_t count = window.size();
    double pieces = 0;
    for (const std::vector<double>& record : records) {
        for (const std::size_t from : pieces_of(record.size(), count)) {
            ++pieces;
            const std::vector<std::complex<double>> one = transform(std::span(record).subspan(from, count));
            for (std::size_t k = 1; k < band_of.size(); ++k)
                if (band_of[k] >= 0)
                    sums[static_cast<std::size_t>(band_of[k])] += gain(frequency(k)) * std::norm(one[k]);
        }
    }
    for (double& sum : sums) sum *= 2 / (std::pow(static_cast<double>(count), 2) * pieces);
    return sums;
}

std::vector<double> LineSpectrum::noise(const std::function<double(double)>& gain) const
{
    std::vector<double> sums(all.size());
    for (std::size_t k = 1; k < band_of.size(); ++k)
        if (band_of[k] >= 0)
            sums[static_cast<std::size_t>(band_of[k])] += 2 * gain(frequency(k)) / static_cast<double>(window.size());
    return sums;
}

} // namespace haptel::jit
