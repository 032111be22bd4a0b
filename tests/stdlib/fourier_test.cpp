// fourier against eq. 7 with B.1 and B.2 as written in the paper, in radians, and its gradient with the cross terms
// that the phases bring: p_i depends on y, q_i on x.
#include "tests/stdlib/field.h"
#include "tests/support/catch.h"

#include <cmath>
#include <numbers>

using namespace haptel::test;

namespace {

struct Series {
    int terms;
    double f, g, p, q; // of the first term
    double amplitude, offset, scale;
};

FieldSample closed_form(const Series& series, double x, double y, bool with_cross_terms = true)
{
    double big_x = 0, big_x_x = 0, big_x_y = 0, big_y = 0, big_y_x = 0, big_y_y = 0;
    double c = series.amplitude, f = series.f, g = series.g;
    for (int i = 1; i <= series.terms; ++i) {
        double p = series.p, p_y = 0, q = series.q, q_x = 0;
        if (i > 1) { // B.2
            p = std::numbers::pi / 2 * std::sin(g * y / 2);
            q = std::numbers::pi / 2 * std::sin(f * x / 2);
            p_y = with_cross_terms ? std::numbers::pi / 4 * g * std::cos(g * y / 2) : 0;
            q_x = with_cross_terms ? std::numbers::pi / 4 * f * std::cos(f * x / 2) : 0;
        }
        const double a = f * x + p, b = g * y + q;
        big_x += c * std::sin(a) + series.offset;
        big_x_x += c * f * std::cos(a);
        big_x_y += c * p_y * std::cos(a);
        big_y += c * std::sin(b) + series.offset;
        big_y_y += c * g * std::cos(b);
        big_y_x += c * q_x * std::cos(b);
        f *= 2; // B.1
        g *= 2;
        c *= std::sqrt(2.0) / 2;
    }
    const double k = series.scale;
    return {k * big_x * big_y, {k * (big_x_x * big_y + big_x * big_y_x), k * (big_x_y * big_y + big_x * big_y_y), 0}};
}

struct Error {
    double value = 0, gradient = 0; // relative to the largest
};

Error error_of(const Field& field, const Series& series, bool with_cross_terms = true)
{
    Error error;
    double value = 0, gradient = 0;
    for (const Vec3& at : points_within(3, 2000)) {
        const FieldSample expected = closed_form(series, at[0], at[1], with_cross_terms), found = field(at);
        value = std::max(value, std::abs(expected.value));
        error.value = std::max(error.value, std::abs(found.value - expected.value));
        for (size_t a = 0; a < 3; ++a) {
            gradient = std::max(gradient, std::abs(expected.gradient[a]));
            error.gradient = std::max(error.gradient, std::abs(found.gradient[a] - expected.gradient[a]));
        }
    }
    return {error.value / value, error.gradient / gradient};
}

// k = 1 / (S + n T_o)^2 keeps |h| within 1.
double unit_scale(int terms)
{
    const double s = (1 - std::pow(2.0, -terms / 2.0)) / (1 - std::sqrt(0.5));
    return 1 / ((s + terms * 0.3) * (s + terms * 0.3));
}

} // namespace

TEST_CASE("fourier in periods is eq. 7 with B.1, B.2 and T_o = 0.3")
{
    for (const int terms : {1, 2, 4, 7}) {
        CAPTURE(terms);
        const Field field("fourier(q.xy, " + std::to_string(terms) + ")");
        const Error error =
            error_of(field, {terms, 2 * std::numbers::pi, 2 * std::numbers::pi, 0, 0, 1, 0.3, unit_scale(terms)});
        CHECK(error.value < 2e-13); // the truth reduces arguments up to 2 pi 3 2^6 by a rounded pi
        CHECK(error.gradient < 2e-13);
    }
}

TEST_CASE("fourier with every symbol open is eq. 7")
{
    const Series series{5, 3.1, 4.7, 0.4, -1.2, 0.8, 0.25, 0.3};
    const Field field("fourier(q.xy, 5, vec2(3.1, 4.7), vec2(0.4, -1.2), 0.8, 0.25, 0.3)");
    const Error error = error_of(field, series);
    CHECK(error.value < 1e-13);
    CHECK(error.gradient < 1e-13);
    CHECK(error_of(field, series, false).gradient > 0.1); // without cross terms it would be another gradient
}

TEST_CASE("fourier without terms is flat, beyond 16 nothing is added")
{
    const Field none("fourier(q.xy, 0)"), negative("fourier(q.xy, -3)"), sixteen("fourier(q.xy, 16)"),
        hundred("fourier(q.xy, 100)");
    for (const Vec3& q : points_within(3, 50)) {
        CHECK(none(q).value == 0);
        CHECK(negative(q).value == 0);
        CHECK(sixteen(q).value == hundred(q).value);
    }
}

TEST_CASE("in space: both phases lean along z, by half a turn times the sine of half the frequency")
{
    const Field field("fourier(q, 3)"), short_form("fourier(q)"), four("fourier(q, 4)"), flat("fourier(q.xy)"),
        flat_four("fourier(q.xy, 4)"), floor("fourier(vec3(q.xy, 0.0), 5)"), flat_five("fourier(q.xy, 5)");
    for (const Vec3& at : points_within(3, 300)) {
        double x = 0, y = 0, most = 0;
        for (int i = 0; i < 3; ++i) {
            const double f = 2 * std::numbers::pi * std::pow(2.0, i), c = std::pow(2.0, -i / 2.0),
                         lean = i > 0 ? std::numbers::pi / 2 : 0;
            const double up = std::numbers::pi * std::sin(f * at[2] / 2);
            x += c * std::sin(f * at[0] + lean * std::sin(f * at[1] / 2) + up) + 0.3;
            y += c * std::sin(f * at[1] + lean * std::sin(f * at[0] / 2) + up) + 0.3;
            most += c + 0.3;
        }
        CHECK(std::abs(field(at).value - x * y / (most * most)) < 1e-13);
        CHECK(short_form(at).value == four(at).value);
        CHECK(flat(at).value == flat_four(at).value);
        CHECK(std::abs(floor(at).value - flat_five(at).value) < 1e-15);
    }
}
