#include "bench/plain_entries.h"

#include "bench/plain_textures.h"
#include "bench/plain_turn.h"

#include <algorithm>
#include <memory>
#include <utility>

namespace haptel::bench {
namespace {

using plain::Dual;
using plain::Point;
using plain::Sample;
using plain::Tables;

template <typename Real>
struct Block {
    const Tables<Real>* tables;
    Real step;
};

constexpr int octaves(Field field)
{
    return field == Field::fbm1   ? 1
           : field == Field::fbm2 ? 2
           : field == Field::fbm4 ? 4
           : field == Field::fbm8 ? 8
                                  : 0;
}

// `to` gets the field as a constant.
template <typename To>
void with_constant(Field field, const To& to)
{
    switch (field) {
    case Field::noise: return to(std::integral_constant<Field, Field::noise>());
    case Field::perlin: return to(std::integral_constant<Field, Field::perlin>());
    case Field::fbm1: return to(std::integral_constant<Field, Field::fbm1>());
    case Field::fbm2: return to(std::integral_constant<Field, Field::fbm2>());
    case Field::fbm4: return to(std::integral_constant<Field, Field::fbm4>());
    case Field::fbm8: return to(std::integral_constant<Field, Field::fbm8>());
    case Field::gardner7: return to(std::integral_constant<Field, Field::gardner7>());
    }
}

template <Field field, typename Real, typename Number>
Number height(const Point<Number>& q, const Tables<Real>& tables)
{
    if constexpr (field == Field::noise) return plain::noise<false>(q, tables);
    if constexpr (field == Field::perlin) return plain::noise<true>(q, tables);
    if constexpr (octaves(field) > 0) return plain::fbm(q, tables, octaves(field));
    if constexpr (field == Field::gardner7) return plain::fourier<Real>(q, 7);
}

template <Field field, typename Real>
struct Analytic {
    static Sample<Real> sample(const Point<Real>& q, const Block<Real>& block)
    {
        if constexpr (field == Field::noise) return plain::noise_with_gradient<false>(q, *block.tables);
        if constexpr (field == Field::perlin) return plain::noise_with_gradient<true>(q, *block.tables);
        if constexpr (octaves(field) > 0) return plain::fbm_with_gradient(q, *block.tables, octaves(field));
        if constexpr (field == Field::gardner7) return plain::fourier_with_gradient(q, 7);
    }
};

// Gardner's texture with sines of a degree.
template <int degree, typename Real>
struct BySines {
    static Sample<Real> sample(const Point<Real>& q, const Block<Real>&)
    {
        return plain::fourier_with_gradient_in_turns(q, 7, plain::turn_sine<degree, Real>);
    }
};

template <Field field, typename Real>
struct ByDuals {
    static Sample<Real> sample(const Point<Real>& q, const Block<Real>& block)
    {
        const Point<Dual<Real>> moved{{q.x, 1, 0, 0}, {q.y, 0, 1, 0}, {q.z, 0, 0, 1}};
        const Dual<Real> result = height<field, Real>(moved, *block.tables);
        return {result.value, {result.d[0], result.d[1], result.d[2]}};
    }
};

// Central differences: of order 2, 4 or 6 in the step.
template <Field field, typename Real, int order>
struct ByDifferences {
    static Sample<Real> sample(const Point<Real>& q, const Block<Real>& block)
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
                       *static_cast<const Block<Real>*>(block));
    *sample = {found.height, {found.gradient[0], found.gradient[1], found.gradient[2]}, 1, 1, 0};
}

template <typename Method, typename Real>
void batch_entry(const haptel_points* points, uint64_t count, const void* block, const haptel_samples* samples)
{
    const Block<Real>& held = *static_cast<const Block<Real>*>(block);
    for (uint64_t i = 0; i < count; ++i) {
        const Sample<Real> found =
            Method::sample({static_cast<Real>(points->p[0][i]), static_cast<Real>(points->p[1][i]),
                            static_cast<Real>(points->p[2][i])},
                           held);
        samples->height_m[i] = found.height;
        for (size_t axis = 0; axis < 3; ++axis) samples->gradient[axis][i] = found.gradient[axis];
    }
}

template <typename Real>
Tables<Real> tables_of(const ir::Module& module, const std::string& prefix)
{
    Tables<Real> tables{};
    const auto find = [&](const std::string& name) {
        return std::find_if(module.tables.begin(), module.tables.end(),
                            [&](const ir::Table& table) { return table.name == prefix + name; });
    };
    const auto none = module.tables.end();
    if (const auto shuffle = find("_m"); shuffle != none)
        std::copy(shuffle->words.begin(), shuffle->words.end(), tables.shuffle.begin());
    for (const auto& [name, to] : {std::pair{"_gx", &tables.gx}, {"_gy", &tables.gy}, {"_gz", &tables.gz}})
        if (const auto table = find(name); table != none)
            for (size_t i = 0; i < to->size(); ++i) (*to)[i] = static_cast<Real>(table->reals[i % table->size()]);
    return tables;
}

} // namespace

struct PlainMethods::Blocks {
    Tables<double> f64;
    Tables<float> f32;
    std::vector<std::unique_ptr<Block<double>>> blocks_f64;
    std::vector<std::unique_ptr<Block<float>>> blocks_f32;

    const void* add(double step, double)
    {
        return blocks_f64.emplace_back(std::make_unique<Block<double>>(Block<double>{&f64, step})).get();
    }
    const void* add(double step, float)
    {
        return blocks_f32.emplace_back(std::make_unique<Block<float>>(Block<float>{&f32, static_cast<float>(step)}))
            .get();
    }
    template <typename Method, typename Real>
    PlainMethod method(const std::string& name, double step)
    {
        return {name,
                sizeof(Real) == sizeof(double) ? "f64" : "f32",
                step,
                point_entry<Method, Real>,
                batch_entry<Method, Real>,
                add(step, Real())};
    }
};

PlainMethods::PlainMethods(Field of, const ir::Module& module)
    : blocks(new Blocks{tables_of<double>(module, of == Field::noise ? "noise" : "perlin"),
                        tables_of<float>(module, of == Field::noise ? "noise" : "perlin"),
                        {},
                        {}})
    , field(of)
{
    with_constant(field, [&]<Field which>(std::integral_constant<Field, which>) {
        methods.push_back(blocks->method<Analytic<which, double>, double>("cpp_analytic", 0));
        methods.push_back(blocks->method<ByDuals<which, double>, double>("cpp_dual", 0));
        methods.push_back(blocks->method<Analytic<which, float>, float>("cpp_analytic", 0));
        methods.push_back(blocks->method<ByDuals<which, float>, float>("cpp_dual", 0));
    });
    if (field != Field::gardner7) return;
    const auto add_sines = [&]<int... degrees, typename Real>(std::integer_sequence<int, degrees...>, Real) {
        (methods.push_back(blocks->method<BySines<degrees, Real>, Real>("cpp_sine_" + std::to_string(degrees), 0)),
         ...);
    };
    add_sines(std::integer_sequence<int, 3, 5, 7, 9, 11, 13, 15>(), double());
    add_sines(std::integer_sequence<int, 3, 5, 7, 9>(), float());
}

PlainMethods::~PlainMethods()
{
    delete blocks;
}

const std::vector<PlainMethod>& PlainMethods::add_differences(const std::vector<double>& steps)
{
    with_constant(field, [&]<Field which>(std::integral_constant<Field, which>) {
        for (double step : steps) {
            methods.push_back(blocks->method<ByDifferences<which, double, 2>, double>("cpp_difference_2", step));
            methods.push_back(blocks->method<ByDifferences<which, double, 4>, double>("cpp_difference_4", step));
            methods.push_back(blocks->method<ByDifferences<which, double, 6>, double>("cpp_difference_6", step));
            methods.push_back(blocks->method<ByDifferences<which, float, 2>, float>("cpp_difference_2", step));
            methods.push_back(blocks->method<ByDifferences<which, float, 4>, float>("cpp_difference_4", step));
            methods.push_back(blocks->method<ByDifferences<which, float, 6>, float>("cpp_difference_6", step));
        }
    });
    return methods;
}

} // namespace haptel::bench
