// Bounds of texts whose extremes have a closed form: never less than is reached, and not needlessly more.
#include "lang/analyse.h"
#include "tests/support/catch.h"

#include <string>

using namespace haptel::lang;
namespace ir = haptel::ir;

namespace {

struct Reached {
    double minimum, maximum;
};

// Bounds of `t` for p.x there.
ir::TextureBounds bounds_over(const std::string& text, double from, double to)
{
    const CompileResult result = compile({"t.haptel", text}, {});
    REQUIRE(result.program);
    const ir::Module& module = result.program->module;
    ir::BoundsBox box;
    box.input[static_cast<size_t>(ir::Input::p_x)] = {from, to};
    return ir::texture_bounds(module, module.textures[0], box);
}

void check_holds(const std::string& text, double from, double to, Reached height)
{
    CAPTURE(text, from, to);
    const ir::TextureBounds bounds = bounds_over(text, from, to);
    CAPTURE(bounds.height.minimum, bounds.height.maximum);
    CHECK((bounds.height.minimum <= height.minimum && bounds.height.maximum >= height.maximum));
    CHECK(bounds.contradicted.empty());
}

} // namespace

TEST_CASE("facts: a slope says nothing across a jump")
{
    // 1 within 0.00003 of 0.0312347, which is not the middle of the boxes
    const std::string plateau = "float f(float q) { return abs(q - 0.0312347) < 0.00003 ? 1.0 : 0.0; }\n"
                                "texture t() { return f(p.x / 1m); }";
    for (const std::string facts : {"value 0 .. 1, slope 0.01, class jump", "value 0 .. 1, slope 0.01",
                                    "value 0 .. 1, slope 0, class jump", "slope 0.01, curvature 0.01, class jump"}) {
        check_holds("/// @facts " + facts + "\n" + plateau, 0.031, 0.0313, {0, 1});
        check_holds("/// @facts " + facts + "\n" + plateau, 0.03, 0.032, {0, 1});
    }
    // A saw tooth: at the middle, 1, it is 0, and beside it nearly 1.
    check_holds("/// @facts value 0 .. 1, slope 1, class jump\nfloat f(float x) { return fract(x); }\n"
                "texture t() { return f(p.x / 1m); }",
                0.9, 1.1, {0, 1 - 1e-9});
}

TEST_CASE("facts: a curvature says nothing of a gradient across a kink, nor a slope of one across a jump")
{
    // the gradient is -1.1 .. -1 left of 0 and 1 .. 1.1 right of it
    const std::string bent = "float f(float x) { float y = clamp(x, -1.0, 1.0); return abs(y) + 0.05 * y * y; }\n"
                             "texture t() { return grad(f)(p.x / 1m); }";
    for (const std::string facts :
         {"value 0 .. 2, slope 1.1, curvature 0.1, class C0", "value 0 .. 2, slope 1.1, curvature 0.1"})
        for (const double size : {1e-3, 0.1, 0.9})
            check_holds("/// @facts " + facts + "\n" + bent, -size, 0.8 * size, {-1 - 0.1 * size, 1 + 0.08 * size});
    // left of 0 for the millionth part of the box, which is nowhere the middle of what it is cut into
    check_holds("/// @facts value 0 .. 2, slope 1.1, curvature 0.1, class C0\n" + bent, -1e-6, 1, {-1, 1.1});
    // a roof of half a width of 0.00001: its gradient is 1, -1, and 0 in the middle of the box
    const std::string roof = "float f(float q) { return max(0.00001 - abs(q - 0.0312347), 0.0); }\n"
                             "texture t() { return grad(f)(p.x / 1m); }";
    check_holds("/// @facts value 0 .. 0.00001, slope 1, curvature 0.01, class C0\n" + roof, 0.031, 0.0313, {-1, 1});
}

TEST_CASE("facts: of a continuous function the slope bounds the height, as before")
{
    // natural evaluation of the sum would be 200 wide
    const std::string wave = "float f(float x) { return sin(x + 100.0 * (x * x) - 100.0 * x * x); }\n"
                             "texture t() { return f(p.x / 1m); }";
    const auto width = [&](const std::string& facts) {
        const ir::Interval height = bounds_over("/// @facts " + facts + "\n" + wave, 0.2, 0.4).height;
        return height.maximum - height.minimum;
    };
    CHECK(width("value -1 .. 1, slope 1, class C1") < 0.4);
    CHECK(width("value -1 .. 1, slope 1, class C0") < 0.4);
}

TEST_CASE("facts: a whole number has no value in the middle between two")
{
    check_holds("/// @facts value 0 .. 6, slope 2, class C0\nfloat f(int i) { return float(clamp(i * 2, 0, 6)); }\n"
                "texture t() { return f(p.x > 0.5m ? 1 : 0); }",
                0, 1, {0, 2});
}

TEST_CASE("facts: of a vector function they are each component's")
{
    const ir::TextureBounds bounds =
        bounds_over("/// @facts value -1 .. 1, slope 1, class C1\n"
                    "vec2 f(float x) { return vec2(sin(x), sin(x + 100.0 * (x * x) - 100.0 * x * x)); }\n"
                    "texture t() { return f(p.x / 1m).y; }",
                    0, 100);
    CHECK(bounds.slope_max <= 1 + 1e-9);
    CHECK(bounds.continuity >= ir::Continuity::c1);
}

TEST_CASE("bounds: what shares terms is not wider than it is")
{
    // 2 k is at least 0.02; a smoothstep stays within 0 .. 1 wherever its edges are
    const std::string text = "texture t(float r = 0.3 in 0.2 .. 0.5, float k = 0.1 in 0.01 .. 0.2)\n"
                             "{ return 1m * smoothstep(r - k, r + k, p.x / 1m); }";
    const CompileResult result = compile({"t.haptel", text}, {});
    REQUIRE(result.program);
    const ir::Module& module = result.program->module;
    ir::BoundsBox box;
    box.input[static_cast<size_t>(ir::Input::p_x)] = {-1, 1};
    box.parameters = {{0.2, 0.5}, {0.01, 0.2}};
    const ir::TextureBounds bounds = ir::texture_bounds(module, module.textures[0], box);
    CHECK((bounds.height.minimum == 0 && bounds.height.maximum == 1));
    CHECK((bounds.slope_max >= 1.5 / 0.02 && bounds.slope_max < 1.01 * 1.5 / 0.02)); // 3/2 over the ramp's width
    CHECK(ir::undefined_in(module, module.textures[0], box).empty());
    // with no distance left between the edges it may divide by zero, and is within 0 .. 1 where it is a number
    box.parameters = {{0.2, 0.5}, {0, 0.2}};
    CHECK(ir::undefined_in(module, module.textures[0], box).size() == 1);
    const ir::Interval height = ir::height_bounds(module, module.textures[0], box);
    CHECK((height.minimum == 0 && height.maximum == 1 && height.may_be_nan));
}

TEST_CASE("bounds: a function of what may be no number keeps its facts for numbers, and says what it does else")
{
    const std::string head = "/// @facts value 0 .. 1, slope 2, class C1\n";
    const std::string tail = "texture t() { return 1m * f(p.x / p.x); }"; // 1, and 0 / 0 at 0
    const auto over = [&](const std::string& body) { return bounds_over(head + body + tail, -1, 1).height; };
    const ir::Interval passed = over("float f(float x) { return smoothstep(0.0, 1.0, x); }\n");
    CHECK((passed.minimum == 0 && passed.maximum == 1));
    const ir::Interval swallowed = over("float f(float x) { return isnan(x) ? 7.0 : smoothstep(0.0, 1.0, x); }\n");
    CHECK((swallowed.minimum <= 0 && swallowed.maximum == 7));
}

TEST_CASE("bounds: what is never negative has no height below 0")
{
    for (const std::string height : {"exp(-dot(p, p) / (1um * 1um))", "sqrt(exp(-p.x / 1um))",
                                     "1e-300 * exp(p.x / 1mm)", "abs(p.x / 1e200) * 1e-200", "p.x * p.x / 1m / 1m"}) {
        CAPTURE(height);
        CHECK(bounds_over("texture t() { return 1m * (" + height + "); }", -0.1, 0.1).height.minimum == 0);
    }
}
