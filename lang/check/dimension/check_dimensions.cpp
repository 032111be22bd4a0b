#include "lang/check/dimension/check_dimensions.h"

#include "lang/check/dimension/dimension_checker.h"
#include "lang/check/library.h"

#include <algorithm>
#include <set>
#include <tuple>
#include <utility>

namespace haptel::lang {
namespace {

constexpr size_t work_max = 1'000'000; // expressions looked at; well below a second

// Findings of an instance and of what it calls, each instance and each place once.
class Reporter {
public:
    explicit Reporter(Diagnostics& sink) : diagnostics(sink) {}

    void report(DimensionInstance& root)
    {
        std::vector<DimensionInstance*> pending{&root};
        while (!pending.empty()) {
            DimensionInstance& instance = *pending.back();
            pending.pop_back();
            if (std::exchange(instance.is_reported, true)) continue;
            for (const DimensionFinding& finding : instance.findings) report(instance, finding);
            pending.insert(pending.end(), instance.callees.rbegin(), instance.callees.rend());
        }
    }

private:
    void report(const DimensionInstance& instance, const DimensionFinding& finding)
    {
        const Span at = finding.span;
        if (!places.insert({at.file, at.begin, at.end}).second) return; // found before, with other dimensions
        Diagnostic& said = diagnostics.warning(at, "dimension", finding.message);
        said.related = finding.related;
        // What mends a body for one call would break it for the others.
        const bool has_other_calls = instance.choices && *instance.choices > 1;
        said.hint = has_other_calls && finding.hint.changes_body
                        ? "'" + instance.name + "' is called with other dimensions too: mend the call"
                        : finding.hint.text;
        if (!instance.called_with.empty())
            said.related.push_back(
                {instance.called_at, "'" + instance.name + "' is called here with " + instance.called_with});
    }

    Diagnostics& diagnostics;
    std::set<std::tuple<uint32_t, uint32_t, uint32_t>> places;
};

} // namespace

bool DimensionChecker::spend(size_t steps)
{
    work += steps;
    is_exhausted = is_exhausted || work > work_max;
    return !is_exhausted;
}

// The library's first, those of the main file last, as check() has read them.
std::vector<DimensionInstance> DimensionChecker::constants()
{
    std::vector<DimensionInstance> roots;
    const auto add = [&](const CheckedProgram& from, bool is_library) {
        for (auto file = from.files.rbegin(); file != from.files.rend(); ++file)
            for (const ast::Constant& constant : file->tree.constants)
                DimensionBody(*this, roots.emplace_back(), is_library).declaration(constant.declaration);
    };
    if (program.library) add(program.library->program, true);
    add(program, false);
    return roots;
}

DimensionInstance DimensionChecker::texture(const CheckedTexture& texture)
{
    DimensionInstance root;
    root.name = texture.tree->name.text;
    DimensionBody(*this, root, false).texture(texture);
    return root;
}

DimensionInstance& DimensionChecker::function(const FunctionInfo& info, const FunctionReferences& passed,
                                              const Dimensions& arguments)
{
    const auto [place, is_new] = instances.try_emplace({&info, passed, arguments});
    DimensionInstance& made = place->second;
    if (!is_new) return made;
    made.choices = &choices[&info];
    ++choices[&info];
    made.name = info.name;
    made.called_at = user_call;
    Dimensions shown; // of real numbers; the others count
    auto argument = arguments.begin();
    for (const ParameterInfo& parameter : info.parameters) {
        if (parameter.is_function) continue;
        if (parameter.type.scalar == Scalar::float_ && !argument->is_any()) shown.push_back(*argument);
        ++argument;
    }
    if (user_call.end > 0) made.called_with = description(shown);
    DimensionBody(*this, made, info.is_library).function(info, passed, arguments);
    return made;
}

void check_dimensions(const SourceSet& sources, const CheckedProgram& program, Diagnostics& diagnostics)
{
    DimensionChecker checker(sources, program);
    Reporter reporter(diagnostics);
    for (DimensionInstance& constant : checker.constants()) reporter.report(constant);
    for (const CheckedTexture& texture : program.textures) {
        DimensionInstance root = checker.texture(texture);
        reporter.report(root);
    }
    // What no texture calls may be called with anything.
    for (const FunctionInfo& function : program.functions) {
        if (function.is_library || checker.has_seen(function)) continue;
        const auto functions =
            static_cast<size_t>(std::ranges::count(function.parameters, true, &ParameterInfo::is_function));
        const Dimensions anything(function.parameters.size() - functions, Dimension::any());
        reporter.report(checker.function(function, FunctionReferences(functions), anything));
    }
    if (checker.is_exhausted)
        diagnostics.note({}, "dimension-limit", "this program is too large for all its dimensions to be checked");
}

} // namespace haptel::lang
