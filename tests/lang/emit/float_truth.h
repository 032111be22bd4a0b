// What text in float is compared with: numbers that floats hold, and what rounding each operation to f32 can lead to
// from the 113-bit truth (support/ball.h).
#pragma once

#include "tests/lang/emit/emitted.h"
#include "tests/support/ball.h"
#include "tests/support/foreign_textures.h"

namespace haptel::test {

inline constexpr size_t numbers_of_point = sizeof(haptel_point) / sizeof(double);
static_assert(numbers_of_point == 36);

// Points and blocks of numbers that floats hold.
class FloatStimuli {
public:
    explicit FloatStimuli(uint32_t seed) : random(seed), noise(seed) {}

    float between(double least, double most)
    {
        return static_cast<float>(std::uniform_real_distribution(least, most)(random));
    }
    haptel_point point()
    {
        haptel_point made{};
        double numbers[numbers_of_point];
        for (double& number : numbers) number = between(-1, 1);
        for (size_t i = 0; i < 3; ++i) numbers[i] = between(-0.02, 0.02);
        for (size_t i = 6; i < 9; ++i) numbers[i] = between(0, 1);
        for (size_t i = 24; i < 27; ++i) numbers[i] = between(-0.2, 0.2);
        numbers[27] = between(0, 2);
        numbers[28] = between(0, 0.005);
        numbers[35] = between(1, 50);
        std::memcpy(&made, numbers, sizeof made);
        return made;
    }
    // The defaults, or any values within their ranges.
    std::vector<double> block(const ir::Texture& texture, bool is_default)
    {
        std::vector<double> made(texture.block_size / sizeof(double));
        for (size_t i = 0; i < 6; ++i) made[i] = between(0, 0.1);
        made[6] = is_default ? 0 : between(0, 0.001);
        for (const ir::Parameter& parameter : texture.parameters) {
            char* const place = reinterpret_cast<char*>(made.data()) + parameter.offset;
            const bool varies = !is_default && std::isfinite(parameter.minimum);
            double value = varies ? between(parameter.minimum, parameter.maximum) : parameter.value;
            if (parameter.type == ir::Type::real) {
                value = static_cast<float>(value);
                std::memcpy(place, &value, sizeof value);
            } else if (parameter.type == ir::Type::image) {
                const haptel_image* const image = noise.picture();
                std::memcpy(place, &image, sizeof image);
            } else {
                const auto word = static_cast<uint32_t>(static_cast<int64_t>(std::round(value)));
                std::memcpy(place, &word, sizeof word);
            }
        }
        return made;
    }
    const haptel_image& picture() const { return *noise.picture(); }

private:
    std::mt19937 random;
    NoisePicture noise;
};

// Of what a texture makes of a point, numbered: height, gradient, faults, the height alone and its faults, and outputs,
// by their bits.
inline constexpr size_t output_places[] = {7, 8, 9, 10, 11, 12, 15, 16, 17};

struct Expected {
    std::string what;
    size_t place;
    Ball ball;
};

// Nothing where rounding decides.
inline std::vector<Expected> expected(ir::Interpreter<Ball>& interpreter, const ir::Texture& texture,
                                      const haptel_point& point, const std::vector<double>& block)
{
    Ball::in_singles = true;
    Ball::undecided = false;
    const ir::EntryInputs<Ball> inputs = inputs_of<Ball>(texture, point, block);
    const auto balls = interpreter.run(texture.height_gradient, {}, &inputs);
    Ball::in_singles = false;
    if (Ball::undecided) return {};
    std::vector<Expected> all = {
        {"height", 0, balls[0].real}, {"faults", 4, Ball(balls[4].bits)}, {"the height alone", 5, balls[0].real}};
    for (size_t i = 0; i < 3; ++i) all.push_back({"gradient", 1 + i, balls[1 + i].real});
    for_each_output(texture.writes, [&](const OutputInfo& output, size_t first) {
        const size_t place = output_places[&output - output_table];
        for (size_t i = 0; i < output.components; ++i)
            all.push_back({std::string(output.name), place + i, balls[5 + first + i].real});
    });
    return all;
}

} // namespace haptel::test
