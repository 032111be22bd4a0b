#include "lang/text/diagnostic.h"

#include <algorithm>
#include <tuple>

namespace haptel::lang {

Diagnostic& Diagnostics::error(Span span, ErrorCode code, std::string message, std::string_view hint)
{
    return add({Severity::error, code.string(), span, std::move(message), std::string(hint), {}, {}});
}

Diagnostic& Diagnostics::warning(Span span, WarningCode code, std::string message, std::string_view hint)
{
    return add({Severity::warning, code.string(), span, std::move(message), std::string(hint), {}, {}});
}

Diagnostic& Diagnostics::note(Span span, NoteCode code, std::string message, std::string_view hint)
{
    return add({Severity::note, code.string(), span, std::move(message), std::string(hint), {}, {}});
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
    const bool no_room = is_error ? full() : items.size() - error_count >= notice_limit;
    if (no_room || std::ranges::any_of(items, is_same)) return scratch = std::move(diagnostic);
    if (is_error) ++error_count;
    items.push_back(std::move(diagnostic));
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
