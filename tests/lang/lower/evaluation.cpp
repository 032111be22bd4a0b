#include "tests/lang/lower/evaluation.h"

#include "lang/compile.h"
#include "lang/ir/run/interpret.h"
#include "tests/support/catch.h"
#include "tests/support/interpret.h"

#include <cmath>

namespace haptel::lang::test {
namespace {

ir::Slot<double> slot(ir::Type type, double value)
{
    switch (type) {
    case ir::Type::real: return {value};
    case ir::Type::boolean: return {0, value != 0};
    case ir::Type::image: return {};
    case ir::Type::i32: return {0, static_cast<uint32_t>(static_cast<int32_t>(value))};
    case ir::Type::u32: return {0, static_cast<uint32_t>(value)};
    }
    return {value};
}

} // namespace

Sample evaluate(const std::string& source, const Inputs& inputs)
{
    const CompileResult result = compile({"test.haptel", source}, {});
    INFO(render(result.diagnostics.all(), result.sources));
    REQUIRE(result.program);
    const ir::Module& module = result.program->module;
    const ir::Texture& texture = module.textures.back();

    ir::EntryInputs<double> entry;
    const auto set = [&](ir::Input first, auto values) {
        for (size_t i = 0; i < values.size(); ++i) entry.input[static_cast<size_t>(first) + i] = values[i];
    };
    set(ir::Input::p_x, inputs.p);
    set(ir::Input::n_x, inputs.n);
    set(ir::Input::uv_x, inputs.uv);
    set(ir::Input::time, std::array{inputs.time_s});
    set(ir::Input::center_x, inputs.center);
    set(ir::Input::extent_x, inputs.extent);
    set(ir::Input::footprint, std::array{inputs.footprint_m});
    for (size_t i = 0; i < texture.parameters.size(); ++i) {
        const ir::Parameter& parameter = texture.parameters[i];
        const double value = i < inputs.parameters.size() ? inputs.parameters[i] : parameter.value;
        entry.parameters.push_back(slot(parameter.type, value));
    }
    const auto results = ir::interpret<double>(module, texture.height_gradient, {}, &entry);
    Sample sample;
    sample.height = std::get<double>(results[0]);
    for (size_t i = 0; i < 3; ++i) sample.gradient[i] = std::get<double>(results[1 + i]);
    sample.faults = std::get<uint32_t>(results[4]);
    for (size_t i = 5; i + 1 < results.size(); ++i) sample.outputs.push_back(std::get<double>(results[i]));
    return sample;
}

double value_of(const std::string& expression, const std::string& declarations, const Inputs& inputs)
{
    return evaluate(declarations + "\ntexture t() { return " + expression + "; }\n", inputs).height;
}

void check_values(const std::vector<ExpressionValue>& cases, const std::string& declarations, const Inputs& inputs)
{
    for (const ExpressionValue& c : cases) {
        INFO(c.expression);
        CHECK(value_of(c.expression, declarations, inputs) == c.value);
    }
}

void check_values_near(const std::vector<ExpressionValue>& cases, const std::string& declarations, const Inputs& inputs)
{
    for (const ExpressionValue& c : cases) {
        INFO(c.expression);
        CHECK(std::fabs(value_of(c.expression, declarations, inputs) - c.value) <= 4e-16 * std::fabs(c.value));
    }
}

} // namespace haptel::lang::test
