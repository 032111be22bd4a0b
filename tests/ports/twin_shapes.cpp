// Twins of shapes that are repeated, and of what is made of several: outlines by their geometry.
#include "tests/ports/twin.h"

#include <algorithm>
#include <cmath>

namespace haptel::ports {
namespace {

dvec3 in_cell(dvec3 q) // from its middle
{
    return q - glm::floor(q) - 0.5;
}

double gear_wheels(dvec3 q)
{
    const dvec2 at(in_cell(q));
    const double r = glm::length(at), angle = std::atan2(at.x, at.y);       // from the other axis
    const double rim = 0.34 + 0.06 * ramp(-0.4, 0.4, std::cos(12 * angle)); // twelve teeth are alike from there
    const double gap = ramp(0.1, 0.3, std::fabs(std::sin(2.5 * (pi / 2 - angle))));
    const double hole = gap * ramp(0.16, 0.18, r) * ramp(0.28, 0.26, r);
    return ramp(rim + 0.02, rim - 0.02, r) * ramp(0.1, 0.14, r) * (1 - 0.6 * hole);
}

// Of the ten sides of a star the one in whose sector the place is: that of the nearest notch and the nearest tip.
double folded_star(dvec3 q)
{
    const dvec2 at(q.x - std::round(q.x), q.y - std::round(q.y));
    const auto nearest = [&at](double offset) {
        dvec2 best(1, 0);
        for (int k = 0; k < 5; ++k) {
            const dvec2 way = turned(dvec2(1, 0), (k + offset) * 2 * pi / 5);
            if (k == 0 || glm::dot(way, at) > glm::dot(best, at)) best = way;
        }
        return best;
    };
    const dvec2 notch = 0.2 * nearest(0.5), tip = 0.46 * nearest(0), side = glm::normalize(tip - notch);
    dvec2 outward(side.y, -side.x);
    if (glm::dot(outward, notch) < 0) outward = -outward;
    const double beyond = glm::dot(at - notch, outward);
    return ramp(0, -0.06, beyond) * (0.7 + 0.3 * ramp(-0.06, -0.12, beyond));
}

double rounded_slabs(dvec3 q)
{
    const dvec3 id(std::round(q.x), std::round(q.y), std::round(q.z));
    dvec3 at = q - id;
    const dvec2 flat = turned(dvec2(at), -0.3 * id.x - 0.5 * id.y), up = turned(dvec2(flat.y, at.z), 0.2);
    at = glm::abs(dvec3(flat.x, up.x, up.y));
    // To the box without its rounding: how far the nearest point of it is, or how deep the place is in it.
    const dvec3 core(0.2, 0.12, 0.16), nearest = glm::min(at, core);
    const double outside = glm::distance(at, nearest);
    const double depth = std::min({core.x - at.x, core.y - at.y, core.z - at.z});
    return ramp(0, -0.06, (outside > 0 ? outside : -depth) - 0.08);
}

double melted_blobs(dvec3 q)
{
    for (int i = 0; i < 3; ++i) q[i] = 3 * std::fabs(q[i] / 4 - std::floor(q[i] / 4) - 0.5) - 0.75;
    // Of two distances the less, lowered where they differ by less than `reach`.
    const auto melted = [](double a, double b, double reach) {
        const double apart = std::fabs(a - b);
        return (a + b - apart) / 2 - (apart < reach ? (reach - apart) * (reach - apart) / (4 * reach) : 0);
    };
    const dvec3 from(-0.5, 0.5, 0), way = dvec3(0.5, -0.4, 0.1) - from;
    const double share = glm::clamp(glm::dot(q - from, way) / glm::dot(way, way), 0.0, 1.0);
    const double stick = glm::distance(q, from + share * way) - 0.12;
    const double balls =
        melted(glm::distance(q, dvec3(0.3, 0.2, 0)) - 0.4, glm::distance(q, dvec3(-0.35, -0.25, -0.1)) - 0.3, 0.5);
    const double both = std::min(stick, balls) - std::log1p(std::exp(-16 * std::fabs(stick - balls))) / 16;
    const double bored = -melted(-both, std::hypot(q.x, q.y) - 0.1, 0.16);
    return glm::clamp(0.5 - 2 * bored, 0.0, 1.0);
}

struct Tape {
    double relief, friction;
};
Tape tape(dvec3 q)
{
    const double band = ramp(0.2, 0.3, std::fabs(in_cell(q).x));
    const double stud = ramp(0.35, 0.25, glm::length(dvec2(in_cell(2.0 * q))));
    return {0.6 * band * (1 - stud) + stud, (1 + band) / 2 * (1 - stud) + 1.5 * stud};
}

double bit_weave(dvec3 q)
{
    const int x = static_cast<int>(std::floor(2 * q.x)), y = static_cast<int>(std::floor(2 * q.y));
    int both = 0, one = 0, lowest = 0;
    for (int bit = 8; bit > 0; bit /= 2) { // by the rests of divisions
        const auto has = [bit](int n) { return ((n % 16 + 16) % 16) / bit % 2 == 1; };
        if (has(x) && has(y)) both += bit;
        if (has(x) != has(y)) one += bit, lowest = bit;
    }
    const double level = (2 * both + one / 2 + lowest % 7) % 32 / 31.0;
    const dvec2 from(2 * q.x - x, 2 * q.y - y);
    const int upper = (from.x >= 0.5) + (from.y >= 0.5);
    const auto bumps = [](double at) { return std::sin(pi * at) * std::fabs(std::sin(2 * pi * at)); };
    return level * (1 - 0.1 * upper) * bumps(from.x) * bumps(from.y);
}

double clouds_of_cells(dvec3 q)
{
    double sum = 0, share = 0.6;
    dvec3 at = 0.5 * q;
    for (int layer = 0; layer < 3; ++layer, share *= 0.45, at = 2.1 * at + dvec3(3.1, 7.7, 1.3)) {
        double least = 1e9;
        const dvec3 low = glm::floor(at);
        for (int i = 0; i < 125; ++i) {
            const dvec3 cell = low + dvec3(i % 5, i / 5 % 5, i / 25) - 2.0;
            double a = fraction(cell.x * 0.1973), b = fraction(cell.y * 0.2371), c = fraction(cell.z * 0.1759);
            const double stir = a * (c + 23.7) + b * (a + 23.7) + c * (b + 23.7);
            a += stir, b += stir, c += stir;
            const dvec3 random(fraction((a + b) * c), fraction((a + c) * b), fraction((b + c) * a));
            least = std::min(least, glm::distance(at, cell + 0.35 + 0.3 * random));
        }
        sum += share * (1 - least);
    }
    return sum;
}

} // namespace

std::span<const Twin> shape_twins()
{
    static constexpr const char* within = "shapes end within their cells";
    static constexpr Twin twins[] = {
        {"gear_wheels", gear_wheels, Borders::meet, within},
        {"folded_star", folded_star, Borders::meet, within},
        {"rounded_slabs", rounded_slabs, Borders::meet, within},
        {"melted_blobs", melted_blobs, Borders::meet, "mirrors: both sides are alike"},
        {.pattern = "tape_material",
         .height = [](dvec3 q) { return tape(q).relief; },
         .borders = Borders::meet,
         .borders_why = "bands are even, studs end within their cells",
         .friction = [](dvec3 q) { return tape(q).friction; }},
        {"bit_weave", bit_weave, Borders::meet, "bumps are 0 at their sides"},
        {"clouds_of_cells", clouds_of_cells, Borders::meet, "a least distance, over more points than can be nearest"},
    };
    return twins;
}

} // namespace haptel::ports
