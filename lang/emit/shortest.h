// A finite number in the fewest digits that give it back, with a point or an exponent.
#pragma once

#include <charconv>
#include <iterator>
#include <string>

namespace haptel::emit {

template <typename F>
std::string shortest(F value)
{
    char digits[64];
    std::string text(digits, std::to_chars(digits, std::end(digits), value).ptr);
    if (text.find_first_of(".e") == text.npos) text += ".0";
    return text;
}

} // namespace haptel::emit
