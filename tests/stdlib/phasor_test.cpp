// gabor and phasor against sums of complex waves that are worked out here, over a window wider than they need; their
// facts against the suprema that they are made of; and what both papers say of them: one wavelength, one direction, and
// for phasor one height.
#include "tests/stdlib/facts.h"
#include "tests/stdlib/pcg4d.h"
#include "tests/support/catch.h"

#include <cmath>
#include <complex>
#include <numbers>

using namespace haptel;
using namespace haptel::test;

namespace {

constexpr double windows = 3.1875, half_rms = 1 / 1.4927;

struct Noise {
    double frequency, angle, spread;
    int seed;
};

std::complex<double> waves(const Vec3& q, const Noise& noise)
{
    std::complex<double> sum = 0;
    const int i0 = static_cast<int>(std::floor(q[0])), j0 = static_cast<int>(std::floor(q[1]));
    for (int i = i0 - 4; i <= i0 + 4; ++i)
        for (int j = j0 - 4; j <= j0 + 4; ++j) {
            const double x = q[0] - i, y = q[1] - j, window = std::pow(std::max(1 - (x * x + y * y) / 4, 0.0), 3);
            const Four bits = pcg4d(i, j, noise.seed, 0);
            const double angle = noise.angle + noise.spread * (2 * unit_of(bits[1]) - 1);
            const double turns = noise.frequency * (x * std::cos(angle) + y * std::sin(angle)) + unit_of(bits[0]);
            sum += std::polar(window, 2 * std::numbers::pi * turns);
        }
    return sum;
}

std::complex<double> expected_phasor(const Vec3& q, const Noise& noise)
{
    const std::complex<double> sum = waves(q, noise);
    const double r = std::min(std::abs(sum) / half_rms, 1.0);
    return std::polar((15 * r - 10 * r * r * r + 3 * std::pow(r, 5)) / 8, std::arg(sum));
}

// The greater eigenvalue of (a b; b c).
double eigenvalue(double a, double b, double c)
{
    return (a + c) / 2 + std::hypot((a - c) / 2, b);
}

// The largest sums of the windows' values, of their slopes along one direction, and of their second derivatives.
double window_sum(int order)
{
    return supremum(2, 0, 1, [&](const Vec3& x, const Vec3& e) {
        double sum = 0;
        for (int i = -2; i <= 3; ++i)
            for (int j = -2; j <= 3; ++j) {
                const double dx = x[0] - i, dy = x[1] - j, t = 1 - (dx * dx + dy * dy) / 4,
                             along = dx * e[0] + dy * e[1];
                if (t <= 0) continue;
                sum += std::fabs(order == 0   ? t * t * t
                                 : order == 1 ? 1.5 * t * t * along
                                              : 1.5 * t * along * along - 1.5 * t * t);
            }
        return sum;
    });
}

const auto just_above = [](double fact, double truth) { return fact > truth && fact < truth * 1.001; };

} // namespace

TEST_CASE("gabor is the real part of a sum of waves in windows")
{
    const Field field("gabor(q.xy, 2.5, 0.7, 0.0)"), spread("gabor(q.xy, 1.5, 0.7, 0.9, 7)");
    for (const double size : {5.0, 5000.0})
        for (const Vec3& q : points_within(size, 1000)) {
            CHECK(std::fabs(field(q).value - waves(q, {2.5, 0.7, 0, 0}).real() / windows) < 1e-11);
            CHECK(std::fabs(spread(q).value - waves(q, {1.5, 0.7, 0.9, 7}).real() / windows) < 1e-11);
        }
}

TEST_CASE("phasor is the sine of the phase of that sum, 0 where the sum is, phasor2 cosine and sine")
{
    const Field field("phasor(q.xy, 2.5, 0.7)"), seeded("phasor(q.xy, 1.5, 0.7, 7)"), sine("phasor2(q.xy, 2.5, 0.7).y"),
        cosine("phasor2(q.xy, 1.5, 0.7, 7).x");
    int faded = 0;
    for (const double size : {5.0, 5000.0})
        for (const Vec3& q : points_within(size, 1000)) {
            const std::complex<double> one = expected_phasor(q, {2.5, 0.7, 0, 0}),
                                       other = expected_phasor(q, {1.5, 0.7, 0, 7});
            faded += std::abs(one) < 0.9;
            CHECK(std::fabs(field(q).value - one.imag()) < 1e-10);
            CHECK(sine(q).value == field(q).value);
            CHECK(std::fabs(seeded(q).value - other.imag()) < 1e-10);
            CHECK(std::fabs(cosine(q).value - other.real()) < 1e-10);
        }
    CHECK(faded > 100);
}

TEST_CASE("the facts of gabor and phasor are made of suprema over all phases, rounded up, and never exceeded")
{
    const double w0 = window_sum(0), w1 = window_sum(1) / w0, w2 = window_sum(2) / w0;
    CHECK(std::fabs(w0 - windows) < 1e-9);
    CHECK(std::fabs(w1 - 1.25) < 1e-9);
    CHECK(std::fabs(w2 - 45.0 / 17) < 1e-9);
    const std::string gabor = "gabor_sum(vec4(q, 0.3), 2.0, 0.7, 0.9, 4, 5, 6)",
                      phasor = "phasor_pair(q, vec2(1.0, 2.0), 4, 5, 6).y";
    const ir::Facts gabor_facts = facts_of("gabor_sum(vec4,float,float,float,int,int,int)", gabor),
                    phasor_facts = facts_of("phasor_pair(vec3,vec2,int,int,int)", phasor);
    CHECK(just_above(gabor_facts.slope.value(), std::hypot(w1, 2 * std::numbers::pi)));
    CHECK(just_above(gabor_facts.curvature.value(),
                     eigenvalue(w2, 2 * std::numbers::pi * w1, 4 * std::numbers::pi * std::numbers::pi)));

    // F(x + i y) by its imaginary part, whose slope and bend are those of the whole turned.
    const auto height = [](double x, double y) {
        const double v = x * x + y * y;
        return y * (v < 1 ? 1.875 - 1.25 * v + 0.375 * v * v : 1 / std::sqrt(v));
    };
    double bend = 0, steep = 0, most = 0;
    for (double r = 0; r < 2; r += 0.002)
        for (double angle = 0; angle < std::numbers::pi; angle += 0.02) {
            const double x = r * std::cos(angle), y = r * std::sin(angle), h = 1e-4;
            const double xx = height(x + h, y) + height(x - h, y) - 2 * height(x, y),
                         yy = height(x, y + h) + height(x, y - h) - 2 * height(x, y),
                         xy = (height(x + h, y + h) + height(x - h, y - h) - height(x + h, y - h) -
                               height(x - h, y + h)) /
                              4;
            bend = std::max({bend, eigenvalue(xx, xy, yy) / (h * h), eigenvalue(-xx, -xy, -yy) / (h * h)});
            steep = std::max(
                steep, std::hypot(height(x + h, y) - height(x - h, y), height(x, y + h) - height(x, y - h)) / (2 * h));
            most = std::max(most, std::fabs(height(x, y)));
        }
    CHECK(std::fabs(bend - 2.8868) < 1e-3);
    CHECK(std::fabs(steep - 1.875) < 1e-6);
    CHECK(most <= 1);
    const double c1 = w1 * w0 / half_rms, c2 = w2 * w0 / half_rms;
    CHECK(just_above(phasor_facts.slope.value(), std::hypot(1.875 * c1, 2 * std::numbers::pi)));
    CHECK(just_above(phasor_facts.curvature.value(),
                     eigenvalue(2.8868 * c1 * c1 + 1.875 * c2, 2 * std::numbers::pi * 1.875 * c1,
                                4 * std::numbers::pi * std::numbers::pi)));
    check_never_exceeded(gabor, gabor_facts, 1);
    check_never_exceeded(phasor, phasor_facts, 1);

    for (const double frequency : {0.0, 1.0, 4.0}) {
        const std::string given = "(q.xy, " + std::to_string(frequency) + ", 0.7";
        const double long_one = std::sqrt(1 + frequency * frequency);
        const auto stretched = [&](ir::Facts facts) {
            facts.slope = *facts.slope * long_one;
            facts.curvature = *facts.curvature * long_one * long_one;
            return facts;
        };
        check_never_exceeded("gabor" + given + ", 0.9)", stretched(gabor_facts), 50, 5000);
        check_never_exceeded("phasor" + given + ")", stretched(phasor_facts), 50, 5000);
    }
}

TEST_CASE(
    "gabor and phasor have one wavelength and one direction, phasor one height, and both all directions by spread")
{
    // Means over many places: the square of the height and the product with that half a wave on.
    const auto share = [](const std::string& call, const Vec3& way, double& square) {
        const Field field(call);
        double product = 0;
        square = 0;
        const int count = 4000;
        for (const Vec3& q : points_within(500, count)) {
            const double here = field(q).value;
            square += here * here / count;
            product += here * field({q[0] + way[0], q[1] + way[1], 0}).value / count;
        }
        return product / square;
    };
    const double angle = 0.6, half = 0.25; // of a wave of frequency 2
    const Vec3 across{half * std::cos(angle), half * std::sin(angle), 0}, along{-across[1], across[0], 0};
    double square = 0;
    CHECK(share("gabor(q.xy, 2.0, 0.6, 0.0)", across, square) < -0.9);
    CHECK(share("gabor(q.xy, 2.0, 0.6, 0.0)", along, square) > 0.9);
    CHECK(std::fabs(std::sqrt(square) - std::sqrt(4 * std::numbers::pi / 7 / 2) / windows) <
          0.02); // the mean square of one window: 4 pi / 7
    CHECK(share("phasor(q.xy, 2.0, 0.6)", across, square) < -0.8);
    CHECK(share("phasor(q.xy, 2.0, 0.6)", along, square) > 0.8);
    CHECK(square > 0.4); // of a sine everywhere: 1/2
    const double one = share("gabor(q.xy, 2.0, 0.6, 1.5707963)", across, square),
                 other = share("gabor(q.xy, 2.0, 0.6, 1.5707963)", along, square);
    CHECK(std::fabs(one - other) < 0.1);
}
