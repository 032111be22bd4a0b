// Every file of cases/: what the compiler says, and the values by the interpreter and by the 113-bit oracle.
#include "lang/analyse.h"
#include "lang/ir/run/interpret.h"
#include "lang/math/quad.h"
#include "stdlib/stdlib.h"
#include "tests/conformance/case.h"
#include "tests/conformance/folder.h"
#include "tests/support/catch.h"
#include "tests/support/interpret.h"
#include "tests/support/project_path.h"

#include <cstring>
#include <set>

using namespace haptel;
using namespace haptel::lang::test;
namespace lang = haptel::lang;

namespace {

lang::CompileResult compiled(const Case& wanted)
{
    lang::CompileOptions options;
    for (const stdlib::LibraryFile& file : stdlib::library())
        options.library.push_back({std::string(file.name), std::string(file.text)});
    options.load_import = wanted.loader();
    options.strict = wanted.strict;
    lang::CompileResult result = lang::compile(wanted.main, options);
    if (!result.program || !wanted.with_bounds) return result;
    for (const ir::Texture& texture : result.program->module.textures) {
        std::vector<double> values;
        for (const ir::Parameter& parameter : texture.parameters) values.push_back(parameter.value);
        lang::analyse(*result.program, texture, values, {}, {}, result.diagnostics);
    }
    return result;
}

template <typename T>
ir::Slot<T> slot(ir::Type type, double value)
{
    switch (type) {
    case ir::Type::real: return {T(value)};
    case ir::Type::boolean: return {T(0), value != 0};
    case ir::Type::i32: return {T(0), static_cast<uint32_t>(static_cast<int32_t>(value))};
    case ir::Type::u32: return {T(0), static_cast<uint32_t>(value)};
    case ir::Type::image: return {};
    }
    return {T(value)};
}

// As a case sets it: a choice by its name.
double number_of(const ir::Parameter& parameter, const std::string& text)
{
    const auto choice = std::ranges::find(parameter.choices, text);
    return choice == parameter.choices.end() ? std::stod(text)
                                             : static_cast<double>(choice - parameter.choices.begin());
}

template <typename T>
Outcome evaluated(const ir::Module& module, const Evaluation& at)
{
    const ir::Texture& texture = module.textures.back();
    ir::EntryInputs<T> inputs;
    double
        values[ir::input_count]; // as ir::Input counts them: the doubles of the point, then those of the block's head
    static_assert(sizeof values == sizeof at.point + sizeof at.head);
    std::memcpy(values, &at.point, sizeof at.point);
    std::memcpy(values + sizeof at.point / sizeof(double), &at.head, sizeof at.head);
    for (size_t i = 0; i < ir::input_count; ++i) inputs.input[i] = T(values[i]);
    for (const ir::Parameter& parameter : texture.parameters) {
        double value = parameter.value;
        for (const auto& [name, text] : at.parameters)
            if (name == parameter.name) value = number_of(parameter, text);
        inputs.parameters.push_back(slot<T>(parameter.type, value));
    }
    const auto real = [](const ir::Scalar<T>& result) { return static_cast<double>(std::get<T>(result)); };
    const auto results = ir::interpret<T>(module, texture.height_gradient, {}, &inputs);
    Outcome outcome;
    outcome.height = real(results[0]);
    for (size_t i = 0; i < 3; ++i) outcome.gradient[i] = real(results[1 + i]);
    outcome.faults = std::get<uint32_t>(results[4]);
    for_each_output(texture.writes, [&](const OutputInfo& output, size_t first) {
        for (size_t i = 0; i < output.components; ++i)
            components_of(outcome.sample, output)[i] = real(results[5 + first + i]);
    });
    return outcome;
}

std::string differences(const std::string& text)
{
    const Case wanted = read_case(text);
    const lang::CompileResult result = compiled(wanted);
    std::string all = finding_differences(wanted, result);
    if (wanted.evaluations.empty()) return all;
    if (!result.program || result.program->module.textures.empty())
        return all + "values are expected of what has none\n";
    const ir::Module& module = result.program->module;
    for (const Evaluation& at : wanted.evaluations) {
        for (const auto& [name, value] : at.parameters)
            if (std::ranges::none_of(module.textures.back().parameters, [&](auto& p) { return p.name == name; }))
                all += "malformed: no parameter '" + name + "'\n";
        all += value_differences(at, "interpreter", evaluated<double>(module, at));
        if (at.with_oracle != 0) all += value_differences(at, "oracle", evaluated<ir::Quad>(module, at));
    }
    return all;
}

} // namespace

TEST_CASE("conformance: every file says and does what stands in it")
{
    const std::vector<CaseFile> files = case_files();
    CHECK(files.size() >= 250);
    for (const CaseFile& file : files) {
        INFO(file.name);
        CHECK(differences(file.text) == "");
        const Case wanted = read_case(file.text);
        CHECK((!wanted.findings.empty() || !wanted.evaluations.empty())); // it expects something
    }
}

TEST_CASE("conformance: every finding that a text can show has a file")
{
    std::set<std::string> shown;
    for (const CaseFile& file : case_files())
        for (const ExpectedFinding& finding : read_case(file.text).findings)
            shown.insert(
                finding.text.substr(finding.text.rfind('[') + 1, finding.text.size() - finding.text.rfind('[') - 2));
    // Findings about files and machines, not about texts.
    const std::set<std::string_view> elsewhere = {
        "bad-value", "coarse-picture", "dimension-limit",   "internal-error",  "no-code",        "not-close-enough",
        "seam",      "too-large",      "unknown-parameter", "unreadable-file", "unwritable-file"};
    for (const lang::DiagnosticInfo& info : lang::all_diagnostics) {
        CAPTURE(info.code);
        CHECK(shown.contains(std::string(info.code)) != elsewhere.contains(info.code));
    }
}

TEST_CASE("conformance: the runner tells what is wrong in each file that must fail")
{
    const std::vector<CaseFile> files = case_files(haptel::test::project_path("tests/conformance/must_fail"));
    CHECK(files.size() == 12);
    for (const CaseFile& file : files) {
        // The report that the runner must make stands at the end of the file, behind a line "//--- report".
        const size_t at = file.text.find("//--- report\n");
        REQUIRE(at != std::string::npos);
        INFO(file.name);
        CHECK(differences(file.text.substr(0, at)) == file.text.substr(at + 13));
    }
}
