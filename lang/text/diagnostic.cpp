#include "lang/text/diagnostic.h"

#include <algorithm>
#include <tuple>

namespace haptel::lang {

namespace {

constexpr size_t notice_limit = 200; // warnings and notes

// Edit distance with transpositions (optimal string alignment). Upper and lower case are a quarter apart, a letter
// typed twice or once too few a half.
double edit_distance(std::string_view a, std::string_view b)
{
    const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; };
    const auto change = [&](char x, char y) { return x == y ? 0.0 : lower(x) == lower(y) ? 0.25 : 1.0; };
    const auto skip = [](std::string_view text, size_t i) { return i > 1 && text[i - 1] == text[i - 2] ? 0.5 : 1.0; };
    std::vector<double> before, above(b.size() + 1), row(b.size() + 1);
    for (size_t j = 1; j <= b.size(); ++j) above[j] = above[j - 1] + skip(b, j);
    for (size_t i = 1; i <= a.size(); ++i) {
        row[0] = above[0] + skip(a, i);
        for (size_t j = 1; j <= b.size(); ++j) {
            row[j] =
                std::min({above[j] + skip(a, i), row[j - 1] + skip(b, j), above[j - 1] + change(a[i - 1], b[j - 1])});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                row[j] = std::min(row[j], before[j - 2] + 1);
        }
        before = above;
        above = row;
    }
    return above[b.size()];
}

} // namespace

Diagnostic& Diagnostics::error(Span span, ErrorCode code, std::string message)
{
    return add(Severity::error, span, code.string(), std::move(message));
}

Diagnostic& Diagnostics::warning(Span span, WarningCode code, std::string message)
{
    return add(Severity::warning, span, code.string(), std::move(message));
}

Diagnostic& Diagnostics::note(Span span, NoteCode code, std::string message)
{
    return add(Severity::note, span, code.string(), std::move(message));
}

Diagnostic& Diagnostics::add(Severity severity, Span span, std::string code, std::string message)
{
    Diagnostic diagnostic{severity, std::move(code), span, std::move(message), {}, {}, {}};
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

std::string_view nearest_name(std::string_view name, const std::vector<std::string_view>& candidates)
{
    constexpr size_t longest = 64; // nobody mistypes a longer name by a few letters; bounds the work
    if (name.size() > longest) return {};
    std::string_view best;
    double best_distance = std::max(1.0, static_cast<double>(name.size()) / 3) + 0.11;
    for (const std::string_view candidate : candidates) {
        if (candidate.size() > longest) continue;
        const size_t longer = std::max(name.size(), candidate.size()),
                     shorter = std::min(name.size(), candidate.size());
        const double distance =
            edit_distance(name, candidate) + (longer > shorter ? 0.1 : 0); // a slip keeps the length
        const bool all_differs = distance >= static_cast<double>(longer);
        if (distance < best_distance && !all_differs) {
            best = candidate;
            best_distance = distance;
        }
    }
    return best;
}

} // namespace haptel::lang
