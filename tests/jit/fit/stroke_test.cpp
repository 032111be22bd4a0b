// The spectrum of a texture that was only recorded, with noise, along one stroke.
#include "jit/fit/spectrum_misfit.h"
#include "tests/jit/fit/hidden.h"
#include "tests/support/catch.h"
#include "tests/support/project_path.h"
#include "tests/support/tries.h"

#include <algorithm>
#include <bit>
#include <cstdio>
#include <numbers>

using namespace haptel;
using namespace haptel::jit;

namespace {

struct Stroked {
    const char *file, *texture;
    double speed_m_per_s;
    double direction = 0; // an angle from x
};

constexpr double across = std::numbers::pi / 2; // ribs that run along x

constexpr Stroked stroked[] = {{"brushed", "brushed", 0.05},
                               {"cast", "cast", 0.1},
                               {"corduroy", "corduroy", 0.1, across},
                               {"grating", "grating", 0.1},
                               {"leather", "leather", 0.1},
                               {"ripples", "ripples", 0.2},
                               {"rock", "rock", 0.1},
                               {"sandpaper", "sandpaper", 0.05},
                               {"stone", "stone", 0.1},
                               {"weathered", "rust", 0.1},
                               {"weave", "weave", 0.1},
                               {"wood", "wood", 0.1}};

// Of the library of materials.
constexpr Stroked stroked_materials[] = {{"fabric/burlap", "burlap", 0.1},
                                         {"fabric/corduroy", "corduroy", 0.1, across},
                                         {"fabric/denim", "denim", 0.05},
                                         {"leather/calf", "calf", 0.05},
                                         {"leather/pebbled", "pebbled", 0.1},
                                         {"metal/brushed", "brushed", 0.05, across},
                                         {"metal/cast", "cast", 0.1},
                                         {"metal/knurl", "knurl", 0.1},
                                         {"metal/turned", "turned", 0.05},
                                         {"paper/laid", "laid", 0.1, across},
                                         {"perception/sine_grating", "sine_grating", 0.25},
                                         {"plastic/layers", "layers", 0.05, across},
                                         {"stone/granite", "granite", 0.1},
                                         {"stone/sandstone", "sandstone", 0.1},
                                         {"wood/cork", "cork", 0.1},
                                         {"wood/oak", "oak", 0.1},
                                         {"wood/planed", "planed", 0.1},
                                         {"wood/spruce", "spruce", 0.1, across}};

constexpr double pass_m = 0.15; // of a minute of passes over a square

struct Recorded {
    Stroke stroke;
    double noise_m2 = 0;                        // mean square, as a height
    std::vector<std::vector<double>> heights_m; // pass by pass, without noise
};

// The force of a hand that strokes to and fro along `direction` (an angle from x), on lines that the fit does not know,
// and noise of 3 % of its strength.
Recorded recorded(const ParameterGradient& texture, const void* block, const Stroked& each, uint64_t seed)
{
    Recorded made;
    Stroke& stroke = made.stroke;
    stroke.speed_m_per_s = each.speed_m_per_s;
    stroke.stiffness_n_per_m = 700;
    stroke.direction[0] = std::cos(each.direction), stroke.direction[1] = std::sin(each.direction);
    const auto& [x, y] = stroke.direction;
    const auto samples = static_cast<std::size_t>(pass_m / stroke.step_m());
    const auto passes = static_cast<std::size_t>(60 * stroke.speed_m_per_s / pass_m);
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> anywhere(-0.5, 0.5);
    double square = 0;
    for (std::size_t pass = 0; pass < passes; ++pass) {
        std::vector<haptel_point> points(samples);
        const double across_m = pass_m * anywhere(random); // at even distances each might meet a weave alike
        for (std::size_t i = 0; i < samples; ++i) {
            const double share = static_cast<double>(i) / static_cast<double>(samples);
            const double along_m = pass_m * (pass % 2 ? 0.5 - share : share - 0.5);
            points[i].p[0] = along_m * x - across_m * y;
            points[i].p[1] = along_m * y + across_m * x;
            points[i].n[2] = 1;
        }
        std::vector<double>& heights_m = made.heights_m.emplace_back(samples);
        texture.heights(PointArrays(points), block, heights_m);
        double mean = 0;
        for (const double h : heights_m) mean += h / static_cast<double>(samples);
        for (const double h : heights_m) square += (h - mean) * (h - mean) / static_cast<double>(samples * passes);
    }
    made.noise_m2 = 9e-4 * square;
    std::normal_distribution<double> noise(0, std::sqrt(made.noise_m2));
    stroke.passes = made.heights_m;
    for (std::vector<double>& pass : stroke.passes)
        for (double& value : pass) value = stroke.stiffness_n_per_m * (value + noise(random));
    return made;
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

void meet_spectrum(const std::string& folder, const Stroked& each, uint64_t seed)
{
    const CompiledTextures compiled = compiled_for_fit(test::project_path(folder + each.file + ".haptel"));
    REQUIRE(compiled.program);
    FitRequest request;
    request.texture = each.texture;
    TextureToFit texture(compiled.program, request, 1, 1);
    REQUIRE(texture.failure() == "");
    const HiddenGuess hidden = hidden_guess(texture.unknowns(), texture.texture().texture(), seed);
    const auto [stroke, noise_m2, heights_m] =
        recorded(texture.texture(), texture.unknowns().block(hidden.guess), each, seed);
    const FitResult found = fit_stroke(compiled.program, request, stroke);
    INFO(each.texture << ", seed " << seed << ": off by " << found.error << " dB " << found.failure);
    REQUIRE(found.failure == "");

    // Of what was found over many lines, against the stroke as it was before the noise.
    const std::size_t count = std::bit_floor(std::min<std::size_t>(1024, stroke.passes[0].size()));
    SpectrumMisfit many(texture.texture(), stroke, count, 256);
    LineSpectrum spectrum(count, stroke.step_m(), many.bands());
    const std::vector<double> truth = spectrum.mean_powers(heights_m, [](double) { return 1.0; }),
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
    const double off_db = std::sqrt(square / bands);
    CHECK(bands > 0);
    CHECK(off_db < 1);
    std::printf("%s, seed %d: met within %.2f dB\n", each.texture, static_cast<int>(seed), off_db);
}

} // namespace

TEST_CASE("the spectrum of a noisy stroke is met within 1 dB, root mean square, where it can be felt")
{
    meet_spectrum("examples/textures/", {"stone", "stone", 0.1}, 1);
    if (!test::is_sanitized) meet_spectrum("examples/textures/", {"weave", "weave", 0.1}, 3); // sharp lines
}

TEST_CASE("the same of further textures", "[.long]")
{
    for (uint64_t seed = 1; seed <= 3; ++seed) {
        for (const Stroked& each : stroked) meet_spectrum("examples/textures/", each, seed);
        for (const Stroked& each : stroked_materials) meet_spectrum("materials/", each, seed);
    }
}
