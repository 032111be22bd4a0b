// Pictures of several kinds: how close their bounds are, and where they go outside of their edges.
#include "lang/ir/bounds/spline_image.h"
#include "lang/math/spline.h"
#include "tests/support/catch.h"

#include <cmath>
#include <numbers>
#include <random>

using namespace haptel::ir;

namespace {

constexpr std::pair<uint32_t, uint32_t> all_orders[] = {{0, 0}, {1, 0}, {0, 1}, {2, 0}, {1, 1}, {0, 2}};

struct Drawing {
    const char* name;
    int width, height;
    double (*texel)(int x, int y);

    std::shared_ptr<const SplineImage> image() const
    {
        std::vector<double> texels;
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) texels.push_back(texel(x, y));
        std::string error;
        auto made = SplineImage::make({texels, {}, width, height}, {}, error);
        REQUIRE(made);
        return made;
    }
};

double noise(int x, int y)
{
    const double turns = 43758.5453 * std::sin(12.9898 * x + 78.233 * y);
    return turns - std::floor(turns);
}
double checkerboard(int x, int y)
{
    return (x + y) % 2;
}
double stripes(int x, int)
{
    return x % 2;
}
double halftone(int x, int y)
{
    return (x / 3 + y / 3) % 2;
}
double smooth(int x, int y)
{
    return std::sin(0.25 * x) * std::cos(0.4 * y);
}

constexpr Drawing drawings[] = {{"noise", 24, 20, noise},       {"checkerboard", 8, 8, checkerboard},
                                {"stripes", 8, 1, stripes},     {"halftone", 12, 12, halftone},
                                {"smooth", 25, 16, smooth},     {"pair", 2, 1, stripes},
                                {"column", 1, 5, checkerboard}, {"texel", 1, 1, noise}};

// Lowest and highest of samples over a rectangle, its corners among them.
Interval sampled(const SplineImage& image, const Interval& x, const Interval& y, int columns, int rows, uint32_t orders)
{
    const auto place = [](const Interval& at, int i, int count) {
        return at.minimum + (at.maximum - at.minimum) * i / (count - 1);
    };
    Interval found{infinity, -infinity};
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < columns; ++i) {
            const double value = spline(&image.view(), place(x, i, columns), place(y, j, rows), orders);
            found.minimum = std::min(found.minimum, value);
            found.maximum = std::max(found.maximum, value);
        }
    return found;
}

void check_holds_closely(const Interval& bounds, const Interval& found, double factor, double step)
{
    CAPTURE(bounds.minimum, found.minimum, found.maximum, bounds.maximum);
    CHECK(bounds.minimum <= found.minimum);
    CHECK(bounds.maximum >= found.maximum);
    CHECK(bounds.maximum - bounds.minimum <= factor * (found.maximum - found.minimum) + step);
}

} // namespace

TEST_CASE("picture: bounds hold everything that samples find, and are at most 1.08 times as wide")
{
    for (const Drawing& drawing : drawings) {
        const auto image = drawing.image();
        for (uint32_t edge = 0; edge < spline_edges; ++edge)
            for (const auto& [by_x, by_y] : all_orders) {
                CAPTURE(drawing.name, edge, by_x, by_y);
                const uint32_t orders = spline_order(by_x, by_y, edge);
                // once there and once turned round
                const Interval x{-3, 2.0 * drawing.width + 1}, y{-3, 2.0 * drawing.height + 1};
                const Interval wide{-1e6, 1e6};
                const auto eighths = [](const Interval& at) { return int(8 * (at.maximum - at.minimum)) + 1; };
                const Interval found = sampled(*image, x, y, eighths(x), eighths(y), orders);
                check_holds_closely(image->bounds(wide, wide, orders), found, 1.08, 1e-11);
            }
    }
}

TEST_CASE("picture: bounds of a part hold its samples, and are at most 1.15 times as wide")
{
    std::mt19937 random(3);
    for (const Drawing& drawing : drawings) {
        const auto image = drawing.image();
        for (int round = 0; round < 150; ++round) {
            const auto edge = uint32_t(random() % spline_edges);
            const auto& [by_x, by_y] = all_orders[random() % std::size(all_orders)];
            const double sides[] = {0, 0.01, 0.3, 1, 2.5};
            std::uniform_real_distribution<double> at_x(-5, drawing.width + 3), at_y(-5, drawing.height + 3);
            const double left = at_x(random), low = at_y(random);
            const Interval x{left, left + sides[random() % 5]}, y{low, low + sides[random() % 5]};
            CAPTURE(drawing.name, edge, by_x, by_y, x.minimum, x.maximum, y.minimum, y.maximum);
            const uint32_t orders = spline_order(by_x, by_y, edge);
            check_holds_closely(image->bounds(x, y, orders), sampled(*image, x, y, 40, 40, orders), 1.15, 1e-10);
        }
    }
}

TEST_CASE("picture: bounds of a checkerboard are those of the closed form")
{
    // Tiled it is 1/2 - g(x) g(y) / 2 with g = 1 - 6 f^2 + 4 f^3 on each second cell and its opposite on the others:
    // values up to 1, slopes up to 3, second derivatives up to 12.
    const auto image = drawings[1].image();
    const double largest[] = {1, 3, 12}; // of g
    for (const auto& [by_x, by_y] : all_orders) {
        const Interval bounds = image->bounds({-1e6, 1e6}, {-1e6, 1e6}, spline_order(by_x, by_y, HAPTEL_EDGE_TILED));
        const double middle = by_x + by_y == 0 ? 0.5 : 0, size = largest[by_x] * largest[by_y] / 2;
        CAPTURE(by_x, by_y);
        CHECK(std::fabs(bounds.minimum - (middle - size)) < 1e-10);
        CHECK(std::fabs(bounds.maximum - (middle + size)) < 1e-10);
    }
}

TEST_CASE(
    "picture: a clamped one is level from two texels beyond its last ones on, at the height of the texel at its edge")
{
    for (const Drawing& drawing : drawings) {
        const auto image = drawing.image();
        const int last_x = drawing.width - 1, last_y = drawing.height - 1;
        const auto height = [&](double x, double y) { return spline(&image->view(), x, y, 0); };
        CAPTURE(drawing.name);
        for (const double far : {2.0, 2.7, 50.0, 1e300, infinity}) {
            for (int y = 0; y <= last_y; ++y) {
                CHECK(std::fabs(height(-far, y) - drawing.texel(0, y)) < 1e-14);
                CHECK(std::fabs(height(last_x + far, y) - drawing.texel(last_x, y)) < 1e-14);
            }
            for (int x = 0; x <= last_x; ++x) {
                CHECK(std::fabs(height(x, -far) - drawing.texel(x, 0)) < 1e-14);
                CHECK(std::fabs(height(x, last_y + far) - drawing.texel(x, last_y)) < 1e-14);
            }
            CHECK(std::fabs(height(-far, last_y + far) - drawing.texel(0, last_y)) < 1e-14);
            CHECK(std::fabs(spline(&image->view(), -far, 0.3, spline_order(1, 0))) < 1e-14);
            CHECK(std::fabs(spline(&image->view(), 0.3, last_y + far, spline_order(0, 1))) < 1e-14);
        }
    }
}

TEST_CASE("picture: across the border of a clamped one its slope is the limit of differences")
{
    constexpr double h = 0x1p-14;
    for (const Drawing& drawing : drawings) {
        const auto image = drawing.image();
        for (int i = 0; i <= 4 * (drawing.width + 5); ++i) {
            const double x = -3 + i / 4.0, y = 0.3;
            const auto height = [&](double at) { return spline(&image->view(), at, y, 0); };
            const double slope = spline(&image->view(), x, y, spline_order(1, 0));
            CAPTURE(drawing.name, x);
            // the third derivative is at most 72
            CHECK(std::fabs((height(x + h) - height(x - h)) / (2 * h) - slope) < 72 * h * h);
            CHECK(std::fabs((height(x + h) - height(x)) / h - (height(x) - height(x - h)) / h) < 24 * h);
        }
    }
}
