// What the compiler has to say, as data. Nothing in lang prints, exits or throws across its interface. Each code of a
// finding is listed once, in diagnostics.def; one that is not listed there, or there with another severity, does not
// compile.
#pragma once

#include "lang/text/source.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace haptel::lang {

enum class Severity : uint8_t { error, warning, note };

// What is to be known of a code. `wrong` is a small text that has the finding, `right` the same text mended; both are
// empty where no small text shows it.
struct DiagnosticInfo {
    Severity severity;
    std::string_view code, meaning, explanation, wrong, right;
};

// In the order of diagnostics.def.
inline constexpr DiagnosticInfo all_diagnostics[] = {
#define DIAGNOSTIC(severity, code, meaning, explanation, wrong, right)                                                 \
    {Severity::severity, code, meaning, explanation, wrong, right},
#include "lang/text/diagnostics.def"
#undef DIAGNOSTIC
};
// Null: there is no such code.
const DiagnosticInfo* find_diagnostic(std::string_view code);
constexpr std::string_view name_of(Severity severity)
{
    return severity == Severity::error ? "error" : severity == Severity::warning ? "warning" : "note";
}

constexpr bool is_listed(std::string_view code, Severity severity)
{
    for (const DiagnosticInfo& listed : all_diagnostics)
        if (listed.code == code) return listed.severity == severity;
    return false;
}
void this_code_is_not_in_diagnostics_def(); // never called: where the compiler says that it is, the code is not listed

// A listed code of that severity, made from a literal when the program is compiled.
template <Severity severity>
class CodeOf {
public:
    consteval CodeOf(const char* code) : text(code)
    {
        if (!is_listed(code, severity)) this_code_is_not_in_diagnostics_def();
    }
    operator std::string_view() const { return text; }
    std::string string() const { return std::string(text); }
    friend bool operator==(CodeOf a, CodeOf b) { return a.text == b.text; }

private:
    std::string_view text;
};
using ErrorCode = CodeOf<Severity::error>;
using WarningCode = CodeOf<Severity::warning>;
using NoteCode = CodeOf<Severity::note>;

// Replaces the text of `span` by `replacement`; `haptel check --fix` does so unseen. Hence it may only be what
// certainly means the same, in the language that the author writes: an exact synonym, a mark that is missing, a word
// without effect; and the one name that is near what is written, of a function if the arguments fit it. What is merely
// likely stands in the hint.
struct FixIt {
    Span span;
    std::string replacement;
};

// A further place that explains the finding ("'(' was opened here").
struct Related {
    Span span;
    std::string message;
};

struct Diagnostic {
    Severity severity = Severity::error;
    std::string code;    // of diagnostics.def: "unknown-name"
    Span span;           // the whole expression, not a point in it
    std::string message; // what was expected and what was found
    std::string hint;    // how to mend it ("did you mean 'octaves'?"); may be empty
    std::vector<Related> related;
    std::optional<FixIt> fix;
};

// Collects; keeps at most one error per place and at most `error_limit` errors, so that one mistake does not cascade.
class Diagnostics {
public:
    // Returns the stored diagnostic to add related places or a fix to; a dropped one goes to a scratch object.
    Diagnostic& error(Span span, ErrorCode code, std::string message, std::string_view hint = {})
    {
        return add({Severity::error, code.string(), span, std::move(message), std::string(hint), {}, {}});
    }
    Diagnostic& warning(Span span, WarningCode code, std::string message, std::string_view hint = {})
    {
        return add({Severity::warning, code.string(), span, std::move(message), std::string(hint), {}, {}});
    }
    Diagnostic& note(Span span, NoteCode code, std::string message, std::string_view hint = {})
    {
        return add({Severity::note, code.string(), span, std::move(message), std::string(hint), {}, {}});
    }

    // An error that follows from one that was reported is not said, but what it is in is not sound either.
    void count_consequence() { ++report_count; }

    bool has_errors() const { return error_count > 0; }
    bool full() const { return error_count >= error_limit; } // front-end stages may stop early
    uint32_t reports() const { return report_count; }        // errors so far, those not said included
    const std::vector<Diagnostic>& all() const { return items; }
    void make_warnings_errors();
    void sort_by_place(); // file, line, column; called once before showing

    uint32_t error_limit = 50;

private:
    Diagnostic& add(Diagnostic diagnostic);
    std::vector<Diagnostic> items;
    Diagnostic scratch;
    uint32_t error_count = 0, report_count = 0;
};

// "file:line:col: error: message [code]", the source line, an underline of the whole span, related places, hint.
// Always valid UTF-8 (other bytes are shown as U+FFFD); long lines are cut around the span. `color`: ANSI colours.
std::string render(const std::vector<Diagnostic>& diagnostics, const SourceSet& sources, bool color = false);

} // namespace haptel::lang
