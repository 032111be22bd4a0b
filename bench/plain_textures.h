// Three textures of the library as someone without Haptel writes them in C++: heights over any arithmetic type, and
// gradients by hand. What Haptel's code is measured against.
#pragma once

#include "bench/plain_level.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace haptel::bench::HAPTEL_PLAIN {

template <typename Real>
struct Point {
    Real x, y, z;
};

template <typename Real>
struct Sample {
    Real height, gradient[3];
};

// The floor of what fits an int, without the call that std::floor is on a processor of which nothing is known.
template <typename Real>
Real whole(Real x)
{
    const auto toward_zero = static_cast<Real>(static_cast<int32_t>(x));
    return toward_zero > x ? toward_zero - 1 : toward_zero;
}

// ---- value and partials, for automatic differentiation

template <typename Real>
struct Dual {
    Real value, d[3];
    Dual(Real constant = 0) : value(constant), d{0, 0, 0} {}
    Dual(Real v, Real dx, Real dy, Real dz) : value(v), d{dx, dy, dz} {}

    friend Dual operator+(const Dual& a, const Dual& b)
    {
        return {a.value + b.value, a.d[0] + b.d[0], a.d[1] + b.d[1], a.d[2] + b.d[2]};
    }
    friend Dual operator-(const Dual& a, const Dual& b)
    {
        return {a.value - b.value, a.d[0] - b.d[0], a.d[1] - b.d[1], a.d[2] - b.d[2]};
    }
    friend Dual operator*(const Dual& a, const Dual& b)
    {
        return {a.value * b.value, a.d[0] * b.value + a.value * b.d[0], a.d[1] * b.value + a.value * b.d[1],
                a.d[2] * b.value + a.value * b.d[2]};
    }
    friend Dual sin(const Dual& a)
    {
        const Real slope = std::cos(a.value);
        return {std::sin(a.value), slope * a.d[0], slope * a.d[1], slope * a.d[2]};
    }
    friend Real whole(const Dual& a) { return HAPTEL_PLAIN::whole(a.value); }
};

// Where each corner of a cell finds its vector; corner 1 + 2 + 4 is the one that is farthest along x, y and z.
template <typename Real>
std::array<uint32_t, 8> corners(const Tables<Real>& tables, int32_t i, int32_t j, int32_t k)
{
    const auto shuffled = [&](int32_t at) { return tables.shuffle[static_cast<size_t>(at & 255)]; };
    std::array<uint32_t, 8> found;
    for (int di = 0; di < 2; ++di) {
        const int32_t a = shuffled(i + di);
        for (int dj = 0; dj < 2; ++dj) {
            const int32_t b = shuffled(a + j + dj);
            for (int dk = 0; dk < 2; ++dk)
                found[static_cast<size_t>(di + 2 * dj + 4 * dk)] = static_cast<uint32_t>(shuffled(b + k + dk));
        }
    }
    return found;
}

// ---- heights

template <bool is_quintic, typename Number, typename Real>
Number noise(const Point<Number>& q, const Tables<Real>& tables)
{
    const Real cell[3] = {whole(q.x), whole(q.y), whole(q.z)};
    const int32_t i = static_cast<int32_t>(cell[0]), j = static_cast<int32_t>(cell[1]),
                  k = static_cast<int32_t>(cell[2]);
    const Number x = q.x - Number(cell[0]), y = q.y - Number(cell[1]), z = q.z - Number(cell[2]);
    const auto weight = [&](const Number& t) {
        return is_quintic ? t * t * t * (t * (t * Number(6) - Number(15)) + Number(10))
                          : t * t * (Number(3) - Number(2) * t);
    };
    const std::array<uint32_t, 8> vectors = corners(tables, i, j, k);
    const auto corner = [&](int di, int dj, int dk) {
        const uint32_t c = vectors[static_cast<size_t>(di + 2 * dj + 4 * dk)];
        return Number(tables.gx[c]) * (x - Number(Real(di))) + Number(tables.gy[c]) * (y - Number(Real(dj))) +
               Number(tables.gz[c]) * (z - Number(Real(dk)));
    };
    const auto between = [](const Number& a, const Number& b, const Number& t) { return a + (b - a) * t; };
    const Number u = weight(x), v = weight(y), w = weight(z);
    return between(
        between(between(corner(0, 0, 0), corner(1, 0, 0), u), between(corner(0, 1, 0), corner(1, 1, 0), u), v),
        between(between(corner(0, 0, 1), corner(1, 0, 1), u), between(corner(0, 1, 1), corner(1, 1, 1), u), v), w);
}

constexpr double octave_shift[] = {1.375, 0.625, 0.1875};

template <typename Number, typename Real>
Number fbm(const Point<Number>& q, const Tables<Real>& tables, int octaves)
{
    Number sum(0);
    Real frequency = 1, amplitude = 1;
    for (int i = 0; i < octaves; ++i, frequency *= 2, amplitude *= Real(0.5)) {
        const Number f(frequency);
        const Point<Number> at{q.x * f + Number(Real(i * octave_shift[0])), q.y * f + Number(Real(i * octave_shift[1])),
                               q.z * f + Number(Real(i * octave_shift[2]))};
        sum = sum + Number(amplitude) * noise<true>(at, tables);
    }
    return sum;
}

template <typename Real>
inline constexpr Real turn = Real(2 * std::numbers::pi);

// Gardner's Fourier texture in the plane (eq. 7 of the founding paper).
template <typename Real, typename Number>
Number fourier(const Point<Number>& q, int terms)
{
    using std::sin;
    Number across(0), along(0);
    Real most = 0, frequency = 1, amplitude = 1, lean = 0;
    for (int i = 0; i < terms; ++i) {
        const Number x = Number(turn<Real> * frequency) * q.x, y = Number(turn<Real> * frequency) * q.y;
        const Number phase(turn<Real> * lean), half(Real(0.5)), part(amplitude), lift(Real(0.3));
        across = across + part * sin(x + phase * sin(half * y)) + lift;
        along = along + part * sin(y + phase * sin(half * x)) + lift;
        most += amplitude + Real(0.3);
        lean = Real(0.25), frequency *= 2, amplitude *= Real(0.70710678118654752);
    }
    return across * along * Number(1 / (most * most));
}

// ---- height and gradient, by hand

// From a to b along an axis.
template <int axis, typename Real>
Sample<Real> between(const Sample<Real>& a, const Sample<Real>& b, Real weight, Real slope)
{
    const Real rise = b.height - a.height;
    Sample<Real> mixed{a.height + rise * weight,
                       {a.gradient[0] + (b.gradient[0] - a.gradient[0]) * weight,
                        a.gradient[1] + (b.gradient[1] - a.gradient[1]) * weight,
                        a.gradient[2] + (b.gradient[2] - a.gradient[2]) * weight}};
    mixed.gradient[axis] += rise * slope;
    return mixed;
}

template <bool is_quintic, typename Real>
Sample<Real> noise_with_gradient(const Point<Real>& q, const Tables<Real>& tables)
{
    const Real i = whole(q.x), j = whole(q.y), k = whole(q.z);
    const Real x = q.x - i, y = q.y - j, z = q.z - k;
    const auto weight = [&](Real t) { return is_quintic ? t * t * t * (t * (t * 6 - 15) + 10) : t * t * (3 - 2 * t); };
    const auto slope = [&](Real t) { return is_quintic ? 30 * t * t * (t * (t - 2) + 1) : 6 * t * (1 - t); };
    const std::array<uint32_t, 8> vectors =
        corners(tables, static_cast<int32_t>(i), static_cast<int32_t>(j), static_cast<int32_t>(k));
    const auto corner = [&](size_t which, Real dx, Real dy, Real dz) -> Sample<Real> {
        const uint32_t e = vectors[which];
        const Real gx = tables.gx[e], gy = tables.gy[e], gz = tables.gz[e];
        return {gx * (x - dx) + gy * (y - dy) + gz * (z - dz), {gx, gy, gz}};
    };
    const Real u = weight(x), v = weight(y), w = weight(z), du = slope(x), dv = slope(y), dw = slope(z);
    return between<2>(between<1>(between<0>(corner(0, 0, 0, 0), corner(1, 1, 0, 0), u, du),
                                 between<0>(corner(2, 0, 1, 0), corner(3, 1, 1, 0), u, du), v, dv),
                      between<1>(between<0>(corner(4, 0, 0, 1), corner(5, 1, 0, 1), u, du),
                                 between<0>(corner(6, 0, 1, 1), corner(7, 1, 1, 1), u, du), v, dv),
                      w, dw);
}

template <typename Real>
Sample<Real> fbm_with_gradient(const Point<Real>& q, const Tables<Real>& tables, int octaves)
{
    Sample<Real> sum{};
    Real frequency = 1, amplitude = 1;
    for (int i = 0; i < octaves; ++i, frequency *= 2, amplitude *= Real(0.5)) {
        const Sample<Real> one = noise_with_gradient<true, Real>({q.x * frequency + Real(i * octave_shift[0]),
                                                                  q.y * frequency + Real(i * octave_shift[1]),
                                                                  q.z * frequency + Real(i * octave_shift[2])},
                                                                 tables);
        sum.height += amplitude * one.height;
        for (int g = 0; g < 3; ++g) sum.gradient[g] += amplitude * frequency * one.gradient[g];
    }
    return sum;
}

template <typename Real>
Sample<Real> fourier_with_gradient(const Point<Real>& q, int terms)
{
    Real across = 0, along = 0, across_d[2] = {0, 0}, along_d[2] = {0, 0};
    Real most = 0, frequency = 1, amplitude = 1, lean = 0;
    for (int i = 0; i < terms; ++i) {
        const Real w = turn<Real> * frequency, x = w * q.x, y = w * q.y, phase = turn<Real> * lean;
        const Real a = x + phase * std::sin(y / 2), b = y + phase * std::sin(x / 2);
        const Real a_slope = amplitude * std::cos(a) * w, b_slope = amplitude * std::cos(b) * w;
        across += amplitude * std::sin(a) + Real(0.3);
        along += amplitude * std::sin(b) + Real(0.3);
        across_d[0] += a_slope;
        across_d[1] += a_slope * phase * std::cos(y / 2) / 2;
        along_d[0] += b_slope * phase * std::cos(x / 2) / 2;
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
