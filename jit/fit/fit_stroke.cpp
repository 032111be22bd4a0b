#include "jit/fit/fit.h"
#include "jit/fit/spectrum_misfit.h"
#include "jit/fit/texture_to_fit.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace haptel::jit {

namespace {

constexpr std::size_t samples_min = 128;
// One line of a rough texture is not like another: of oak, 32 lines have pores by a decibel more or less than all.
constexpr std::size_t lines_at_first = 4, lines_at_second = 32, lines_at_last = 128;
constexpr FitEffort of_strokes{24, 40, 4};

// Samples of a line, so that the lowest third of an octave that is felt has four frequencies.
std::size_t samples_of(const Stroke& stroke)
{
    const double wanted = 4 * stroke.rate_hz / (felt_from_hz * (std::cbrt(2) - 1));
    const std::size_t shortest = std::ranges::min_element(stroke.passes, {}, &std::vector<double>::size)->size();
    return std::bit_floor(std::min(shortest, std::bit_ceil(static_cast<std::size_t>(std::min(wanted, 1e6)))));
}

} // namespace

FitResult fit_stroke(const std::shared_ptr<const CompiledProgram>& program, const FitRequest& request,
                     const Stroke& stroke)
{
    FitResult refused;
    for (std::size_t i = 0; i < stroke.passes.size(); ++i)
        if (stroke.passes[i].size() < samples_min) {
            refused.failure = "expected at least " + std::to_string(samples_min) + " samples in each pass, found " +
                              std::to_string(stroke.passes[i].size());
            if (stroke.passes.size() > 1)
                refused.failure += " in pass " + std::to_string(i + 1) + " of " + std::to_string(stroke.passes.size()) +
                                   "; a gap in the times ends a pass: leave short ones out";
            return refused;
        }
    if (stroke.passes.empty()) {
        refused.failure = "the stroke is empty";
        return refused;
    }
    const std::size_t samples = samples_of(stroke);
    TextureToFit fit(program, request, stroke.box_m(), stroke.box_m());
    refused.failure = fit.failure();
    if (!refused.failure.empty()) return refused;

    std::vector<std::unique_ptr<Misfit>> levels;
    levels.push_back(std::make_unique<SpectrumMisfit>(fit.texture(), stroke, samples, lines_at_first));
    levels.push_back(std::make_unique<SpectrumMisfit>(fit.texture(), stroke, samples, lines_at_second));
    auto last = std::make_unique<SpectrumMisfit>(fit.texture(), stroke, samples, lines_at_last);
    SpectrumMisfit& whole = *last;
    levels.push_back(std::move(last));
    if (levels.front()->rows() < 3) {
        refused.failure =
            "the stroke tells fewer than three thirds of octaves of what can be felt, 20 Hz to 1 kHz: it is "
            "too short or sampled too slowly";
        return refused;
    }
    const std::vector<Found> all = search(fit.unknowns(), levels, *levels.front(), of_strokes, request.seed);
    FitResult result = fit.result(all, whole);
    const std::vector<double> off_db = whole.off_db(fit.unknowns().block(all.front().guess));
    for (std::size_t band = 0; band < whole.rows(); ++band)
        result.bands.push_back({whole.bands()[band].from * stroke.speed_m_per_s,
                                whole.bands()[band].to * stroke.speed_m_per_s, off_db[band]});
    return result;
}

} // namespace haptel::jit
