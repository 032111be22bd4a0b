// Textures with parameters that a fit does not know, and whether it finds them.
#pragma once

#include "jit/fit/texture_to_fit.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace haptel::jit {

struct HiddenParameter {
    std::string name;
    double value = 0;
    double unit = 1; // what 1 % of it is 1 % of
};

struct Hidden {
    std::vector<HiddenParameter> parameters;
    HeightMap map;
};

inline CompiledTextures compiled_for_fit(const std::string& file)
{
    TextureOptions options;
    options.entries = Entries::both_and_batches;
    options.precision = Precision::f64;
    return compile_texture_file(file, options);
}

struct HiddenGuess {
    Guess guess;
    std::vector<HiddenParameter> parameters;
};

// Parameters drawn over their ranges but for the outer eighths.
inline HiddenGuess hidden_guess(const Unknowns& unknowns, const haptel_texture& texture, uint64_t seed)
{
    HiddenGuess hidden{unknowns.start(), {}};
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> place(0.125, 0.875);
    for (std::size_t i = 0; i < unknowns.reals.size(); ++i) {
        const RealUnknown& real = unknowns.reals[i];
        hidden.guess.coordinates[i] = place(random);
        const double value = real.value(hidden.guess.coordinates[i]);
        hidden.parameters.push_back({texture.parameters[real.parameter].name, value,
                                     std::max(std::abs(value), 1e-3 * (real.maximum - real.minimum))});
    }
    for (std::size_t i = 0; i < unknowns.wholes.size(); ++i) {
        const WholeUnknown& whole = unknowns.wholes[i];
        hidden.guess.wholes[i] =
            whole.minimum + static_cast<int64_t>(random() % static_cast<uint64_t>(whole.maximum - whole.minimum + 1));
        hidden.parameters.push_back(
            {texture.parameters[whole.parameter].name, static_cast<double>(hidden.guess.wholes[i]), 1});
    }
    return hidden;
}

// The heights of such a texture over a square of that side.
inline Hidden hidden_texture(const std::shared_ptr<const CompiledProgram>& program, const std::string& texture,
                             double side_m, std::size_t pixels, uint64_t seed)
{
    FitRequest request;
    request.texture = texture;
    TextureToFit made(program, request, side_m, side_m);
    HiddenGuess drawn = hidden_guess(made.unknowns(), made.texture().texture(), seed);
    Hidden hidden{std::move(drawn.parameters), {}};
    hidden.map.columns = hidden.map.rows = pixels;
    hidden.map.pixel_m = side_m / static_cast<double>(pixels);
    std::vector<haptel_point> points;
    for (std::size_t row = 0; row < pixels; ++row)
        for (std::size_t column = 0; column < pixels; ++column) points.push_back(hidden.map.point(column, row));
    hidden.map.heights_m.resize(points.size());
    made.texture().heights(PointArrays(points), made.unknowns().block(drawn.guess), hidden.map.heights_m);
    return hidden;
}

// Those that came back wrong and are not named as undetermined, in words.
inline std::vector<std::string> lost(const Hidden& hidden, const FitResult& found)
{
    std::vector<std::string> all;
    for (const HiddenParameter& parameter : hidden.parameters) {
        const auto value = std::ranges::find(found.parameters, parameter.name, &FittedParameter::name);
        const bool is_named = std::ranges::count(found.undetermined, parameter.name, &Undetermined::name) > 0;
        const double off = value == found.parameters.end() ? INFINITY : std::abs(value->value - parameter.value);
        if (!is_named && !(off <= 0.01 * parameter.unit))
            all.push_back(parameter.name + " is " + std::to_string(parameter.value) + ", found " +
                          (value == found.parameters.end() ? "nothing" : std::to_string(value->value)));
    }
    return all;
}

} // namespace haptel::jit
