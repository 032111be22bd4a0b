#include "tools/check/amplified_place.h"

#include <fmt/format.h>
#include <string_view>

namespace haptel::tools {

AmplifiedPlace place_of(const jit::AmplifiedRounding& found, const lang::SourceSet& sources)
{
    const std::string_view text = sources.text(found.span);
    const size_t line_end = text.find('\n');
    return {sources.file(found.span.file).name,
            std::string(text.substr(0, line_end)) + (line_end == text.npos ? "" : " ..."),
            sources.position(found.span.file, found.span.begin), found.is_hash_of_sine};
}

std::string AmplifiedPlace::where() const
{
    return fmt::format("{}:{}:{}: {}", file, at.line, at.column, text);
}

std::string AmplifiedPlace::hint() const
{
    return is_hash_of_sine
               ? "late digits of a sine are others in every precision, so f32 feels another surface; hash() "
                 "of the library is the same in all"
               : "few digits of a large number stand behind its point: keep it small, or take hash() of the "
                 "library where a random number is wanted";
}

} // namespace haptel::tools
