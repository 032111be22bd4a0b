#include "lang/check/dimension/check_dimensions.h"

#include "lang/check/dimension/dimension_checker.h"
#include "lang/check/library.h"

#include <algorithm>
#include <deque>
#include <utility>

namespace haptel::lang {

DimensionInstance& DimensionChecker::function(const FunctionInfo& info, const PassedFunctions& passed,
                                              const Dimensions& arguments)
{
    const auto [place, is_new] = instances.try_emplace({&info, passed, arguments});
    DimensionInstance& made = place->second;
    if (!is_new) return made;
    if (info.is_texture && !info.is_mentioned) return made; // called by what is never called: its body was not read
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

namespace {

// Of an instance and of what it calls; each instance once.
void report(DimensionInstance& root, Diagnostics& diagnostics)
{
    std::vector<DimensionInstance*> pending{&root};
    while (!pending.empty()) {
        DimensionInstance& instance = *pending.back();
        pending.pop_back();
        if (std::exchange(instance.is_reported, true)) continue;
        pending.insert(pending.end(), instance.callees.rbegin(), instance.callees.rend());
        for (const DimensionFinding& finding : instance.findings) {
            Diagnostic& said = diagnostics.warning(finding.span, "dimension", finding.message);
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
    }
}

} // namespace

void check_dimensions(const SourceSet& sources, const CheckedProgram& program, Diagnostics& diagnostics)
{
    DimensionChecker checker(sources);
    std::deque<DimensionInstance> roots;
    // The library's first, those of the main file last, as check() has read them.
    const auto add_constants = [&](const CheckedProgram& from, bool is_library) {
        for (auto file = from.files.rbegin(); file != from.files.rend(); ++file)
            for (const ast::Constant& constant : file->tree.constants)
                DimensionBody(checker, roots.emplace_back(), is_library).declaration(constant.declaration);
    };
    if (program.library) add_constants(program.library->program, true);
    add_constants(program, false);
    for (const CheckedTexture& texture : program.textures)
        DimensionBody(checker, roots.emplace_back(), false).texture(texture);
    for (DimensionInstance& root : roots) report(root, diagnostics);
    // What no texture calls may be called with anything.
    for (const FunctionInfo& function : program.functions) {
        if (function.is_library || function.is_texture || checker.has_seen(function)) continue;
        const auto functions =
            static_cast<size_t>(std::ranges::count(function.parameters, true, &ParameterInfo::is_function));
        const Dimensions anything(function.parameters.size() - functions, Dimension::any());
        report(checker.function(function, PassedFunctions(functions), anything), diagnostics);
    }
    if (!checker.spend(0))
        diagnostics.note({}, "dimension-limit", "this program is too large for all its dimensions to be checked");
}

} // namespace haptel::lang
