// Text of any bytes: source, and the text form of the IR.
#include "lang/analyse.h"
#include "lang/format/format.h"
#include "lang/ir/cost.h"
#include "lang/ir/print.h"
#include "lang/ir/run/interpret.h"
#include "lang/ir/verify.h"
#include "lang/syntax/parser.h"
#include "lang/text/lexer.h"
#include "stdlib/stdlib.h"
#include "tests/conformance/folder.h"
#include "tests/fuzz/target.h"
#include "tests/lang/ir/ir_random.h"
#include "tests/support/interpret.h"
#include "tests/support/ir_parse.h"
#include "tests/support/project_path.h"

#include <cmath>

namespace haptel::fuzz {
namespace {

using namespace haptel::lang;

bool is_utf8(const std::string& text)
{
    for (size_t at = 0; at < text.size();) {
        const CodePoint point = decode_utf8(text, at);
        if (point.value == invalid_code_point) return false;
        at += point.length;
    }
    return true;
}

// What must hold for the findings of any text: within it, not too many, and fit to be shown.
void check_findings(const Diagnostics& diagnostics, const SourceSet& sources)
{
    if (diagnostics.all().size() > 2000) fail("more findings than anybody reads");
    for (const Diagnostic& finding : diagnostics.all()) {
        const auto is_within = [&](Span span) {
            return sources.has(span.file) && span.begin <= span.end && span.end <= sources.file(span.file).text.size();
        };
        if (!is_within(finding.span)) fail("a finding outside of the text: " + finding.message);
        if (finding.fix && !is_within(finding.fix->span)) fail("a fix outside of the text: " + finding.message);
        for (const Related& related : finding.related)
            if (!is_within(related.span)) fail("a related place outside of the text: " + related.message);
        if (!find_diagnostic(finding.code)) fail("a finding that is not listed: " + finding.code);
        if (finding.code == "internal-error") fail("internal error: " + finding.message);
    }
    if (!is_utf8(render(diagnostics.all(), sources, true))) fail("findings that are not UTF-8");
}

// Functions of the module at one point each, as far as that is cheap; printed and read again it is the same.
void check_module(const ir::Module& module)
{
    const std::string problem = ir::verify(module);
    if (!problem.empty()) fail("does not verify: " + problem);
    const std::string text = ir::print(module);
    const ir::ParsedModule again = ir::parse(text);
    if (!again.module) fail("what was printed cannot be read: " + again.error);
    if (ir::print(*again.module) != text) fail("printing what was read gives another text");
}

void check_height(const ir::Module& module, const ir::Texture& texture)
{
    if (ir::operations_max(module, texture.height_gradient) > 20'000) return;
    ir::EntryInputs<double> inputs;
    for (size_t i = 0; i < ir::input_count; ++i) inputs.input[i] = 0.001 * static_cast<double>(i + 1);
    for (const ir::Parameter& parameter : texture.parameters) {
        switch (parameter.type) {
        case ir::Type::real: inputs.parameters.push_back({parameter.value}); break;
        case ir::Type::boolean: inputs.parameters.push_back({0, parameter.value != 0}); break;
        default: inputs.parameters.push_back({0, static_cast<uint32_t>(static_cast<int64_t>(parameter.value))});
        }
    }
    const auto both = ir::interpret<double>(module, texture.height_gradient, {}, &inputs);
    const auto alone = ir::interpret<double>(module, texture.height, {}, &inputs);
    for (size_t i = 0; i < 4; ++i)
        if (!std::isfinite(std::get<double>(both[i]))) fail("an entry returned what is not finite");
    if (std::get<double>(both[0]) != std::get<double>(alone[0])) fail("the height alone is another");
    count("evaluated");
}

} // namespace

void parse_text(std::string_view bytes)
{
    SourceSet sources;
    Diagnostics diagnostics;
    sources.add({"fuzz.haptel", std::string(bytes)});
    parse(sources, 0, diagnostics);
    check_findings(diagnostics, sources);
}

void compile_text(std::string_view bytes)
{
    const std::string text(bytes);
    CompileOptions options;
    if (text.size() % 4 == 0) // it costs more than the text itself
        for (const stdlib::LibraryFile& file : stdlib::library())
            options.library.push_back({std::string(file.name), std::string(file.text)});
    options.load_import = [&](std::string_view path, std::string_view) -> std::optional<SourceFile> {
        if (path.size() > 12) return std::nullopt;
        return SourceFile{std::string(path), text};
    };
    CompileResult result = compile({"main.haptel", text}, options);
    check_findings(result.diagnostics, result.sources);
    if ((result.program == nullptr) != result.diagnostics.has_errors())
        fail("a program and errors at once, or neither");
    if (!result.program) return;
    count("compiled");
    check_module(result.program->module);
    for (const ir::Texture& texture : result.program->module.textures) {
        check_height(result.program->module, texture);
        if (ir::operations_max(result.program->module, texture.height_gradient) > 200) continue;
        std::vector<double> values;
        for (const ir::Parameter& parameter : texture.parameters) values.push_back(parameter.value);
        analyse(*result.program, texture, values, {}, {.evaluations = 64}, result.diagnostics);
        count("analysed");
    }
    check_findings(result.diagnostics, result.sources);
}

void format_text(std::string_view bytes)
{
    const auto formatted = [](const std::string& text) {
        SourceSet sources;
        Diagnostics diagnostics;
        const uint32_t file = sources.add({"fuzz.haptel", text});
        const std::optional<std::string> result = format(sources, file, diagnostics);
        if (!result && !diagnostics.has_errors()) fail("not formatted, and not told why");
        return result;
    };
    const std::string text(bytes);
    const std::optional<std::string> once = formatted(text);
    if (!once) return;
    count("formatted");
    const std::optional<std::string> twice = formatted(*once);
    if (!twice) fail("what was formatted is refused:\n" + *once);
    if (*twice != *once) fail("formatting twice changes:\n" + *once + "\n---- into\n" + *twice);
    const auto meaning = [](const std::string& source) {
        const CompileResult result = compile({"fuzz.haptel", source}, {});
        return result.program ? ir::print(result.program->module) : std::string();
    };
    if (meaning(text) != meaning(*once)) fail("formatting changes the meaning:\n" + *once);
}

void read_ir(std::string_view bytes)
{
    const ir::ParsedModule parsed = ir::parse(bytes);
    if (parsed.module.has_value() == !parsed.error.empty()) fail("a module and an error at once, or neither");
    if (!parsed.module || !ir::verify(*parsed.module).empty()) return;
    count("verified");
    check_module(*parsed.module);
    if (parsed.module->functions.empty()) return;
    const auto last = static_cast<uint32_t>(parsed.module->functions.size() - 1);
    const ir::Function& function = parsed.module->functions[last];
    if (ir::operations_max(*parsed.module, last) > 50'000) return;
    const ir::EntryInputs<double> inputs;
    for (const ir::Texture& texture : parsed.module->textures)
        if (!texture.parameters.empty()) return; // an entry may read them
    ir::Interpreter<double>(*parsed.module).run(last, ir_test::random_arguments(function, 1), &inputs);
    count("evaluated");
}

std::vector<std::string> haptel_corpus()
{
    std::vector<std::string> corpus;
    for (const char* folder : {"tests/conformance/cases", "tests/lang/golden", "examples", "stdlib/tests"})
        for (const lang::test::CaseFile& file : lang::test::case_files(haptel::test::project_path(folder)))
            corpus.push_back(file.text);
    for (const stdlib::LibraryFile& file : stdlib::library())
        if (file.text.size() < 20'000) corpus.emplace_back(file.text);
    return corpus;
}

std::vector<std::string> ir_corpus()
{
    std::vector<std::string> corpus;
    for (uint32_t seed = 0; seed < 60; ++seed)
        corpus.push_back(
            ir::print(ir_test::random_module(seed, seed % 2 ? ir_test::Flavour::tame : ir_test::Flavour::wild)));
    for (const lang::test::CaseFile& file : lang::test::case_files()) {
        const CompileResult result = compile({"main.haptel", file.text}, {});
        if (result.program) corpus.push_back(ir::print(result.program->module));
    }
    return corpus;
}

} // namespace haptel::fuzz
