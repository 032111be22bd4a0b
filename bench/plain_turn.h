// sin(2 pi x) as an odd polynomial of a chosen degree: what somebody writes who finds std::sin too slow, and the
// Fourier texture made of it.
#pragma once

#include "bench/plain_textures.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace haptel::bench::HAPTEL_PLAIN {

// Of the given degree on a quarter turn; coefficients of folded, folded^3 ... (turn_sine_coefficients()).
template <int degree, typename Real>
struct TurnSine {
    const std::array<Real, 8>& coefficients;

    Real operator()(Real turns) const
    {
        constexpr int count = (degree + 1) / 2;
        const Real way = turns - whole(turns + Real(0.5)), size = std::fabs(way);
        const Real folded = size > Real(0.25) ? Real(0.5) - size : size, square = folded * folded;
        Real sum = coefficients[count - 1];
        for (int i = count - 2; i >= 0; --i) sum = sum * square + coefficients[static_cast<size_t>(i)];
        return std::copysign(sum * folded, way);
    }
};

// fourier_with_gradient, every angle in turns.
template <int degree, typename Real>
Sample<Real> fourier_with_gradient_in_turns(const Point<Real>& q, int terms, const TurnSine<degree, Real>& sine)
{
    const auto cosine = [&](Real turns) { return sine(turns + Real(0.25)); };
    Real across = 0, along = 0, across_d[2] = {0, 0}, along_d[2] = {0, 0};
    Real most = 0, frequency = 1, amplitude = 1, lean = 0;
    for (int i = 0; i < terms; ++i) {
        const Real x = frequency * q.x, y = frequency * q.y;
        const Real a = x + lean * sine(y / 2), b = y + lean * sine(x / 2);
        const Real a_slope = amplitude * cosine(a) * turn<Real> * frequency;
        const Real b_slope = amplitude * cosine(b) * turn<Real> * frequency, half = lean * turn<Real> / 2;
        across += amplitude * sine(a) + Real(0.3);
        along += amplitude * sine(b) + Real(0.3);
        across_d[0] += a_slope;
        across_d[1] += a_slope * half * cosine(y / 2);
        along_d[0] += b_slope * half * cosine(x / 2);
        along_d[1] += b_slope;
        most += amplitude + Real(0.3);
        lean = Real(0.25), frequency *= 2, amplitude *= Real(0.70710678118654752);
    }
    const Real scale = 1 / (most * most);
    return {
        across * along * scale,
        {(across_d[0] * along + across * along_d[0]) * scale, (across_d[1] * along + across * along_d[1]) * scale, 0}};
}

} // namespace haptel::bench::HAPTEL_PLAIN
