// The codes of findings. Each is listed once, in diagnostics.def; one that is not listed there, or there with another
// severity, does not compile.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>

namespace haptel::lang {

enum class Severity : uint8_t { error, warning, note };

// What is to be known of a code. `wrong` is a small text that has the finding, `right` the same text mended; both are
// empty where no small text shows it.
struct DiagnosticInfo {
    Severity severity;
    std::string_view code, meaning, explanation, wrong, right;
};

// In the order of diagnostics.def.
std::span<const DiagnosticInfo> all_diagnostics();
// Null: there is no such code.
const DiagnosticInfo* find_diagnostic(std::string_view code);
// "error", "warning", "note"
std::string_view name_of(Severity severity);

inline constexpr std::pair<Severity, std::string_view> listed_codes[] = {
#define DIAGNOSTIC(severity, code, ...) {Severity::severity, code},
#include "lang/text/diagnostics.def"
#undef DIAGNOSTIC
};
constexpr bool is_listed(std::string_view code, Severity severity)
{
    for (const auto& [listed_severity, listed] : listed_codes)
        if (listed == code) return listed_severity == severity;
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

} // namespace haptel::lang
