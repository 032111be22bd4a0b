// How a file of an installed library is named wherever a path may stand, in an import, a scene or on the command line:
// "wood.oak" is the file oak.haptel of the library wood, "wood.board.pine" its board/pine.haptel.
#pragma once

#include <algorithm>
#include <string_view>

namespace haptel {

// Of letters, digits and '_', not a digit first.
inline bool is_plain_name(std::string_view text)
{
    const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
    const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
    return !text.empty() && is_letter(text[0]) &&
           std::all_of(text.begin(), text.end(), [&](char c) { return is_letter(c) || is_digit(c); });
}

// Two names or more with dots between them, the last not "haptel": "oak.haptel" is a path, as is "./wood.oak".
inline bool names_library_file(std::string_view text)
{
    if (text.find('.') == text.npos) return false;
    for (std::string_view rest = text;;) {
        const std::size_t dot = rest.find('.');
        if (!is_plain_name(rest.substr(0, dot))) return false;
        if (dot == rest.npos) return rest != "haptel";
        rest.remove_prefix(dot + 1);
    }
}

// Its texture where no other is named: that which is called like the file, `oak` of "wood.oak".
inline std::string_view texture_called_like(std::string_view library_file)
{
    return library_file.substr(library_file.rfind('.') + 1);
}

} // namespace haptel
