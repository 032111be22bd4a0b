// The facts that the library states about itself. Those of the noises are compared with the supremum over all tables of
// unit vectors, found by search: each corner contributes at most the length of what its vector is multiplied by.
#include "tests/stdlib/facts.h"
#include "tests/stdlib/field.h"
#include "tests/support/catch.h"

#include <algorithm>
#include <cmath>

using namespace haptel;
using namespace haptel::test;

namespace {

struct Curve {
    double value, first, second;
};
Curve cubic_curve(double t)
{
    return {t * t * (3 - 2 * t), 6 * t * (1 - t), 6 - 12 * t};
}
Curve quintic_curve(double t)
{
    return {t * t * t * (t * (6 * t - 15) + 10), 30 * t * t * (1 - t) * (1 - t), 60 * t * (2 * t - 1) * (t - 1)};
}

struct Norms {
    double value, slope, curvature; // of N, of its derivative along e, of its second derivative along e
};

// Largest possible at x for unit vectors at the corners: N = sum w (G . d), so N' = sum G . (w e + w' d) and
// N'' = sum G . (2 w' e + w'' d), derivatives along e.
Norms largest_at(Curve (*weight)(double), size_t dimensions, const Vec3& x, const Vec3& e)
{
    Norms sum{};
    for (size_t corner = 0; corner < size_t(1) << dimensions; ++corner) {
        double w = 1, first = 0, second = 0; // of the product of the weights, by the product rule, factor by factor
        Vec3 d{};
        for (size_t a = 0; a < dimensions; ++a) {
            const bool far = corner >> a & 1;
            const Curve far_weight = weight(x[a]);
            const double sign = far ? 1 : -1;
            const double f = far ? far_weight.value : 1 - far_weight.value;
            const double f1 = sign * far_weight.first * e[a], f2 = sign * far_weight.second * e[a] * e[a];
            second = second * f + 2 * first * f1 + w * f2;
            first = first * f + w * f1;
            w *= f;
            d[a] = x[a] - (far ? 1 : 0);
        }
        double value = 0, slope = 0, curvature = 0;
        for (size_t a = 0; a < dimensions; ++a) {
            value += w * d[a] * w * d[a];
            slope += (w * e[a] + first * d[a]) * (w * e[a] + first * d[a]);
            curvature += (2 * first * e[a] + second * d[a]) * (2 * first * e[a] + second * d[a]);
        }
        sum.value += std::sqrt(value);
        sum.slope += std::sqrt(slope);
        sum.curvature += std::sqrt(curvature);
    }
    return sum;
}

void check_facts(const std::string& name, Curve (*weight)(double), size_t dimensions)
{
    const std::string type = dimensions == 3 ? "vec3" : "vec2", argument = dimensions == 3 ? "q" : "q.xy";
    const auto largest = [&](double Norms::* which) {
        return supremum(dimensions, 0, 1,
                        [&](const Vec3& x, const Vec3& e) { return largest_at(weight, dimensions, x, e).*which; });
    };
    const double value = largest(&Norms::value), slope = largest(&Norms::slope), curvature = largest(&Norms::curvature);
    for (const bool seeded : {false, true}) {
        const ir::Facts facts =
            facts_of(name + "(" + type + (seeded ? ",int)" : ")"), name + "(" + argument + (seeded ? ", 3)" : ")"));
        REQUIRE((facts.value_maximum && facts.value_minimum && facts.slope && facts.curvature));
        const auto just_above = [](double fact, double truth) { return fact > truth && fact < truth * 1.0001; };
        CAPTURE(name, type, value, slope, curvature);
        CHECK(just_above(*facts.value_maximum, value));
        CHECK(*facts.value_minimum == -*facts.value_maximum);
        CHECK(just_above(*facts.slope, slope));
        CHECK(just_above(*facts.curvature, curvature));
        CHECK(facts.proven);
    }
}

} // namespace

TEST_CASE("the facts of the noises are the supremum over all unit tables, rounded up")
{
    check_facts("noise", cubic_curve, 3);
    check_facts("noise", cubic_curve, 2);
    check_facts("perlin", quintic_curve, 3);
    check_facts("perlin", quintic_curve, 2);
}

TEST_CASE("the slope facts of fourier are the supremum over phases on their own, rounded up")
{
    // X lies with |dX| in a sum of ellipses; the largest x y' + y x' over that set and itself, over its border by
    // angle.
    constexpr double pi = 3.14159265358979323846;
    const auto supremum = [&](double first_phase, double phase) {
        double best = 0, most = 4 * 0.3;
        for (int i = 0; i < 4; ++i) most += std::pow(2.0, -i / 2.0);
        const auto term = [&](int i) { return std::pow(2.0, -i / 2.0); };
        const auto steep = [&](int i) { return term(i) * 2 * pi * std::pow(2.0, i) * (i == 0 ? first_phase : phase); };
        for (int step = 0; step <= 10'000; ++step) {
            const double u = std::cos(pi / 2 * step / 10'000), v = std::sin(pi / 2 * step / 10'000);
            double x = 4 * 0.3, slope = 0;
            for (int i = 0; i < 4; ++i) {
                const double norm = std::hypot(term(i) * u, steep(i) * v);
                x += term(i) * term(i) * u / norm;
                slope += steep(i) * steep(i) * v / norm;
            }
            double support = 4 * 0.3 * slope;
            for (int i = 0; i < 4; ++i) support += std::hypot(term(i) * slope, steep(i) * x);
            best = std::max(best, support / (most * most));
        }
        return best;
    };
    const double plane = supremum(1, std::hypot(1, pi / 4)),
                 space = supremum(std::hypot(1, pi / 2), std::hypot(1, pi / 4, pi / 2));
    const double plane_fact = facts_of("fourier(vec2)", "fourier(q.xy)").slope.value(),
                 space_fact = facts_of("fourier(vec3)", "fourier(q)").slope.value();
    CHECK((plane_fact > plane && plane_fact < plane * 1.0001));
    CHECK((space_fact > space && space_fact < space * 1.0001));
}

TEST_CASE("the slope facts of cellular are 1 and what its factor adds at most, rounded up")
{
    const auto added = [](double dimensions, double spread, int others) {
        const double near = dimensions * (0.5 + spread) * (0.5 + spread), far = (2 - spread) * (2 - spread);
        double most = 0;
        for (const double k : {0.01, 0.1, 0.2, 0.3}) {
            const double c = k / (4 * std::log(2.0));
            const auto rounded = [&](double square) { return std::sqrt(square + k * k) - k; };
            for (int step = 1; step < 10'000; ++step) {
                const double t = step / 10'000.0, square = near + (far - near) * t;
                const double factor = 1 - t * t * (3 - 2 * t);
                const double slope = 6 * t * (1 - t) / (far - near) * 2 * std::sqrt(square);
                const double weight = others * std::exp((rounded(near) - rounded(square)) / c);
                most = std::max(most, c * slope * weight / (1 + factor * weight));
            }
        }
        return most;
    };
    const double plane = 1 + added(2, 0.4, 15), space = 1 + added(3, 0.3, 63);
    const double plane_fact = facts_of("cellular(vec2,float)", "cellular(q.xy, 0.1)").slope.value(),
                 space_fact = facts_of("cellular(vec3,float)", "cellular(q, 0.1)").slope.value();
    CHECK((plane_fact > plane && plane_fact < plane * 1.01));
    CHECK((space_fact > space && space_fact < space * 1.01));
}

TEST_CASE("the slope of a triplanar share is that of its formula in two numbers")
{
    double steepest = 0;
    for (double sum = 0.001; sum < 4; sum += 0.001) {
        const double t = std::max(1 - std::fabs(sum - 0.2) / 0.13, 0.0); // smoothmax(sum, 0.2, 0.13)
        const double held = std::max(sum, 0.2) + 0.25 * 0.13 * t * t, change = sum > 0.2 ? 1 - t / 2 : t / 2;
        for (double part = 0; part < 1; part += 0.001) {
            const double u = part * sum / held;
            const double along = 4 * std::pow(u, 0.75) / std::pow(held, 0.25) * (1 - u * change);
            const double across = 4 * u * change * std::pow(sum - u * held, 0.75) / held;
            steepest = std::max(steepest, std::hypot(along, across));
        }
    }
    const double fact = facts_of("triplanar_share(vec3)", "triplanar_share(q)").slope.value();
    CHECK((fact > steepest && fact < steepest * 1.01));
}

TEST_CASE("no fact is exceeded anywhere")
{
    const auto check = [](const std::string& function, const std::string& call, double size) {
        check_never_exceeded(call, facts_of(function, call), size);
    };
    check("noise(vec3)", "noise(q)", 50);
    check("noise(vec2)", "noise(q.xy)", 50);
    check("perlin(vec3)", "perlin(q)", 50);
    check("perlin(vec2)", "perlin(q.xy)", 50);
    for (const std::string octaves : {"1", "4", "16"}) {
        check("fbm(vec3,int)", "fbm(q, " + octaves + ")", 50);
        check("fbm(vec2,int)", "fbm(q.xy, " + octaves + ")", 50);
        check("turbulence(vec3,int)", "turbulence(q, " + octaves + ")", 50);
        check("turbulence(vec2,int)", "turbulence(q.xy, " + octaves + ")", 50);
        check("ridged(vec3,int)", "ridged(q, " + octaves + ")", 50);
        check("ridged(vec2,int)", "ridged(q.xy, " + octaves + ")", 50);
        check("fourier(vec2,int)", "fourier(q.xy, " + octaves + ")", 5);
    }
    for (const std::string octaves : {"1", "4", "16"}) {
        check("hybrid(vec3,int)", "hybrid(q, " + octaves + ")", 50);
        check("hybrid(vec2,int)", "hybrid(q.xy, " + octaves + ")", 50);
        check("fourier(vec3,int)", "fourier(q, " + octaves + ")", 5);
    }
    check("fourier(vec2)", "fourier(q.xy)", 5);
    check("fourier(vec3)", "fourier(q)", 5);
    check("noise_periodic(vec3,int,int,int)", "noise_periodic(q, 3, 4, 5)", 50);
    check("noise_periodic(vec2,int,int)", "noise_periodic(q.xy, 3, 1)", 50);
    check("perlin_periodic(vec3,int,int,int)", "perlin_periodic(q, 3, 4, 5)", 50);
    check("perlin_periodic(vec2,int,int)", "perlin_periodic(q.xy, 3, 1)", 50);
    check("white_spline(vec3,int)", "white_spline(q, 3)", 50);
    check("white_spline(vec2,int)", "white_spline(q.xy, 3)", 50);
    check("white(vec3,float)", "white(q, 0.7)", 50);
    check("white(vec2,float)", "white(q.xy, 0.7)", 50);
    for (const std::string smoothing : {"0.0", "0.1", "9.0"}) {
        check("cellular(vec3,float)", "cellular(q, " + smoothing + ")", 20);
        check("cellular(vec2,float)", "cellular(q.xy, " + smoothing + ")", 50);
    }
    check("triplanar_share(vec3)", "triplanar_share(q)", 1.5);
    check("triplanar_blend(vec3,vec3)", "triplanar_blend(q, vec3(0.36, 0.48, -0.8))", 1);
    check("pole_fade(vec3,vec3,vec3,float)", "pole_fade(q, vec3(0.0), vec3(2.0), 0.2)", 1);
    check("center_fade(vec3,vec3,vec3,float)", "center_fade(q, vec3(0.0), vec3(2.0), 0.2)", 1);
    check("weave(vec2)", "weave(q.xy)", 5);
    check("flank_profile(float)", "flank_profile(q.x)", 1.5);
    check("bump_profile(vec2)", "bump_profile(q.xy)", 1.5);
    check("smoothmin_of(vec2,float)", "smoothmin_of(q.xy, 0.3)", 2);
    check("wave(float)", "wave(q.x)", 5);
    check("grating(float,float,float)", "grating(q.x, 0.4, 0.2)", 5);
    check("bumps(vec2,float)", "bumps(q.xy, 0.4)", 5);
    check("smoothabs(float,float)", "smoothabs(q.x, 0.3)", 2);
    check("smoothmin(float,float,float)", "smoothmin(q.x, 0.4, 0.3)", 2);
    check("smoothmax(float,float,float)", "smoothmax(q.x, 0.4, 0.3)", 2);
}
