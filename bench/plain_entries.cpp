#include "bench/plain_entries.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace haptel::bench {
namespace {

// What this processor runs, the base first.
std::vector<PlainLevel> levels(Field field)
{
    std::vector<PlainLevel> found{plain_base::level(field)};
#if defined(__x86_64__)
    const bool v3 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2");
    if (v3) found.push_back(plain_v3::level(field));
    if (v3 && __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512dq") &&
        __builtin_cpu_supports("avx512vl"))
        found.push_back(plain_v4::level(field));
#endif
    return found;
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

// sin(2 pi x) / x on a quarter turn as a polynomial in x^2, by interpolation at Chebyshev's points: within a few per
// cent of the least error that the degree allows.
template <typename Real>
std::array<Real, 8> turn_sine_coefficients(int degree)
{
    // Newton's divided differences of sin(2 pi m) / m over u = m^2 in 0 .. 1/16, then multiplied out.
    constexpr long double pi = std::numbers::pi_v<long double>;
    const auto count = static_cast<size_t>((degree + 1) / 2);
    std::array<long double, 8> at{}, value{}, sum{};
    for (size_t i = 0; i < count; ++i) {
        at[i] = (1 - std::cos(pi * (static_cast<long double>(i) + 0.5L) / static_cast<long double>(count))) / 32;
        const long double m = std::sqrt(at[i]);
        value[i] = std::sin(2 * pi * m) / m;
    }
    for (size_t order = 1; order < count; ++order)
        for (size_t i = count - 1; i >= order; --i) value[i] = (value[i] - value[i - 1]) / (at[i] - at[i - order]);
    for (size_t i = count; i-- > 0;) {
        for (size_t power = count - 1; power > 0; --power) sum[power] = sum[power - 1] - at[i] * sum[power];
        sum[0] = value[i] - at[i] * sum[0];
    }
    std::array<Real, 8> coefficients{};
    for (size_t i = 0; i < count; ++i) coefficients[i] = static_cast<Real>(sum[i]);
    return coefficients;
}

} // namespace

PlainMethods::PlainMethods(Field field, const ir::Module& module, const std::vector<double>& steps)
    : f64_(tables_of<double>(module, field == Field::noise ? "noise" : "perlin"))
    , f32_(tables_of<float>(module, field == Field::noise ? "noise" : "perlin"))
{
    const std::vector<double> none{0};
    for (const PlainLevel& level : levels(field))
        for (const PlainEntry& entry : level.entries)
            for (const double step : entry.is_difference ? steps : none)
                methods.push_back({&entry, level.name, level.flags, step, block(entry, step)});
}

const void* PlainMethods::block(const PlainEntry& entry, double step)
{
    if (entry.is_f32)
        return &blocks_f32_.emplace_back(
            PlainBlock<float>{&f32_, static_cast<float>(step), turn_sine_coefficients<float>(entry.sine_degree)});
    return &blocks_f64_.emplace_back(
        PlainBlock<double>{&f64_, step, turn_sine_coefficients<double>(entry.sine_degree)});
}

} // namespace haptel::bench
