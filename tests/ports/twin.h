// Patterns in the idioms of public shaders, and for each an independent twin: its height by its mathematics, in C++.
//
// A pattern's text is read by the compiler; its twin shares no line with the compiler or its library. Both are
// functions of q = p / size, and give the height as a multiple of the depth. Twins are of double precision and use the
// C library's elementary functions.
#pragma once

#include <glm/glm.hpp>

#include <cmath>
#include <cstdint>
#include <span>

namespace haptel::ports {

using glm::dmat3, glm::dvec2, glm::dvec3, glm::ivec2;

enum class Borders : uint8_t { meet, jump }; // of its cells: whether the height is continuous there

struct Twin {
    const char* pattern;     // the name of its file and texture
    double (*height)(dvec3); // of p / size, as a multiple of depth
    Borders borders;
    const char* borders_why;             // in its closed form
    double (*friction)(dvec3) = nullptr; // its friction_scale, where it has one
};

std::span<const Twin> value_twins(), gradient_twins(), cell_twins(), scatter_twins(), tile_twins(), woven_twins(),
    shape_twins(), field_twins();

inline constexpr double pi = 3.14159265358979323846;

inline double fade3(double t)
{
    return t * t * (3 - 2 * t);
}
inline double fade5(double t)
{
    return t * t * t * (10 + t * (6 * t - 15));
}
// The hermite ramp from 0 at `from` to 1 at `to`, which may be less.
inline double ramp(double from, double to, double x)
{
    return fade3(glm::clamp((x - from) / (to - from), 0.0, 1.0));
}
inline double fraction(double x)
{
    return x - std::floor(x);
}
// The sine hashes are rounded as GLSL's order of operations says, so that only the sine itself may differ: by 2e-16,
// times a factor of at most 43759.
inline double sine_hash(double angle, double factor)
{
    return fraction(std::sin(angle) * factor);
}
inline bool is_odd(double whole_number)
{
    return std::fmod(whole_number, 2) != 0;
}
inline uint32_t whole(double whole_number) // its bits as an int of 32 bits
{
    return static_cast<uint32_t>(static_cast<int64_t>(whole_number));
}
inline dvec2 turned(dvec2 v, double angle) // counterclockwise
{
    return {std::cos(angle) * v.x - std::sin(angle) * v.y, std::sin(angle) * v.x + std::cos(angle) * v.y};
}

// Sum over the corners of the cell of q: what the corner has, weighted by `fade` of the distances along each axis.
template <typename Corner, typename Fade>
double blend_corners(dvec2 q, Corner corner, Fade fade)
{
    const dvec2 low = glm::floor(q);
    double sum = 0;
    for (int i = 0; i < 4; ++i) {
        const dvec2 at = low + dvec2(i % 2, i / 2), away = glm::abs(q - at);
        sum += corner(at) * fade(1 - away.x) * fade(1 - away.y);
    }
    return sum;
}
template <typename Corner, typename Fade>
double blend_corners(dvec3 q, Corner corner, Fade fade)
{
    const dvec3 low = glm::floor(q);
    double sum = 0;
    for (int i = 0; i < 8; ++i) {
        const dvec3 at = low + dvec3(i % 2, i / 2 % 2, i / 4), away = glm::abs(q - at);
        sum += corner(at) * fade(1 - away.x) * fade(1 - away.y) * fade(1 - away.z);
    }
    return sum;
}

} // namespace haptel::ports
