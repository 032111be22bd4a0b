#include "jit/fit/unknowns.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace haptel::jit {

namespace {

// Where the author gave no range: from an eighth of the default to eight times as much, or from -1 to 1.
constexpr double without_range = 8;

double real_at(const char* place)
{
    double value = 0;
    std::memcpy(&value, place, sizeof value);
    return value;
}

int64_t whole_at(const char* place, uint32_t type)
{
    int32_t bits = 0;
    std::memcpy(&bits, place, sizeof bits);
    return type == HAPTEL_INT ? bits : static_cast<int64_t>(static_cast<uint32_t>(bits));
}

RealUnknown real_unknown(uint32_t index, const haptel_parameter& parameter, double value)
{
    double low = parameter.minimum, high = parameter.maximum;
    const double around = value == 0 ? 1 : std::abs(value);
    if (!std::isfinite(low)) low = value > 0 ? around / without_range : -around * (value == 0 ? 1 : without_range);
    if (!std::isfinite(high)) high = value < 0 ? -around / without_range : around * (value == 0 ? 1 : without_range);
    return {index, low, high, low > 0};
}

} // namespace

double RealUnknown::value(double coordinate) const
{
    if (coordinate <= 0) return minimum;
    if (coordinate >= 1) return maximum;
    return is_by_logarithm ? minimum * std::pow(maximum / minimum, coordinate)
                           : minimum + (maximum - minimum) * coordinate;
}

double RealUnknown::slope(double coordinate) const
{
    return is_by_logarithm ? value(coordinate) * std::log(maximum / minimum) : maximum - minimum;
}

double RealUnknown::coordinate(double value) const
{
    const double at = is_by_logarithm ? std::log(std::max(value, minimum) / minimum) / std::log(maximum / minimum)
                                      : (value - minimum) / (maximum - minimum);
    return std::clamp(at, 0.0, 1.0);
}

Unknowns::Unknowns(const TextureBinding& binding, const std::vector<std::string>& given)
    : texture(*binding.texture), bytes((binding.texture->block_size + sizeof(uint64_t) - 1) / sizeof(uint64_t))
{
    std::memcpy(bytes.data(), binding.block, texture.block_size);
    const char* const block = reinterpret_cast<const char*>(bytes.data());
    for (uint32_t i = 0; i < texture.parameter_count; ++i) {
        const haptel_parameter& parameter = texture.parameters[i];
        const std::string_view name = parameter.name; // size.x, where size was given
        const bool is_given = std::ranges::any_of(given, [&](const std::string& each) {
            return name == each || (name.starts_with(each) && name.substr(each.size()).starts_with('.'));
        });
        if (is_given || parameter.type == HAPTEL_IMAGE) continue;
        if (parameter.type == HAPTEL_FLOAT) {
            const RealUnknown real = real_unknown(i, parameter, real_at(block + parameter.offset));
            if (real.maximum > real.minimum) reals.push_back(real);
            continue;
        }
        const bool is_bool = parameter.type == HAPTEL_BOOL;
        const double low = is_bool ? 0 : parameter.minimum, high = is_bool ? 1 : parameter.maximum;
        if (high <= low) continue;
        if (high - low < static_cast<double>(whole_values_max)) // not where it is infinite
            wholes.push_back({i, static_cast<int64_t>(low), static_cast<int64_t>(high)});
        else
            left.push_back(i);
    }
}

const void* Unknowns::block(const Guess& guess)
{
    char* const block = reinterpret_cast<char*>(bytes.data());
    for (std::size_t i = 0; i < reals.size(); ++i) {
        const double value = reals[i].value(guess.coordinates[i]);
        std::memcpy(block + texture.parameters[reals[i].parameter].offset, &value, sizeof value);
    }
    for (std::size_t i = 0; i < wholes.size(); ++i) {
        const auto bits = static_cast<uint32_t>(guess.wholes[i]);
        std::memcpy(block + texture.parameters[wholes[i].parameter].offset, &bits, sizeof bits);
    }
    return block;
}

std::vector<uint32_t> Unknowns::real_parameters() const
{
    std::vector<uint32_t> all;
    for (const RealUnknown& real : reals) all.push_back(real.parameter);
    return all;
}

Guess Unknowns::start() const
{
    const char* const block = reinterpret_cast<const char*>(bytes.data());
    Guess guess;
    for (const RealUnknown& real : reals)
        guess.coordinates.push_back(real.coordinate(real_at(block + texture.parameters[real.parameter].offset)));
    for (const WholeUnknown& whole : wholes) {
        const haptel_parameter& parameter = texture.parameters[whole.parameter];
        guess.wholes.push_back(whole_at(block + parameter.offset, parameter.type));
    }
    return guess;
}

} // namespace haptel::jit
