#include "tools/check/fixes.h"

#include <algorithm>
#include <set>
#include <utility>

namespace haptel::tools {

namespace {

constexpr int rounds_max = 8;
constexpr size_t single_fixes_max = 64; // compilations of one round in which fixes are tried one by one

// Errors, then warnings: what a text is judged by.
std::pair<size_t, size_t> mistakes(const lang::CompileResult& result)
{
    const auto count = [&](lang::Severity severity) {
        const auto& all = result.diagnostics.all();
        return static_cast<size_t>(
            std::count_if(all.begin(), all.end(), [&](const lang::Diagnostic& d) { return d.severity == severity; }));
    };
    return {count(lang::Severity::error), count(lang::Severity::warning)};
}

} // namespace

std::vector<lang::FixIt> fixes_of(const lang::CompileResult& result)
{
    std::vector<lang::FixIt> all, taken;
    const size_t size = result.sources.file(0).text.size();
    for (const lang::Diagnostic& said : result.diagnostics.all())
        if (said.fix && said.fix->span.file == 0 && said.fix->span.end <= size) all.push_back(*said.fix);
    const auto starts_first = [](const lang::FixIt& a, const lang::FixIt& b) { return a.span.begin < b.span.begin; };
    std::stable_sort(all.begin(), all.end(), starts_first);
    for (const lang::FixIt& fix : all)
        if (taken.empty() || fix.span.begin > taken.back().span.begin)
            if (taken.empty() || fix.span.begin >= taken.back().span.end) taken.push_back(fix);
    return taken;
}

std::string apply_fixes(const std::string& text, const std::vector<lang::FixIt>& fixes)
{
    std::string fixed;
    size_t done = 0; // bytes of `text` that are behind us
    for (const lang::FixIt& fix : fixes) {
        fixed.append(text, done, fix.span.begin - done);
        fixed += fix.replacement;
        done = fix.span.end;
    }
    fixed.append(text, done, std::string::npos);
    return fixed;
}

Mended mend(std::string text, const std::function<lang::CompileResult(const std::string&)>& compile)
{
    Mended mended{std::move(text)};
    lang::CompileResult result = compile(mended.text);
    std::set<std::string> seen{mended.text}; // fixes that lead in a circle end
    for (int round = 0; round < rounds_max; ++round) {
        const std::vector<lang::FixIt> fixes = fixes_of(result);
        if (fixes.empty()) break;
        std::vector<lang::FixIt> good = fixes;
        std::string tried = apply_fixes(mended.text, good);
        lang::CompileResult after = compile(tried);
        if (mistakes(after) > mistakes(result)) { // one of them does harm: which?
            good.clear();
            for (size_t i = 0; i < std::min(fixes.size(), single_fixes_max); ++i) {
                good.push_back(fixes[i]);
                if (mistakes(compile(apply_fixes(mended.text, good))) > mistakes(result)) good.pop_back();
            }
            tried = apply_fixes(mended.text, good);
            after = compile(tried);
        }
        mended.left_out = fixes.size() - good.size();
        if (good.empty() || !seen.insert(tried).second) break;
        mended.applied += good.size();
        mended.text = std::move(tried);
        result = std::move(after);
    }
    return mended;
}

} // namespace haptel::tools
