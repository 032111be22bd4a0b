#include "lang/text/diagnostic_code.h"

#include <algorithm>

namespace haptel::lang {
namespace {

constexpr DiagnosticInfo infos[] = {
#define DIAGNOSTIC(severity, code, meaning, explanation, wrong, right)                                                 \
    {Severity::severity, code, meaning, explanation, wrong, right},
#include "lang/text/diagnostics.def"
#undef DIAGNOSTIC
};

} // namespace

std::span<const DiagnosticInfo> all_diagnostics()
{
    return infos;
}

const DiagnosticInfo* find_diagnostic(std::string_view code)
{
    const auto found = std::ranges::find(infos, code, &DiagnosticInfo::code);
    return found == std::end(infos) ? nullptr : found;
}

std::string_view name_of(Severity severity)
{
    switch (severity) {
    case Severity::error: return "error";
    case Severity::warning: return "warning";
    case Severity::note: return "note";
    }
    return {};
}

} // namespace haptel::lang
