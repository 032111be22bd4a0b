// A place in the tokens of a file, and the rules of recovery that every part of the grammar shares.
//
// One mistake makes one message: after an error the cursor is `lost` and says nothing more until the grammar has found
// its footing at the next statement, parameter or declaration, nor on the rest of that line, where a mistake often
// lingers; beside an `invalid` token it is silent, because the lexer has spoken; and the end of the file
// is reported once. Every skip moves forward, so that parsing takes linear time whatever the text.
#pragma once

#include "lang/text/lexer.h"

#include <algorithm>
#include <string>

namespace haptel::lang {

class TokenCursor {
protected:
    TokenCursor(const SourceSet& all_sources, uint32_t file_index, TokenList token_list, Diagnostics& sink);

    Token kind(size_t ahead = 0) const { return token(ahead).kind; }
    bool at(Token wanted) const { return kind() == wanted; }
    const PlacedToken& token(size_t ahead = 0) const
    {
        return list.tokens[std::min(position + ahead, list.tokens.size() - 1)];
    }
    Span span(size_t ahead = 0) const { return span_of(token(ahead)); }
    Span previous_span() const { return position > 0 ? span_of(list.tokens[position - 1]) : Span{file, 0, 0}; }
    Span since(Span first) const { return join(first, previous_span()); } // from `first` to what was last taken
    Span after_previous() const { return {file, previous_span().end, previous_span().end}; }
    std::string_view text(size_t ahead = 0) const { return sources.text(span(ahead)); }

    void advance();
    bool accept(Token wanted);
    // Takes `wanted`, or reports "expected ',' after the path, found 'x'" and takes nothing. `where` may be empty.
    bool expect(Token wanted, std::string_view where);
    // Takes the ';' at the end of `what`, or reports it missing at the end of the line above rather than at the next
    // token.
    bool expect_semicolon(std::string_view what);

    // Takes the closing bracket that belongs to `opener`, skipping what stands before it if need be; reports what was
    // expected, at which line it was opened, and what was found. False if it is not in this statement.
    bool close(Token closer, Span opener, bool list_may_go_on = false);
    void report_unclosed(Token closer, Span opener, bool list_may_go_on = false);

    // Silent while lost and beside an invalid token; lost afterwards, and at the end of the file if enough is said.
    Diagnostic& error(Span where, ErrorCode code, std::string message, std::string_view hint = {});
    std::string found() const; // ", found 'x'"
    // "texture wood" or "import wood": never inside a body, so that a bracket left open does not reach across.
    bool at_texture_or_import() const;
    bool on_new_line() const; // a line ends between what was last taken and here

    // Skips to the first of `stops` outside brackets opened on the way; stops at ';' (unless inside braces opened on
    // the way), at a closing bracket of the surroundings and at the end.
    void skip_to(std::initializer_list<Token> stops);
    // At an opening bracket: skips to behind its closer.
    void skip_brackets();

    // How deep the tree below the current place may become. A bracket or a nested statement weighs `bracket`, one
    // operand of an operator `operand`: recursion over the tree is bounded by the sum.
    class Nesting {
    public:
        static constexpr uint32_t operand = 1, bracket = 4, limit = 257 * bracket; // the outermost braces are no level
        Nesting(TokenCursor& owner, uint32_t weight_of_level);
        ~Nesting() { cursor.depth -= weight; }
        Nesting(const Nesting&) = delete;
        Nesting& operator=(const Nesting&) = delete;
        bool too_deep() const { return cursor.depth > limit; } // reported

    private:
        TokenCursor& cursor;
        uint32_t weight;
    };
    void report_too_deep();

    const SourceSet& sources;
    const uint32_t file;
    TokenList list; // a token that was misspelt becomes the one that was meant
    Diagnostics& diagnostics;
    size_t position = 0;
    uint32_t depth = 0;
    bool lost = false;
    void stand_again();    // no longer lost: what comes is read as it stands
    uint32_t mistakes = 0; // grows with every error, heard or not

private:
    Span span_of(const PlacedToken& placed) const { return {file, placed.begin, placed.end}; }
    bool beside_invalid() const;
    bool lingers(Span where);
    size_t footing = SIZE_MAX; // where we last stood again
    size_t line_end;           // the first behind there, or behind an earlier footing on the same line
    bool end_is_reported = false;
    Diagnostic unheard;
};

} // namespace haptel::lang
