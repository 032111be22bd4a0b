// What the formatter arranges (tokens, each with the comments that belong to it) and the lines that it makes of them.
#pragma once

#include "lang/text/lexer.h"

#include <span>
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
    bool begins_statement = false; // the body of an "if" or "for", or the first of a case
    bool ends_label = false;       // the ':' of a case
};

// Ends with Token::end, which may have comments above it.
std::vector<Piece> pieces_of(std::string_view text, const std::vector<PlacedToken>& tokens);

class Page {
public:
    static constexpr size_t width = 100, step = 4; // columns

    // `pieces` as one logical line, broken where it is longer than the page. `hang`: how much deeper lines go on that
    // stand in no bracket.
    void put(std::span<const Piece> pieces, size_t indent, size_t hang = step);
    // At the end of the last line, which has no comment.
    void append(const Piece& piece);
    // Comments on lines of their own, and the empty line below them.
    void put_above(const Piece& piece, size_t indent);
    // At most one in a row, none at the beginning of a page or block.
    void blank_line();
    // What is put from here to the end of the list has its trailing comments in one column.
    void begin_list() { list_begin = lines.size(); }
    void end_list();

    std::string text();

private:
    struct Line {
        std::string text; // with its indent
        std::string trailing;
        size_t comment_column = 0; // where the trailing comment begins, at least; 0: not known yet
    };
    void align_runs();

    std::vector<Line> lines;
    size_t list_begin = 0;
};

// Whether one line of the page has room for `pieces`, and no comment breaks it.
bool fits(std::span<const Piece> pieces, size_t indent);
// Of `pieces` in one line.
size_t columns_of(std::span<const Piece> pieces);

} // namespace haptel::lang
