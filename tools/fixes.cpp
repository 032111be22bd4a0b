#include "tools/fixes.h"

#include <algorithm>
#include <vector>

namespace haptel::tools {

FixedText apply_fixes(const std::string& text, uint32_t file, const lang::Diagnostics& diagnostics)
{
    std::vector<lang::FixIt> fixes;
    for (const lang::Diagnostic& said : diagnostics.all())
        if (said.fix && said.fix->span.file == file && said.fix->span.end <= text.size()) fixes.push_back(*said.fix);
    const auto starts_first = [](const lang::FixIt& a, const lang::FixIt& b) { return a.span.begin < b.span.begin; };
    std::stable_sort(fixes.begin(), fixes.end(), starts_first);

    FixedText fixed;
    uint32_t done = 0; // bytes of `text` that are behind us
    for (const lang::FixIt& fix : fixes) {
        if (fix.span.begin < done) continue;
        fixed.text.append(text, done, fix.span.begin - done);
        fixed.text += fix.replacement;
        done = fix.span.end;
        ++fixed.applied;
    }
    fixed.text.append(text, done, std::string::npos);
    return fixed;
}

} // namespace haptel::tools
