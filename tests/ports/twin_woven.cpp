// Twins of cloths: threads, ribs and stitches, by the distance to the middle of the nearest one.
#include "tests/ports/twin.h"

#include <algorithm>
#include <cmath>

namespace haptel::ports {
namespace {

// To the nearest number that is a whole one and a half.
double from_middle(double x)
{
    return x - std::floor(x) - 0.5;
}
// 1 there, 0 at whole numbers.
double dome(double x)
{
    return 1 - 4 * from_middle(x) * from_middle(x);
}

double weave_over_under(dvec3 q)
{
    const double x = 2 * q.x, y = 2 * q.y;
    const double warp_side = is_odd(std::floor(x)) ? -0.4 : 0.4, weft_side = is_odd(std::floor(y)) ? 0.4 : -0.4;
    return std::max(dome(x) * (0.6 + warp_side * std::sin(pi * y)), dome(y) * (0.6 + weft_side * std::sin(pi * x)));
}

double knit_rows(dvec3 q)
{
    const double lean = std::fabs(from_middle(q.x)), wave = std::cos(2 * pi * (1.6 * q.y - 1.2 * lean));
    return ramp(0.3, 0, std::fabs(lean - 0.25)) * (0.75 + wave / 4) * (0.7 + 0.3 * wave);
}

double carbon_twill(dvec3 q)
{
    const double x = 1.5 * q.x, y = 1.5 * q.y;
    const auto tow = [](double at) { return std::sqrt(dome(at) + 0.04) - 0.2; };
    const double diagonal = std::floor(x) + std::floor(y), of_four = diagonal - 4 * std::floor(diagonal / 4);
    const double on_top = of_four < 2 ? x : y;
    return tow(x) * tow(y) * (0.9 - 0.05 * std::sin(18 * pi * from_middle(on_top))); // half a cell is nine half waves
}

double corduroy(dvec3 q)
{
    const auto fuzz = [](double x) {
        const auto random = [](double n) { return fraction(std::sin(n * 78.233) * 437.5); };
        const double low = std::floor(x), up = fade3(x - low);
        return (1 - up) * random(low) + up * random(low + 1) - 0.5;
    };
    const double lean = 0.08 * fuzz(3 * q.y) + 0.03 * fuzz(11 * q.y + 5);
    const double rib = std::pow(std::cos(pi * (2 * q.x + lean)), 2); // the cosine of half the angle
    return std::pow(rib, 0.8) * (1 + 0.1 * fuzz(7 * q.x + 13 * q.y));
}

double twisted_rope(dvec3 q)
{
    const double across = 2 * from_middle(q.y), handed = is_odd(std::floor(q.y)) ? 1 : -1;
    const double angle = std::asin(glm::clamp(across, -0.999, 0.999));
    return (1 - across * across) * (0.7 + 0.3 * std::fabs(std::sin(3 * q.x + handed * angle)));
}

double satin_floats(dvec3 q)
{
    const double x = 3 * q.x, y = 3 * q.y;
    const double dip = 2 * std::floor(x); // of the thread: two farther from each to the next, of five
    const double apart = y - dip, to_dip = std::fabs(apart - 5 * std::round(apart / 5));
    return dome(x) * (1 - 0.8 * ramp(0.8, 0, to_dip));
}

} // namespace

std::span<const Twin> woven_twins()
{
    static constexpr const char* threads = "threads are 0 at their sides";
    static constexpr Twin twins[] = {
        {"weave_over_under", weave_over_under, Borders::meet, threads},
        {"knit_rows", knit_rows, Borders::meet, "both legs of a stitch are alike"},
        {"carbon_twill", carbon_twill, Borders::meet, threads},
        {"corduroy", corduroy, Borders::meet, "ribs are a cosine, fuzz shares its corners"},
        {"twisted_rope", twisted_rope, Borders::meet, threads},
        {"satin_floats", satin_floats, Borders::meet, threads},
    };
    return twins;
}

} // namespace haptel::ports
