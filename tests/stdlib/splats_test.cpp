// Marks against all marks within three cells, from the library's table of random numbers.
#include "tests/stdlib/field.h"
#include "tests/stdlib/lines.h"
#include "tests/stdlib/outlines.h"
#include "tests/support/catch.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>

using namespace haptel::test;

namespace {

// What is random about a cell, 0 .. 255/256.
struct Cell {
    double x, y; // of the mark's middle
    double size, deep;
};

Cell cell_of(int i, int j, uint32_t seed)
{
    uint32_t bits = seed * 2654435769u; // by Fibonacci hashing, then by xorshift and multiplication
    bits ^= bits >> 15;
    bits *= 2246822519u;
    bits ^= bits >> 13;
    const auto byte = [&](int shift) { return static_cast<int>(bits >> shift & 255); };
    const int number = shuffled(shuffled((shuffled(i ^ byte(0)) + j) ^ byte(8)) ^ byte(16));
    const auto random = [&](int offset) { return shuffled(number + offset) / 256.0; };
    return {i + random(0), j + random(101), random(197), random(59)};
}

// What all marks together leave of 1.
double left_of(const Vec3& q, uint32_t seed, const std::function<double(const Cell&)>& mark)
{
    double left = 1;
    const int i0 = static_cast<int>(std::floor(q[0])), j0 = static_cast<int>(std::floor(q[1]));
    for (int i = i0 - 3; i <= i0 + 3; ++i)
        for (int j = j0 - 3; j <= j0 + 3; ++j) left *= 1 - mark(cell_of(i, j, seed));
    return left;
}

double bump(double distance)
{
    return std::pow(std::max(1 - distance * distance, 0.0), 3);
}

} // namespace

TEST_CASE("splat: bumps as wide as they are high, one per cell, and no others count")
{
    for (const double radius : {0.05, 0.3, 0.5})
        for (const uint32_t seed : {0u, 5u}) {
            const std::string call = "splat(q.xy, " + std::to_string(radius) + ", " + std::to_string(seed) + ")";
            CAPTURE(call);
            const Field field(call);
            for (const Vec3& q : points_within(30, 2000)) {
                const double left = left_of(q, seed, [&](const Cell& cell) {
                    const double size = 0.4 + 0.6 * cell.size;
                    return size * bump(std::hypot(q[0] - cell.x, q[1] - cell.y) / (size * radius));
                });
                CHECK(std::fabs(field(q).value - (1 - left)) < 1e-12);
            }
            const Jumps jumps = jumps_along_lines(field, 30, 1500);
            CHECK(jumps.value < 1e-10 * 4.24 / radius + 1e-13);
            CHECK(jumps.gradient < 1e-10 * 51.4 / (radius * radius) + 1e-11);
        }
}

TEST_CASE("scratches: grooves with round ends, one per cell, and no others count")
{
    for (const double width : {0.02, 0.1, 0.5})
        for (const double length : {0.5, 1.2, 2.0})
            for (const uint32_t seed : {0u, 5u}) {
                const std::string call = "scratches(q.xy, " + std::to_string(width) + ", " + std::to_string(length) +
                                         ", " + std::to_string(seed) + ")";
                CAPTURE(call);
                const Field field(call);
                for (const Vec3& q : points_within(30, 1000)) {
                    const double left = left_of(q, seed, [&](const Cell& cell) {
                        const double angle = std::numbers::pi * cell.size, reach = (length - width) / 2;
                        const double x = reach * std::cos(angle), y = reach * std::sin(angle);
                        const double away =
                            segment_distance({q[0], q[1]}, {cell.x - x, cell.y - y}, {cell.x + x, cell.y + y});
                        return (0.4 + 0.6 * cell.deep) * bump(away / (width / 2));
                    });
                    CHECK(std::fabs(field(q).value - left) < 1e-12);
                }
                const Jumps jumps = jumps_along_lines(field, 30, 200);
                CHECK(jumps.value < 1e-10 * 7.9 / width + 1e-13);
                CHECK(jumps.gradient < 1e-10 * 4 * 50.7 / (width * width) + 1e-11);
            }
}

TEST_CASE("marks keep within their cells, whatever is asked for")
{
    for (const char* call : {"splat(q.xy, 9.0, 3)", "splat(q.xy, -1.0, 3)", "scratches(q.xy, 9.0, 9.0, 3)",
                             "scratches(q.xy, 0.5, 0.0, 3)", "scratches(q.xy, 0.1, -1.0, 3)"}) {
        CAPTURE(call);
        const Jumps jumps = jumps_along_lines(Field(call), 30, 1000);
        CHECK(jumps.value < 1e-8);
        CHECK(jumps.gradient < 1e-6);
    }
}
