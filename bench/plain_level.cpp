// The plain C++ textures as entries like those of compiled textures, by every way to get a gradient.
//
// Compiled once for each level of the instruction set, each time in a namespace of its own (HAPTEL_PLAIN). The linker
// keeps one copy of an inline function that several sources share, and must not take that of a newer processor: so
// nothing here uses containers, strings or static objects that are made at the start.
#include "bench/plain_textures.h"
#include "bench/plain_turn.h"

namespace haptel::bench::HAPTEL_PLAIN {
namespace {

constexpr int octaves(Field field)
{
    return field == Field::fbm1   ? 1
           : field == Field::fbm2 ? 2
           : field == Field::fbm4 ? 4
           : field == Field::fbm8 ? 8
                                  : 0;
}

template <Field field, typename Real, typename Number>
Number height(const Point<Number>& q, const Tables<Real>& tables)
{
    if constexpr (field == Field::noise) return noise<false>(q, tables);
    if constexpr (field == Field::perlin) return noise<true>(q, tables);
    if constexpr (octaves(field) > 0) return fbm(q, tables, octaves(field));
    if constexpr (field == Field::gardner7) return fourier<Real>(q, 7);
}

template <Field field, typename Real>
struct Analytic {
    static Sample<Real> sample(const Point<Real>& q, const PlainBlock<Real>& block)
    {
        if constexpr (field == Field::noise) return noise_with_gradient<false>(q, *block.tables);
        if constexpr (field == Field::perlin) return noise_with_gradient<true>(q, *block.tables);
        if constexpr (octaves(field) > 0) return fbm_with_gradient(q, *block.tables, octaves(field));
        if constexpr (field == Field::gardner7) return fourier_with_gradient(q, 7);
    }
};

// Gardner's texture with sines of a degree.
template <int degree, typename Real>
struct BySines {
    static Sample<Real> sample(const Point<Real>& q, const PlainBlock<Real>& block)
    {
        return fourier_with_gradient_in_turns(q, 7, TurnSine<degree, Real>{block.sine});
    }
};

template <Field field, typename Real>
struct ByDuals {
    static Sample<Real> sample(const Point<Real>& q, const PlainBlock<Real>& block)
    {
        const Point<Dual<Real>> moved{{q.x, 1, 0, 0}, {q.y, 0, 1, 0}, {q.z, 0, 0, 1}};
        const Dual<Real> result = height<field, Real>(moved, *block.tables);
        return {result.value, {result.d[0], result.d[1], result.d[2]}};
    }
};

// Central differences: of order 2, 4 or 6 in the step.
template <Field field, typename Real, int order>
struct ByDifferences {
    static Sample<Real> sample(const Point<Real>& q, const PlainBlock<Real>& block)
    {
        constexpr Real weights[3][3] = {
            {Real(0.5), 0, 0}, {Real(2.0 / 3), Real(-1.0 / 12), 0}, {Real(0.75), Real(-0.15), Real(1.0 / 60)}};
        Sample<Real> found{height<field, Real>(q, *block.tables), {}};
        for (int axis = 0; axis < 3; ++axis) {
            Real sum = 0;
            for (int i = 1; i <= order / 2; ++i) {
                Real ends[2];
                for (int side = 0; side < 2; ++side) {
                    const Real way = (side ? 1 : -1) * Real(i) * block.step;
                    const Point<Real> at{q.x + (axis == 0 ? way : 0), q.y + (axis == 1 ? way : 0),
                                         q.z + (axis == 2 ? way : 0)};
                    ends[side] = height<field, Real>(at, *block.tables);
                }
                sum += weights[order / 2 - 1][i - 1] * (ends[1] - ends[0]);
            }
            found.gradient[axis] = sum / block.step;
        }
        return found;
    }
};

template <typename Method, typename Real>
void point_entry(const haptel_point* point, const void* block, haptel_sample* sample)
{
    const Sample<Real> found =
        Method::sample({static_cast<Real>(point->p[0]), static_cast<Real>(point->p[1]), static_cast<Real>(point->p[2])},
                       *static_cast<const PlainBlock<Real>*>(block));
    *sample = {found.height, {found.gradient[0], found.gradient[1], found.gradient[2]}, 1, 1, 0};
}

template <typename Method, typename Real>
void batch_entry(const haptel_points* points, uint64_t count, const void* block, const haptel_samples* samples)
{
    const PlainBlock<Real>& held = *static_cast<const PlainBlock<Real>*>(block);
    for (uint64_t i = 0; i < count; ++i) {
        const Sample<Real> found =
            Method::sample({static_cast<Real>(points->p[0][i]), static_cast<Real>(points->p[1][i]),
                            static_cast<Real>(points->p[2][i])},
                           held);
        samples->height_m[i] = found.height;
        for (size_t axis = 0; axis < 3; ++axis) samples->gradient[axis][i] = found.gradient[axis];
    }
}

template <typename Method, typename Real>
constexpr PlainEntry entry(const char* name, bool is_difference = false, int sine_degree = 0)
{
    return {name,        std::is_same_v<Real, float>, is_difference,
            sine_degree, point_entry<Method, Real>,   batch_entry<Method, Real>};
}

template <Field field, typename Real>
constexpr PlainEntry analytic = entry<Analytic<field, Real>, Real>("cpp_analytic");
template <Field field, typename Real>
constexpr PlainEntry dual = entry<ByDuals<field, Real>, Real>("cpp_dual");
template <Field field, typename Real, int order>
constexpr PlainEntry difference = entry<ByDifferences<field, Real, order>, Real>(order == 2   ? "cpp_difference_2"
                                                                                 : order == 4 ? "cpp_difference_4"
                                                                                              : "cpp_difference_6",
                                                                                 true);
template <int degree, typename Real>
constexpr PlainEntry sine(const char* name)
{
    return entry<BySines<degree, Real>, Real>(name, false, degree);
}

template <Field field>
constexpr PlainEntry common[] = {analytic<field, double>,      dual<field, double>,
                                 analytic<field, float>,       dual<field, float>,
                                 difference<field, double, 2>, difference<field, double, 4>,
                                 difference<field, double, 6>, difference<field, float, 2>,
                                 difference<field, float, 4>,  difference<field, float, 6>};

constexpr PlainEntry gardner7[] = {
    common<Field::gardner7>[0],      common<Field::gardner7>[1],      common<Field::gardner7>[2],
    common<Field::gardner7>[3],      common<Field::gardner7>[4],      common<Field::gardner7>[5],
    common<Field::gardner7>[6],      common<Field::gardner7>[7],      common<Field::gardner7>[8],
    common<Field::gardner7>[9],      sine<3, double>("cpp_sine_3"),   sine<5, double>("cpp_sine_5"),
    sine<7, double>("cpp_sine_7"),   sine<9, double>("cpp_sine_9"),   sine<11, double>("cpp_sine_11"),
    sine<13, double>("cpp_sine_13"), sine<15, double>("cpp_sine_15"), sine<3, float>("cpp_sine_3"),
    sine<5, float>("cpp_sine_5"),    sine<7, float>("cpp_sine_7"),    sine<9, float>("cpp_sine_9")};

std::span<const PlainEntry> entries(Field field)
{
    switch (field) {
    case Field::noise: return common<Field::noise>;
    case Field::perlin: return common<Field::perlin>;
    case Field::fbm1: return common<Field::fbm1>;
    case Field::fbm2: return common<Field::fbm2>;
    case Field::fbm4: return common<Field::fbm4>;
    case Field::fbm8: return common<Field::fbm8>;
    case Field::gardner7: return gardner7;
    }
    return {};
}

} // namespace

PlainLevel level(Field field)
{
    return {HAPTEL_PLAIN_NAME, HAPTEL_PLAIN_FLAGS, entries(field)};
}

} // namespace haptel::bench::HAPTEL_PLAIN
