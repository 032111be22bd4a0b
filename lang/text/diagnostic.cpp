#include "lang/text/diagnostic.h"

#include <algorithm>
#include <tuple>

namespace haptel::lang {

const DiagnosticInfo* find_diagnostic(std::string_view code)
{
    const auto found = std::ranges::find(all_diagnostics, code, &DiagnosticInfo::code);
    return found == std::end(all_diagnostics) ? nullptr : found;
}

Diagnostic& Diagnostics::add(Diagnostic diagnostic)
{
    constexpr size_t notice_limit = 200; // warnings and notes
    const bool is_error = diagnostic.severity == Severity::error;
    if (is_error) ++report_count;
    const auto is_same = [&, span = diagnostic.span](const Diagnostic& other) {
        if (other.span.file != span.file || other.span.begin != span.begin) return false;
        return is_error ? other.severity == Severity::error
                        : other.span.end == span.end && other.code == diagnostic.code;
    };
    const auto no_room = [&] { return is_error ? full() : items.size() - error_count >= notice_limit; };
    if (no_room() || std::ranges::any_of(items, is_same)) return scratch = std::move(diagnostic);
    if (is_error) ++error_count;
    items.push_back(std::move(diagnostic));
    if (no_room()) {
        const std::string kind = is_error ? "error" : "warning or note";
        items.back().related.push_back({items.back().span, "this is the last " + kind + " that is told"});
    }
    return items.back();
}

void Diagnostics::make_warnings_errors()
{
    for (Diagnostic& item : items)
        if (item.severity == Severity::warning) {
            item.severity = Severity::error;
            ++error_count;
        }
}

void Diagnostics::sort_by_place()
{
    const auto place = [](const Diagnostic& d) { return std::tuple(d.span.file, d.span.begin, d.span.end); };
    std::ranges::stable_sort(items, {}, place);
}

} // namespace haptel::lang
