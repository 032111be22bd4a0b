// Elementary functions in code have the bits of the compiled ones, one point at a time and in lanes, in every
// precision.
#include "bench/elementary_truth.h"
#include "lang/ir/op_info.h"
#include "lang/ir/semantics.h"
#include "tests/jit/codegen/engines.h"
#include "tests/support/ir_parse.h"

using namespace haptel;

namespace {

std::string textures_of_all()
{
    std::string functions, textures;
    for (const ir::Op op : ir::elementary_ops()) {
        const ir::OpInfo& info = ir::op_info(op);
        const std::string name(info.name), operands = info.arity == 2 ? "%a, %b" : "%a";
        functions += "function \"" + name +
                     "\" () {\n  %a = input p_x\n  %b = input p_y\n  %f = u32 0\n  %r = " + name + " " + operands +
                     "\n  return %r, %f\n}\n";
        textures += "texture \"" + name + "\" { block 56 reads 1 writes 0 height \"" + name + "\" }\n";
    }
    return functions + textures;
}

// What code is to give, of operands that are f64 as inputs are.
double expected(ir::Op op, double a, double b, jit::Precision precision)
{
    const auto a32 = static_cast<float>(a), b32 = static_cast<float>(b);
    switch (precision) {
    case jit::Precision::f64: return ir::elementary_f64(op, a, b);
    case jit::Precision::mixed:
        if (ir::takes_angle(op)) return static_cast<double>(ir::elementary_f32_of_angle(op, a));
        [[fallthrough]];
    case jit::Precision::f32: return static_cast<double>(ir::elementary_f32(op, a32, b32));
    }
    return 0;
}

} // namespace

TEST_CASE("elementary functions in code have the interpreter's bits, alone and in lanes, in every precision", "[code]")
{
    const ir::ParsedModule parsed = ir::parse(textures_of_all());
    INFO(parsed.error);
    REQUIRE(parsed.module);
    const jit::Precision precision = GENERATE(jit::Precision::f64, jit::Precision::mixed, jit::Precision::f32);
    const jit::Effort effort = GENERATE(jit::Effort::quick, jit::Effort::full);
    std::vector<jit::EntryPoint> entries;
    for (const ir::Texture& texture : parsed.module->textures)
        for (const jit::LaneForm lanes : {jit::LaneForm::one, jit::LaneForm::points})
            entries.push_back({texture.name + (lanes == jit::LaneForm::points ? "*" : ""), &texture,
                               jit::EntryPoint::Kind::height, lanes, precision});
    const jit::CodeResult compiled = jit::compile_code(*parsed.module, entries, {effort});
    INFO(compiled.error);
    REQUIRE(compiled.code);
    for (const ir::Op op : ir::elementary_ops()) {
        const std::string name(ir::op_info(op).name);
        std::vector<double> a, b;
        for (const auto& [first, second] : ir::elementary_arguments(op, 100)) {
            a.push_back(first);
            b.push_back(second);
        }
        for (const double edge : {0.0, -0.0, 1.0, -1.0, HUGE_VAL, -HUGE_VAL, std::nan("")})
            for (const double other : {0.0, -0.0, 1.0, -1.0, HUGE_VAL, -HUGE_VAL, std::nan(""), 3.0, -0.5}) {
                a.insert(a.end(), {edge, other});
                b.insert(b.end(), {other, edge});
            }
        std::vector<double> heights(a.size());
        haptel_points points{};
        points.p[0] = a.data();
        points.p[1] = b.data();
        haptel_samples samples{};
        samples.height_m = heights.data();
        const test::Arguments block;
        compiled.code->batch_entry(name + "*")(&points, a.size(), block.block.data(), &samples);
        size_t different = 0;
        for (size_t i = 0; i < a.size(); ++i) {
            test::Arguments arguments;
            arguments.set(ir::Input::p_x, a[i]);
            arguments.set(ir::Input::p_y, b[i]);
            haptel_sample sample{};
            compiled.code->entry(name)(&arguments.point, arguments.block.data(), &sample);
            const double wanted = expected(op, a[i], b[i], precision);
            if (test::same(sample.height_m, wanted) && test::same(heights[i], wanted)) continue;
            if (different++ == 0)
                UNSCOPED_INFO(name << " of " << a[i] << ", " << b[i] << ": " << wanted << ", alone " << sample.height_m
                                   << ", in a batch " << heights[i]);
        }
        CHECK(different == 0);
    }
}

TEST_CASE("an elementary function is compiled once for all programs that call it in one form")
{
    const auto compile = [](const char* body) {
        const ir::ParsedModule parsed =
            ir::parse("function \"f\" () {\n  %a = input p_x\n  %f = u32 0\n" + std::string(body) +
                      "  return %r, %f\n}\n"
                      "texture \"t\" { block 56 reads 1 writes 0 height \"f\" }\n");
        INFO(parsed.error);
        REQUIRE(parsed.module);
        const std::vector<jit::EntryPoint> entries{
            {"t", &parsed.module->textures[0], jit::EntryPoint::Kind::height, jit::LaneForm::one, jit::Precision::f64}};
        const jit::CodeResult result = jit::compile_code(*parsed.module, entries);
        INFO(result.error);
        REQUIRE(result.code);
        return result.code;
    };
    const auto first = compile("  %s = tanh %a\n  %r = add %s, %a\n");
    const size_t known = jit::kernels_alive();
    const auto second = compile("  %s = tanh %a\n  %t = tanh %s\n  %r = mul %t, %a\n");
    CHECK(jit::kernels_alive() == known);
    const auto third = compile("  %s = tanh %a\n  %t = atanh %s\n  %r = mul %t, %a\n"); // one more
    CHECK(jit::kernels_alive() <= known + 1);
    test::Arguments arguments;
    arguments.set(ir::Input::p_x, 0.7);
    haptel_sample sample{};
    second->entry("t")(&arguments.point, arguments.block.data(), &sample);
    CHECK(sample.height_m == ir::elementary_f64(ir::Op::tanh, ir::elementary_f64(ir::Op::tanh, 0.7)) * 0.7);
    third->entry("t")(&arguments.point, arguments.block.data(), &sample);
    CHECK(sample.height_m == ir::elementary_f64(ir::Op::atanh, ir::elementary_f64(ir::Op::tanh, 0.7)) * 0.7);
}
