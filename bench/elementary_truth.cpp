#include "bench/elementary_truth.h"

#include "lang/ir/elementary_functions.h"
#include "lang/ir/op_info.h"
#include "lang/ir/semantics.h"

#include <bit>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

namespace haptel::ir {
namespace {

template <typename Float>
double units(Float found, const Quad& exact)
{
    using Limits = std::numeric_limits<Float>;
    constexpr double wrong = 1e300;
    if (exact != exact || found != found) return exact != exact && found != found ? 0 : wrong;
    if (exact == 0) return found == 0 ? 0 : wrong;
    const Quad limit = ldexp(Quad(1), Limits::max_exponent);
    const bool overflows = fabs(exact) >= limit;
    if (std::isinf(found) && overflows) return (found > 0) == (exact > 0) ? 0 : wrong;
    int exponent = 0;
    frexp(exact, &exponent);
    exponent =
        std::max(std::min(exponent, Limits::max_exponent) - Limits::digits, Limits::min_exponent - Limits::digits);
    const Quad held = std::isinf(found) ? found > 0 ? limit : Quad(-limit) : Quad(static_cast<double>(found));
    return static_cast<double>(
        fabs(ldexp(Quad(held - (overflows ? (exact > 0 ? limit : Quad(-limit)) : exact)), -exponent)));
}

// The ends of where some function is finite and not 0, in f64 and in f32, and others where one is made differently.
constexpr double thresholds[] = {709.782712893384,
                                 -745.1332191019411,
                                 -708.3964185322641,
                                 88.72283905206835,
                                 -103.97207708399179,
                                 1024,
                                 -1075,
                                 -1022,
                                 128,
                                 -150,
                                 -126,
                                 710.4758600739439,
                                 -710.4758600739439,
                                 89.41598629223294,
                                 -89.41598629223294,
                                 1,
                                 -1,
                                 0.5,
                                 -0.5,
                                 19.06154746539849,
                                 9.010913347279289,
                                 22,
                                 10};

double uniform(std::mt19937_64& random, double from, double to)
{
    return std::uniform_real_distribution<double>(from, to)(random);
}

double any_bits(std::mt19937_64& random)
{
    const double made = std::bit_cast<double>(random());
    return made == made ? made : 1;
}

#ifndef HAPTEL_QUAD_IS_FLOAT128
// Boost's number reduces an angle by as many digits of pi as it has itself.
Quad truth_of_large_angle(Op op, double angle)
{
    using namespace boost::multiprecision;
    using Wide = number<cpp_bin_float<1400, digit_base_2>>;
    return static_cast<Quad>(semantics::elementary_value(op, Wide(angle), Wide(0)));
}
#endif

} // namespace

Quad elementary_truth(Op op, double a, double b)
{
#ifndef HAPTEL_QUAD_IS_FLOAT128
    if (takes_angle(op) && std::fabs(a) > 1e9) return truth_of_large_angle(op, a);
#endif
    return semantics::elementary_value(op, Quad(a), Quad(b));
}

float elementary_f32(Op op, float a, float b)
{
    using R = elementary::Number<float>;
    return elementary::apply(op, R(static_cast<double>(a)), R(static_cast<double>(b))).value;
}

float elementary_f32_of_angle(Op op, double a)
{
    return elementary::apply_to_angle(op, elementary::Number<double>(a)).value;
}

std::vector<Op> elementary_ops()
{
    std::vector<Op> found;
    for (const OpInfo& info : all_ops())
        if (is_elementary(info.op)) found.push_back(info.op);
    return found;
}

std::vector<std::pair<double, double>> elementary_arguments(Op op, int count)
{
    std::mt19937_64 random(static_cast<uint64_t>(op) + 1);
    std::vector<std::pair<double, double>> made;
    for (int i = 0; i < count; ++i) {
        made.emplace_back(any_bits(random), any_bits(random)); // every exponent
        const auto some = [&](int low, int high) {
            return std::ldexp(uniform(random, -2, 2), static_cast<int>(uniform(random, low, high)));
        };
        made.emplace_back(some(-40, 40), some(-40, 40));
        made.emplace_back(some(-140, 127), some(-140, 127)); // of f32
        made.emplace_back(uniform(random, -1, 1), uniform(random, -1, 1));
        made.emplace_back(uniform(random, -30, 30), uniform(random, -30, 30));
        made.emplace_back(uniform(random, -750, 750), uniform(random, -750, 750));
        made.emplace_back(1 + some(-60, -1), uniform(random, -1000, 1000));
        made.emplace_back(std::fabs(some(-30, 30)), uniform(random, -40, 40));
        // a power near the ends of the range, in f64 and in f32
        const double base = std::fabs(some(-60, 60)), ends[] = {1024, -1022, -1075, 128, -126, -150};
        made.emplace_back(base, (ends[random() % 6] + uniform(random, -1, 1)) / std::log2(base));
        // where the logarithm's rounding counts most: a base of no exponent, a result at the end of the range
        const double halfway = (i % 2 ? std::numbers::sqrt2 : 1 / std::numbers::sqrt2) * uniform(random, 0.999, 1.001);
        made.emplace_back(halfway, uniform(random, 1000, 1024) * (i % 4 < 2 ? 1 : -1) / std::log2(halfway));
        made.emplace_back(std::floor(uniform(random, -9, 9)), std::floor(uniform(random, -300, 300)));
        // what is nearest to a multiple of a quarter turn, and its neighbours
        const Quad quarter = Quad(2) * atan(Quad(1));
        const auto turns = std::floor(std::exp2(uniform(random, 0, 50)));
        const auto near = static_cast<double>(Quad(turns * quarter));
        made.emplace_back(i % 3 ? near : std::nextafter(near, i % 2 ? HUGE_VAL : -HUGE_VAL), near);
        // where the argument is a float
        made.emplace_back(static_cast<double>(static_cast<float>(near)), near);
    }
    for (const double at : thresholds)
        for (int step = -20; step <= 20; ++step) {
            made.emplace_back(at + step * std::fabs(at) * 0x1p-53, at);
            made.emplace_back(at + step * std::fabs(at) * 0x1p-24, at);
        }
    // the double that is nearest of all to a multiple of a quarter turn, and one where ours reduce in two ways
    for (const double angle : {6381956970095103 * 0x1p797, 0x1p20, 0x1p20 + 0x1p-32, 0x1p1023, 1e22})
        for (const double sign : {1.0, -1.0}) made.emplace_back(sign * angle, angle);
    return made;
}

double units_off(double found, const Quad& exact)
{
    return units(found, exact);
}

double units_off(float found, const Quad& exact)
{
    return units(found, exact);
}

} // namespace haptel::ir
