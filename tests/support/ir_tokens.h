// Words of the IR's text form.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace haptel::ir {

struct Token {
    enum class Kind { end, word, string, value, mark } kind = Kind::end; // numbers are words
    std::string text;
    int line = 1;
};

std::vector<Token> tokenize(std::string_view text);

} // namespace haptel::ir
