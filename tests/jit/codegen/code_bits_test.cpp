// Code gives the interpreter's bits: every operation over special values, and whole random programs.
#include "lang/ir/op_info.h"
#include "lang/ir/print.h"
#include "tests/jit/codegen/engines.h"
#include "tests/jit/codegen/parsed.h"
#include "tests/jit/codegen/random_program.h"

#include <limits>
#include <random>

using namespace haptel;
using test::Engines;
using test::parsed;

namespace {

// An entry that applies one operation to what p_x, p_y, p_z and n_x say and returns the result as a real.
std::string operation_text(const ir::OpInfo& op, char any)
{
    static const char* inputs[] = {"p_x", "p_y", "p_z", "n_x"};
    std::string body = "  %zero = real 0\n", operands;
    for (uint32_t i = 0; i < op.arity; ++i) {
        const std::string x = "%x" + std::to_string(i), y = "%y" + std::to_string(i);
        const char type = op.operands[i] == '*' ? any : op.operands[i];
        body += "  " + x + " = input " + inputs[i] + "\n";
        if (type == 'i') body += "  " + y + " = r_to_i " + x + "\n";
        if (type == 'u') body += "  " + y + " = r_to_u " + x + "\n";
        if (type == 'b') body += "  " + y + " = lt %zero, " + x + "\n";
        operands += (i ? ", " : "") + (type == 'r' ? x : y);
    }
    body += "  %r = " + std::string(op.name) + " " + operands + "\n";
    const char result = op.result == '*' ? any : op.result;
    std::string height = "%r";
    if (result == 'b') body += "  %w = b_to_i %r\n";
    if (result == 'i' || result == 'b') body += "  %h = i_to_r " + std::string(result == 'b' ? "%w" : "%r") + "\n";
    if (result == 'u') body += "  %h = u_to_r %r\n";
    if (result != 'r') height = "%h";
    const std::string name = std::string(op.name) + any;
    return "function \"" + name + "\" () {\n" + body + "  %f = u32 0\n  return " + height + ", %f\n}\n";
}

std::string texture_text(const std::string& name)
{
    return "texture \"" + name + "\" { block 56 reads 1 writes 0 height \"" + name + "\" }\n";
}

const std::vector<double>& special_values()
{
    constexpr double inf = std::numeric_limits<double>::infinity();
    static const std::vector<double> values = {0.0,
                                               -0.0,
                                               1.0,
                                               -1.0,
                                               0.5,
                                               -0.5,
                                               1.5,
                                               2.5,
                                               -2.5,
                                               0.25,
                                               0.75,
                                               3.0,
                                               -7.0,
                                               31.0,
                                               33.0,
                                               0.1,
                                               -1e-3,
                                               1e-300,
                                               -1e-310,
                                               5e-324,
                                               1e155,
                                               -1e300,
                                               inf,
                                               -inf,
                                               std::nan(""),
                                               2147483647.,
                                               -2147483648.,
                                               2147483647.5,
                                               -2147483648.5,
                                               4294967295.0,
                                               4294967296.0,
                                               0x1p52 + 1,
                                               -0x1p51 - 0.5,
                                               0.49999999999999994,
                                               1.7976931348623157e308,
                                               2.2250738585072014e-308,
                                               0.7853981633974483,
                                               1e22};
    return values;
}

} // namespace

TEST_CASE("every operation gives the interpreter's bits, special values included", "[code]")
{
    std::string text, textures;
    size_t of_images = 0;
    for (const ir::OpInfo& op : ir::all_ops()) {
        if (op.operands[0] == 'm' && ++of_images) continue; // image_test.cpp
        for (char any : op.operands.find('*') == std::string_view::npos ? std::string("r") : std::string("riub")) {
            text += operation_text(op, any);
            textures += texture_text(std::string(op.name) + any);
        }
    }
    const ir::Module module = parsed(text + textures);
    REQUIRE(module.textures.size() >= ir::all_ops().size() - of_images);
    Engines engines(module);

    const std::vector<double>& values = special_values();
    std::mt19937_64 random(1);
    for (const ir::Texture& texture : module.textures) {
        int different = 0;
        double input[4] = {}, first[4] = {};
        const auto check = [&] {
            bool agree = false;
            engines.height(texture, input, agree);
            if (!agree && different++ == 0) std::copy(input, input + 4, first);
        };
        for (double a : values)
            for (double b : values) {
                input[0] = a, input[1] = b;
                input[2] = values[random() % values.size()], input[3] = values[random() % values.size()];
                check();
            }
        std::uniform_real_distribution<double> exponent(-40, 40), mantissa(-2, 2);
        for (int i = 0; i < 1000; ++i) {
            for (double& x : input) x = std::ldexp(mantissa(random), static_cast<int>(exponent(random)));
            check();
        }
        INFO(texture.name << " differs for " << different << " inputs, first " << first[0] << ", " << first[1] << ", "
                          << first[2] << ", " << first[3]);
        CHECK(different == 0);
        CHECK(engines.batches_agree(texture));
    }
}

TEST_CASE("random programs with branches, loops, calls and tables give the interpreter's bits", "[code]")
{
    std::mt19937_64 random(2);
    const std::vector<double>& values = special_values();
    for (uint64_t seed = 1; seed <= 40; ++seed) {
        const ir::Module module = test::random_program(seed);
        INFO(ir::print(module));
        REQUIRE(ir::verify(module).empty());
        Engines engines(module);
        for (int i = 0; i < 200; ++i) {
            double input[4];
            for (double& x : input)
                x = random() % 4 == 0 ? values[random() % values.size()]
                                      : std::uniform_real_distribution<double>(-3, 3)(random);
            bool agree = false;
            engines.height(module.textures[0], input, agree);
            if (!agree) {
                INFO("seed " << seed << " differs at " << input[0] << ", " << input[1] << ", " << input[2] << ", "
                             << input[3]);
                REQUIRE(agree);
            }
        }
        INFO("seed " << seed);
        REQUIRE(engines.batches_agree(module.textures[0]));
    }
}
