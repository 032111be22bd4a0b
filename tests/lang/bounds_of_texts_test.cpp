// Bounds of texts whose extremes have a closed form: never less than is reached, and not needlessly more.
#include "lang/analyse.h"
#include "tests/support/catch.h"

#include <string>

using namespace haptel::lang;
namespace ir = haptel::ir;

namespace {

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

} // namespace

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
