#include "lang/check/dimension/check_dimensions.h"

#include "lang/check/dimension/dimension_checker.h"
#include "lang/check/library.h"

#include <algorithm>
#include <set>
#include <tuple>
#include <unordered_set>

namespace haptel::lang {
namespace {

constexpr size_t work_max = 1'000'000; // expressions looked at; well below a second

// Findings of an instance and of what it calls, each instance once.
class Reporter {
public:
    explicit Reporter(Diagnostics& sink) : diagnostics(sink) {}

    void report(const DimensionInstance& root)
    {
        std::vector<const DimensionInstance*> pending{&root};
        while (!pending.empty()) {
            const DimensionInstance& instance = *pending.back();
            pending.pop_back();
            if (!reported.insert(&instance).second) continue;
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
        said.hint = has_other_calls && finding.changes_body
                        ? "'" + instance.name + "' is called with other dimensions too: mend the call"
                        : finding.hint;
        if (!instance.called_with.empty())
            said.related.push_back(
                {instance.called_at, "'" + instance.name + "' is called here with " + instance.called_with});
    }

    Diagnostics& diagnostics;
    std::unordered_set<const DimensionInstance*> reported;
    std::set<std::tuple<uint32_t, uint32_t, uint32_t>> places;
};

} // namespace

bool DimensionChecker::spend(size_t steps)
{
    work += steps;
    is_exhausted = is_exhausted || work > work_max;
    return !is_exhausted;
}

void DimensionChecker::add_constants(const std::vector<CheckFile>& files, bool is_library)
{
    for (size_t file = files.size(); file-- > 0;)
        for (const ast::Constant& constant : files[file].tree.constants) {
            DimensionInstance& root = roots.emplace_back();
            constant_roots.push_back(&root);
            const Dimension dimension = DimensionBody(*this, root, is_library).constant(constant.declaration);
            if (constant.declaration.symbol) symbols.insert_or_assign(constant.declaration.symbol, dimension);
        }
}

// The library's first, those of the main file last, as check() has read them.
const std::vector<const DimensionInstance*>& DimensionChecker::constants()
{
    if (program.library) add_constants(program.library->program.files, true);
    add_constants(program.files, false);
    return constant_roots;
}

const DimensionInstance& DimensionChecker::texture(const CheckedTexture& texture)
{
    DimensionInstance& root = roots.emplace_back();
    root.name = texture.tree->name.text;
    DimensionBody(*this, root, false).texture(texture);
    return root;
}

const DimensionInstance& DimensionChecker::function(const FunctionInfo& info, const FunctionReferences& passed,
                                                    const Dimensions& arguments)
{
    Key key{&info, {}, arguments};
    for (const FunctionReference& function : passed) key.passed.push_back(identity(function));
    const auto [place, is_new] = instances.try_emplace(std::move(key));
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
    for (const DimensionInstance* constant : checker.constants()) reporter.report(*constant);
    for (const CheckedTexture& texture : program.textures) reporter.report(checker.texture(texture));
    // What no texture calls may be called with anything.
    for (const FunctionInfo& function : program.functions) {
        if (function.is_library || checker.has_seen(function)) continue;
        FunctionReferences unknown;
        Dimensions anything;
        for (const ParameterInfo& parameter : function.parameters) {
            if (parameter.is_function)
                unknown.emplace_back();
            else
                anything.push_back(Dimension::any());
        }
        reporter.report(checker.function(function, unknown, anything));
    }
    if (checker.is_exhausted)
        diagnostics.note({}, "dimension-limit", "this program is too large for all its dimensions to be checked");
}

} // namespace haptel::lang
