// The spectrum of a texture that was only recorded, with noise, along one stroke.
#include "jit/fit/spectrum_misfit.h"
#include "tests/jit/fit/hidden.h"
#include "tests/support/catch.h"
#include "tests/support/project_path.h"

#include <algorithm>
#include <numbers>

using namespace haptel;
using namespace haptel::jit;

namespace {

struct Stroked {
    const char *file, *texture;
    double speed_m_per_s;
};

constexpr Stroked stroked[] = {{"brushed", "brushed", 0.05}, {"grating", "grating", 0.1},
                               {"leather", "leather", 0.1},  {"rock", "rock", 0.1},
                               {"ripples", "ripples", 0.2},  {"sandpaper", "sandpaper", 0.05},
                               {"stone", "stone", 0.1},      {"weathered", "rust", 0.1}};

constexpr std::size_t samples = 65536; // a minute

struct Recorded {
    Stroke stroke;
    double noise_m2 = 0;           // mean square, as a height
    std::vector<double> heights_m; // without noise
};

// The force of a hand on the texture along a line that the fit does not know, and noise of 3 % of its strength.
Recorded recorded(const ParameterGradient& texture, const void* block, double speed_m_per_s, uint64_t seed)
{
    Stroke stroke;
    stroke.speed_m_per_s = speed_m_per_s;
    stroke.stiffness_n_per_m = 700;
    std::vector<haptel_point> points(samples);
    for (std::size_t i = 0; i < samples; ++i) {
        points[i].p[0] = 0.0123 + stroke.step_m() * static_cast<double>(i);
        points[i].p[1] = 0.0377;
        points[i].n[2] = 1;
    }
    stroke.values.resize(samples);
    texture.heights(PointArrays(points), block, stroke.values);
    double mean = 0, square = 0;
    for (const double h : stroke.values) mean += h / samples;
    for (const double h : stroke.values) square += (h - mean) * (h - mean) / samples;
    std::mt19937_64 random(seed);
    std::normal_distribution<double> noise(0, 0.03 * std::sqrt(square));
    std::vector<double> clean_m = stroke.values;
    for (double& value : stroke.values) value = stroke.stiffness_n_per_m * (value + noise(random));
    return {std::move(stroke), 9e-4 * square, std::move(clean_m)};
}

} // namespace

TEST_CASE("the power of a line lies in the band of its frequency, and of noise in all")
{
    constexpr std::size_t count = 4096;
    LineSpectrum spectrum(count, 1e-3, thirds_of_octaves(20, 1000, count, 1e-3));
    REQUIRE(spectrum.bands().size() > 12);
    std::vector<double> line(count), noise(count);
    for (std::size_t i = 0; i < count; ++i)
        line[i] = 3 + 0.2 * std::sin(2 * std::numbers::pi * 70 * 1e-3 * static_cast<double>(i));
    const std::vector<double> powers = spectrum.powers(line);
    for (std::size_t band = 0; band < powers.size(); ++band) {
        const bool is_of_it = spectrum.bands()[band].from < 70 && 70 < spectrum.bands()[band].to;
        CHECK(powers[band] == (is_of_it ? Approx(0.02).epsilon(1e-3) : Approx(0).margin(1e-5)));
    }
    std::mt19937_64 random(3);
    std::normal_distribution<double> normal;
    std::vector<double> sums(powers.size());
    for (int i = 0; i < 200; ++i) {
        for (double& value : noise) value = normal(random);
        const std::vector<double> one = spectrum.powers(noise);
        for (std::size_t band = 0; band < sums.size(); ++band) sums[band] += one[band] / 200;
    }
    const std::vector<double> expected = spectrum.noise([](double) { return 1.0; });
    for (std::size_t band = 0; band < sums.size(); ++band) CHECK(sums[band] == Approx(expected[band]).epsilon(0.1));
}

namespace {

void meet_spectrum(const Stroked& each, uint64_t seed)
{
    const CompiledTextures compiled =
        compiled_for_fit(test::project_path(std::string("examples/textures/") + each.file + ".haptel"));
    REQUIRE(compiled.program);
    FitRequest request;
    request.texture = each.texture;
    TextureToFit texture(compiled.program, request, 1, 1);
    REQUIRE(texture.failure() == "");
    const HiddenGuess hidden = hidden_guess(texture.unknowns(), texture.texture().texture(), seed);
    const auto [stroke, noise_m2, clean_m] =
        recorded(texture.texture(), texture.unknowns().block(hidden.guess), each.speed_m_per_s, seed);
    const FitResult found = fit_stroke(compiled.program, request, stroke);
    INFO(each.texture << ", seed " << seed << ": off by " << found.error << " dB " << found.failure);
    REQUIRE(found.failure == "");

    // Of what was found over many lines, against the stroke as it was before the noise.
    SpectrumMisfit many(texture.texture(), stroke, 1024, 256);
    LineSpectrum spectrum(1024, stroke.step_m(), many.bands());
    const std::vector<double> truth = spectrum.mean_powers(clean_m, [](double) { return 1.0; }),
                              white = spectrum.noise([](double) { return 1.0; });
    Guess fitted = hidden.guess;
    const auto value_of = [&](uint32_t parameter) {
        return std::ranges::find(found.parameters, parameter, &FittedParameter::index)->value;
    };
    for (std::size_t i = 0; i < fitted.coordinates.size(); ++i) {
        const RealUnknown& real = texture.unknowns().reals[i];
        fitted.coordinates[i] = real.coordinate(value_of(real.parameter));
    }
    for (std::size_t i = 0; i < fitted.wholes.size(); ++i)
        fitted.wholes[i] = static_cast<int64_t>(value_of(texture.unknowns().wholes[i].parameter));
    const std::vector<double> made = many.height_powers(texture.unknowns().block(fitted));
    const double strongest = *std::ranges::max_element(truth);
    double square = 0, bands = 0;
    for (std::size_t band = 0; band < truth.size();
         ++band) // what stands out of the noise, and is not drowned by others
        if (truth[band] > noise_m2 * white[band] && truth[band] > 0.01 * strongest)
            square += std::pow(10 * std::log10(made[band] / truth[band]), 2), ++bands;
    CHECK(bands > 0);
    CHECK(std::sqrt(square / bands) < 1);
}

} // namespace

TEST_CASE("the spectrum of a noisy stroke is met within 1 dB, root mean square, where it can be felt")
{
    meet_spectrum({"leather", "leather", 0.1}, 1);
    meet_spectrum({"stone", "stone", 0.1}, 1);
}

TEST_CASE("the same of further textures", "[.long]")
{
    for (const Stroked& each : stroked) meet_spectrum(each, 1);
}
