// A stroke against strokes over the texture elsewhere: no phases are compared, only the power in each third of an
// octave, in decibels; a band counts by how surely so many frequencies of so long a recording tell its power. Noise of
// the recording that is white is found beside.
#pragma once

#include "jit/fit/misfit.h"
#include "jit/fit/parameter_gradient.h"
#include "jit/fit/spectrum.h"
#include "jit/fit/stroke.h"

#include <vector>

namespace haptel::jit {

class SpectrumMisfit final : public Misfit {
public:
    // Lines of `count` samples, at most as many as each pass has, over a square whose side is as long as its passes.
    SpectrumMisfit(const ParameterGradient& texture, const Stroke& stroke, std::size_t count, std::size_t lines);
    std::size_t rows() const override { return spectrum.bands().size(); }
    void residuals(const void* block, std::span<double> rows) override; // decibels, on average
    void gradient(const void* block, std::span<double> rows, std::span<double> by_parameters) override;
    double unlikeness(const void* block) override; // of the spectra's shapes
    double scale() const override { return 1; }    // decibels are of themselves

    const std::vector<Band>& bands() const { return spectrum.bands(); } // cycles per metre
    std::vector<double> height_powers(const void* block);               // of the texture alone, m^2, by band
    std::vector<double> off_db(const void* block); // of the texture and noise above the recording, by band

private:
    const ParameterGradient& texture;
    const std::size_t count, lines;
    LineSpectrum spectrum;
    PointArrays points;                  // line by line
    std::vector<double> measured, noise; // by band, m^2; the latter of noise whose mean square is 1 as recorded
    std::vector<double> unfelt;          // by band, m^2: counts on both sides
    std::vector<double> weights;         // by band, with a mean square of 1
    std::vector<double> heights_m;

    double above_db(double made, std::size_t band) const;
    double noise_beside(std::span<const double> made) const;
    void compare(std::span<const double> made, std::span<double> rows) const;
};

} // namespace haptel::jit
