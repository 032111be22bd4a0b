// What the compiler has to say, as data. Nothing in lang prints, exits or throws across its interface.
#pragma once

#include "lang/text/diagnostic_code.h"
#include "lang/text/source.h"

#include <optional>
#include <string>
#include <vector>

namespace haptel::lang {

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
    Diagnostic& error(Span span, ErrorCode code, std::string message, std::string_view hint = {});
    Diagnostic& warning(Span span, WarningCode code, std::string message, std::string_view hint = {});
    Diagnostic& note(Span span, NoteCode code, std::string message, std::string_view hint = {});

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
