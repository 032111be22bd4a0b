// Images: the spline goes through the texels, is twice continuously differentiable, and stays in its bounds.
#include "lang/ir/bounds/interval_evaluator.h"
#include "lang/ir/bounds/spline_image.h"
#include "lang/ir/builder.h"
#include "lang/ir/derive/differentiate.h"
#include "lang/ir/print.h"
#include "lang/ir/run/interpret.h"
#include "lang/ir/verify.h"
#include "lang/math/quad.h"
#include "tests/support/catch.h"
#include "tests/support/ir_parse.h"

#include <cmath>
#include <limits>
#include <random>

using namespace haptel::ir;

namespace {

std::shared_ptr<const SplineImage> image_of(std::vector<double> texels, int64_t width, int64_t height)
{
    std::string error;
    auto made = SplineImage::make({texels, {}, width, height}, {}, error);
    INFO(error);
    REQUIRE(made);
    return made;
}

std::vector<double> random_texels(size_t count, uint32_t seed)
{
    std::mt19937 random(seed);
    std::vector<double> texels(count);
    for (double& texel : texels) texel = std::uniform_real_distribution<double>(-1, 1)(random);
    return texels;
}

// The centred cubic B-spline, from its textbook formula, and its derivatives.
Quad bump(Quad x, int order)
{
    const Quad a = x < 0 ? -x : x, side = x < 0 ? Quad(-1) : Quad(1);
    if (a >= 2) return 0;
    const Quad r = 2 - a;
    if (order == 0) return a < 1 ? Quad(2) / 3 - a * a + a * a * a / 2 : r * r * r / 6;
    if (order == 1) return side * (a < 1 ? -2 * a + Quad(1.5) * a * a : -r * r / 2);
    return a < 1 ? -2 + 3 * a : r;
}

// Sum over all coefficients, edges by index.
Quad closed_form(const haptel_image& image, double x, double y, int by_x, int by_y, uint32_t edge)
{
    const auto inside = [&](int i, int n) {
        if (edge == HAPTEL_EDGE_CLAMPED) return std::min(std::max(i, -1), n) + 1;
        while (i < 0 || i >= n) // from copy to copy
            i = edge == HAPTEL_EDGE_TILED ? i + (i < 0 ? n : -n) : i < 0 ? -1 - i : 2 * n - 1 - i;
        return i;
    };
    const int column = static_cast<int>(std::floor(x)), row = static_cast<int>(std::floor(y));
    Quad sum = 0;
    for (int j = row - 2; j <= row + 3; ++j)
        for (int i = column - 2; i <= column + 3; ++i) {
            const int stride = image.width + (edge == HAPTEL_EDGE_CLAMPED ? 2 : 0);
            const int at = inside(j, image.height) * stride + inside(i, image.width);
            sum += Quad(image.coefficients[edge][at]) * bump(Quad(x) - i, by_x) * bump(Quad(y) - j, by_y);
        }
    return sum;
}

// f(image, x, y) of these orders.
Module spline_module(uint32_t orders)
{
    Module module;
    Builder builder(module, "f");
    const Value image = builder.parameter(Type::image), x = builder.parameter(Type::real),
                y = builder.parameter(Type::real);
    const Value result = builder.operation(Op::spline, {image, x, y, builder.i32(static_cast<int32_t>(orders))});
    builder.finish({&result, 1});
    return module;
}

} // namespace

TEST_CASE("spline: goes through the texels, whatever the size and the edges")
{
    for (auto [width, height] : {std::pair{1, 1}, {2, 1}, {1, 3}, {2, 2}, {3, 5}, {17, 9}, {64, 64}}) {
        const auto texels = random_texels(static_cast<size_t>(width * height), 5);
        const auto image = image_of(texels, width, height);
        for (uint32_t edge = 0; edge < spline_edges; ++edge)
            for (int y = 0; y < height; ++y)
                for (int x = 0; x < width; ++x) {
                    CAPTURE(width, height, edge, x, y);
                    const double found = spline(&image->view(), double(x), double(y), spline_order(0, 0, edge));
                    CHECK(std::fabs(found - texels[static_cast<size_t>(y * width + x)]) < 1e-13);
                }
    }
}

TEST_CASE("spline: values and derivatives are those of the closed form at 113 bits")
{
    const auto image = image_of(random_texels(7 * 5, 6), 7, 5);
    std::mt19937 random(1);
    for (uint32_t edge = 0; edge < spline_edges; ++edge)
        for (auto [by_x, by_y] : {std::pair{0, 0}, {1, 0}, {0, 1}, {2, 0}, {1, 1}, {0, 2}, {2, 2}}) {
            const uint32_t orders = spline_order(static_cast<uint32_t>(by_x), static_cast<uint32_t>(by_y), edge);
            const Module module = spline_module(orders);
            REQUIRE(verify(module).empty());
            Interpreter<Quad> oracle(module);
            for (int i = 0; i < 300; ++i) {
                const double x = std::uniform_real_distribution<double>(-6, 13)(random);
                const double y = std::uniform_real_distribution<double>(-6, 13)(random);
                const Quad expected = closed_form(image->view(), x, y, by_x, by_y, edge);
                CAPTURE(x, y, by_x, by_y, edge);
                CHECK(std::fabs(double(spline(&image->view(), x, y, orders) - expected)) < 1e-13);
                const Slot<Quad> arguments[] = {{0, 0, &image->view()}, {x, 0}, {y, 0}};
                CHECK(std::fabs(double(oracle.run(0, arguments, nullptr)[0].real - expected)) < 1e-30);
            }
        }
}

TEST_CASE("spline: the derivative is the operation's own, the fourth is 0, and images have none")
{
    const auto image = image_of(random_texels(6 * 6, 7), 6, 6);
    for (uint32_t order = 0; order < 4; ++order) {
        Module module = spline_module(spline_order(order, 0));
        Differentiator differentiator(module);
        const Derivative made = differentiator.derivative(0, {{Seed::none}, {Seed::unit}, {Seed::none}});
        CHECK(made.exists[0][0] == (order < 3));
        CHECK(verify(module).empty());
        if (order == 3) continue;
        const Slot<double> arguments[] = {{0, 0, &image->view()}, {2.3, 0}, {1.9, 0}};
        Interpreter<double> interpreter(module);
        const auto results = interpreter.run(made.function, arguments, nullptr);
        CHECK(results[1].real == spline(&image->view(), 2.3, 1.9, spline_order(order + 1, 0)));
    }
}

TEST_CASE("spline: C2 and no smoother, also where a clamped image ends")
{
    const auto image = image_of(random_texels(5 * 4, 8), 5, 4);
    for (uint32_t edge = 0; edge < spline_edges; ++edge)
        for (int knot = -4; knot <= 7; ++knot)
            for (uint32_t order = 0; order < 3; ++order) {
                const uint32_t orders = spline_order(order, 0, edge);
                const double left = spline(&image->view(), std::nextafter(double(knot), -infinity), 1.3, orders);
                CHECK(std::fabs(left - spline(&image->view(), double(knot), 1.3, orders)) < 1e-12);
            }
    const uint32_t third = spline_order(3, 0);
    CHECK(std::fabs(spline(&image->view(), 1.999, 1.3, third) - spline(&image->view(), 2.001, 1.3, third)) > 1e-3);
    for (double far : {-3.0, -1e9, -infinity, 1e300, infinity}) { // flat outside
        CHECK(spline(&image->view(), far, 1.0, spline_order(1, 0)) == 0);
        CHECK(std::fabs(spline(&image->view(), far, 1.0, 0)) < 3);
    }
}

TEST_CASE("spline: total for places that are none, and for no image")
{
    const auto image = image_of({1, 2, 3, 4}, 2, 2);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    CHECK(std::isnan(spline(&image->view(), nan, 0.0, 0)));
    CHECK(std::isnan(spline(&image->view(), 0.0, nan, 0)));
    CHECK(std::isnan(spline(&image->view(), infinity, 0.0, spline_order(0, 0, true))));
    CHECK(std::isfinite(spline(&image->view(), 1e300, -1e300, spline_order(0, 0, true))));
    CHECK(spline<double>(nullptr, 3.0, 4.0, 0) == 0);
    CHECK(image_width(nullptr) == 1);
    CHECK(spline(&image->view(), 0.5, 0.5, 0xffffffff) == 0);
}

TEST_CASE("spline: damaged images are refused with the reason")
{
    std::string error;
    const double bad[] = {0, 1, std::numeric_limits<double>::quiet_NaN(), 3};
    CHECK(!SplineImage::make({bad, {}, 2, 2}, {}, error));
    CHECK(error.find("texel (0, 1)") != std::string::npos);
    CHECK(!SplineImage::make({bad, {}, 0, 2}, {}, error));
    CHECK(!SplineImage::make({bad, {}, 3, 2}, {}, error));
    CHECK(!SplineImage::make({bad, {}, int64_t{1} << 40, int64_t{1} << 40}, {}, error));
    CHECK(error.find("too large") != std::string::npos);
}

TEST_CASE("spline: nothing found by sampling is outside of the bounds")
{
    const auto image = image_of(random_texels(40 * 30, 9), 40, 30);
    std::mt19937 random(2);
    for (int round = 0; round < 400; ++round) {
        const auto edge = uint32_t(round) % spline_edges;
        const double wide = round % 4 == 0 ? 60 : 3;
        const double x = std::uniform_real_distribution<double>(-20, 50)(random);
        const double y = std::uniform_real_distribution<double>(-20, 50)(random);
        const uint32_t orders = spline_order(random() % 4, random() % 4, edge);
        const Interval bounds = image->bounds({x, x + wide}, {y, y + wide}, orders);
        double low = infinity, high = -infinity;
        for (int sample = 0; sample < 300; ++sample) {
            std::uniform_real_distribution<double> share(0, wide);
            const double found = spline(&image->view(), x + share(random), y + share(random), orders);
            low = std::min(low, found);
            high = std::max(high, found);
        }
        CAPTURE(x, y, wide, orders, low, high, bounds.minimum, bounds.maximum);
        CHECK(bounds.minimum <= low);
        CHECK(bounds.maximum >= high);
    }
    const Interval anywhere = image->bounds({-infinity, infinity}, {-infinity, infinity}, 0);
    CHECK(anywhere.is_finite());
    for (const uint32_t edge : {HAPTEL_EDGE_TILED, HAPTEL_EDGE_MIRRORED})
        CHECK(image->bounds({-infinity, infinity}, {0, 1}, spline_order(0, 0, edge)).may_be_nan);
}

// A place left of the picture is brought back into it by adding the picture's length, which rounds: at 2^15 texels by
// some 1e-12 of a texel, and beside a texel into the next cell, where the third derivative is another.
TEST_CASE("spline: bounds of a place hold its value as code finds it, and the exact one")
{
    const int32_t length = SplineImage::side_max;
    std::vector<double> texels(static_cast<size_t>(length));
    for (size_t i = 0; i < texels.size(); ++i) texels[i] = static_cast<double>(i % 2);
    const auto flat = image_of(texels, length, 1), upright = image_of(texels, 1, length);
    std::mt19937 random(4);
    int rounded_up = 0, rounded_down = 0;
    for (int round = 0; round < 2000; ++round) {
        const double at = -std::uniform_real_distribution<double>(0, 3)(random);
        const uint32_t edge = round % 2 ? HAPTEL_EDGE_TILED : HAPTEL_EDGE_MIRRORED;
        const bool along = round % 4 < 2;
        const SplineImage& image = along ? *flat : *upright;
        const double x = along ? at : 0.5, y = along ? 0.5 : at;
        const double code = spline(&image.view(), x, y, spline_order(0, 0, edge));
        const Quad exact = closed_form(image.view(), x, y, 0, 0, edge);
        const Interval bounds = image.bounds({x, x}, {y, y}, spline_order(0, 0, edge));
        CAPTURE(at, edge, along, code, bounds.minimum, bounds.maximum);
        CHECK(bounds.contains(code));
        CHECK((Quad(bounds.minimum) <= exact && exact <= Quad(bounds.maximum)));
        CHECK(bounds.maximum - bounds.minimum < 1e-9);
        rounded_up += Quad(code) > exact + 2e-12, rounded_down += Quad(code) < exact - 2e-12;
    }
    CHECK((rounded_up > 100 && rounded_down > 100)); // or nothing was tried

    const auto small = image_of(random_texels(7 * 7, 5), 7, 7);
    for (const uint32_t edge : {HAPTEL_EDGE_TILED, HAPTEL_EDGE_MIRRORED})
        for (const double just_before : {-1e-20, std::nextafter(-1.0, -2.0), std::nextafter(-2.0, -3.0)})
            for (const bool along : {true, false}) {
                const double x = along ? just_before : 0.5, y = along ? 0.5 : just_before;
                const uint32_t orders = spline_order(along ? 3 : 0, along ? 0 : 3, edge);
                CHECK(small->bounds({x, x}, {y, y}, orders).contains(spline(&small->view(), x, y, orders)));
            }
}

TEST_CASE("images: text form, verifier and bounds of a texture that samples one")
{
    const std::string text = R"ir(
function "read(image,vec2)" (%0: image, %1: real, %2: real) {
  %3 = i32 0
  %4 = spline %0, %1, %2, %3
  return %4
}
function "pic" () {
  %0 = parameter 0 image
  %1 = input p_x
  %2 = input p_y
  %3 = call "read(image,vec2)"(%0, %1, %2)
  return %3
}
texture "pic" { parameter "picture" image 0 in 0 .. 0 unit "" offset 56 block 64 reads 1 writes 0 body "pic" }
)ir";
    ParsedModule parsed = parse(text);
    INFO(parsed.error);
    REQUIRE(parsed.module);
    CHECK(verify(*parsed.module).empty());
    CHECK(parse(print(*parsed.module)).module);
    CHECK(print(*parse(print(*parsed.module)).module) == print(*parsed.module));
    CHECK(!parse("function \"f\" (%0: real) {\n  %1 = image_width %0\n  return %1\n}\n").module);

    // A ramp of one per texel, far from its edges.
    std::vector<double> texels;
    for (int i = 0; i < 32 * 32; ++i) texels.push_back(i % 32);
    const auto image = image_of(texels, 32, 32);
    BoundsBox box;
    for (Interval& input : box.input) input = {0, 0};
    box.input[0] = box.input[1] = {10, 20};
    box.parameters = {{0, 0}};
    box.images = {image.get()};
    const TextureBounds bounds = texture_bounds(*parsed.module, parsed.module->textures[0], box);
    CHECK(bounds.height.minimum <= 10);
    CHECK(bounds.height.minimum > 9.999);
    CHECK(bounds.height.maximum >= 20);
    CHECK(bounds.height.maximum < 20.001);
    CHECK(std::fabs(bounds.slope_max - 1) < 1e-3);
    CHECK(bounds.curvature_max_per_m < 1e-2);
    CHECK(bounds.continuity == Continuity::c2);
    box.images.clear();
    CHECK(texture_bounds(*parsed.module, parsed.module->textures[0], box).height.maximum == infinity);
}
