#include "lang/text/diagnostic.h"

#include <algorithm>
#include <tuple>

namespace haptel::lang {

namespace {

constexpr size_t notice_limit = 200; // warnings and notes

} // namespace

Diagnostic& Diagnostics::error(Span span, ErrorCode code, std::string message, std::string_view hint)
{
    return add(Severity::error, span, code.string(), std::move(message), hint);
}

Diagnostic& Diagnostics::warning(Span span, WarningCode code, std::string message, std::string_view hint)
{
    return add(Severity::warning, span, code.string(), std::move(message), hint);
}

Diagnostic& Diagnostics::note(Span span, NoteCode code, std::string message, std::string_view hint)
{
    return add(Severity::note, span, code.string(), std::move(message), hint);
}

Diagnostic& Diagnostics::add(Severity severity, Span span, std::string code, std::string message, std::string_view hint)
{
    Diagnostic diagnostic{severity, std::move(code), span, std::move(message), std::string(hint), {}, {}};
    const bool is_error = severity == Severity::error;
    if (is_error) ++report_count;
    const auto same_place = [&](const Diagnostic& other) {
        if (other.span.file != span.file || other.span.begin != span.begin) return false;
        return is_error ? other.severity == Severity::error
                        : other.span.end == span.end && other.code == diagnostic.code;
    };
    const bool no_room = is_error ? full() : items.size() - error_count >= notice_limit;
    if (no_room || std::any_of(items.begin(), items.end(), same_place)) {
        scratch = std::move(diagnostic);
        return scratch;
    }
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
    std::stable_sort(items.begin(), items.end(),
                     [&](const Diagnostic& a, const Diagnostic& b) { return place(a) < place(b); });
}

} // namespace haptel::lang
