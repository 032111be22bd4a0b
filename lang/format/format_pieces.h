// What the formatter arranges: tokens, each with the comments that belong to it.
#pragma once

#include "lang/text/lexer.h"

#include <string>
#include <vector>

namespace haptel::lang {

struct Remark { // comments of one line
    std::string text;
    bool blank_above;
};

struct Piece {
    Token kind = Token::end;
    std::string text;          // with comments that stand before it in its line
    std::vector<Remark> above; // comments on lines of their own
    std::string trailing;      // comments behind it that end its line
    size_t lead = 0;           // spaces before it beyond the usual one
    bool blank_above = false;  // an empty line right above the token
    bool begins_line = false;
    bool has_comment = false;      // in its text
    bool begins_statement = false; // the body of an "if" or "for"
};

// Ends with Token::end, which may have comments above it.
std::vector<Piece> pieces_of(std::string_view text, const std::vector<PlacedToken>& tokens);

// Columns that a line of UTF-8 takes.
size_t width_of(std::string_view text);

} // namespace haptel::lang
