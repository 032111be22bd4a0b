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
public:
    TokenCursor(const SourceSet& all_sources, uint32_t file_index, TokenList token_list, Diagnostics& sink)
        : sources(all_sources), file(file_index), list(std::move(token_list)), diagnostics(sink)
    {
    }

protected:
    Token kind(size_t ahead = 0) const { return token(ahead).kind; }
    bool at(Token wanted) const { return kind() == wanted; }
    const PlacedToken& token(size_t ahead = 0) const
    {
        return list.tokens[std::min(position + ahead, list.tokens.size() - 1)];
    }
    Span span(size_t ahead = 0) const { return span_of(token(ahead)); }
    Token previous_kind() const { return position > 0 ? list.tokens[position - 1].kind : Token::end; }
    Span previous_span() const { return position > 0 ? span_of(list.tokens[position - 1]) : Span{file, 0, 0}; }
    Span since(Span first) const { return join(first, previous_span()); } // from `first` to what was last taken
    Span after_previous() const { return {file, previous_span().end, previous_span().end}; }
    std::string_view text(size_t ahead = 0) const { return sources.text(span(ahead)); }

    void advance(size_t count = 1) { position = std::min(position + count, list.tokens.size() - 1); }
    bool accept(Token wanted);
    // Takes `wanted`, or reports "expected ',' after the path, found 'x'" and takes nothing.
    bool expect(Token wanted, std::string_view where);
    // Takes the ';' at the end of `what`, or reports it missing at the end of the line above rather than at the next
    // token.
    void expect_semicolon(std::string_view what);

    // Takes the closing bracket that belongs to `opener`, skipping what stands before it if need be; reports what was
    // expected, at which line it was opened, and what was found. False if it is not in this statement.
    bool close(Token closer, Span opener, bool list_may_go_on = false);
    void report_unclosed(Token closer, Span opener, bool list_may_go_on = false);

    // Silent while lost and beside an invalid token; lost afterwards, and at the end of the file if enough is said.
    Diagnostic& error(Span where, ErrorCode code, std::string message, std::string_view hint = {});
    // What is wrong and yet read as it was meant: never silent, nor lost afterwards.
    Diagnostic& slip(Span where, ErrorCode code, std::string message, std::string_view hint);
    void give_up();            // leaves the rest unread
    void stand_again();        // no longer lost: what comes is read as it stands
    std::string found() const; // ", found 'x'"
    // "texture wood" or "import wood": never inside a body, so that a bracket left open does not reach across.
    bool at_texture_or_import() const;
    bool on_new_line() const; // a line ends between what was last taken and here

    // Skips to the first of `stops` outside brackets opened on the way; stops at ';' (unless inside braces opened on
    // the way), at a closing bracket of the surroundings and at the end.
    void skip_to(std::initializer_list<Token> stops);
    // At '{': skips to behind its '}'.
    void skip_braces();

    // How far any look ahead goes; keeps the whole parse linear.
    static constexpr size_t farthest_look = 1000;
    // Where the bracket that many tokens ahead is closed, or what stops the look for it: a brace, a ';', the end.
    size_t closer_ahead(size_t opener, size_t farthest = farthest_look) const;
    // Where the first of these stands.
    size_t first_ahead(std::initializer_list<Token> wanted) const;

    // How deep the tree below the current place may become. A bracket or a nested statement weighs `bracket`, one
    // operand of an operator `operand`: recursion over the tree is bounded by the sum. What would be deeper is
    // reported, and nothing behind it is read: the cursor is at the end, where nothing nests.
    class Nesting {
    public:
        static constexpr uint32_t operand = 1, bracket = 4, limit = 257 * bracket; // the outermost braces are no level
        Nesting(TokenCursor& owner, uint32_t weight) : cursor(owner), depth_before(owner.depth) { deepen(weight); }
        ~Nesting() { cursor.depth = depth_before; }
        Nesting(const Nesting&) = delete;
        Nesting& operator=(const Nesting&) = delete;
        void deepen(uint32_t weight)
        {
            if ((cursor.depth += weight) > limit) cursor.refuse_to_nest();
        }

    private:
        TokenCursor& cursor;
        uint32_t depth_before;
    };

    const SourceSet& sources;
    const uint32_t file;
    TokenList list; // a token that was misspelt becomes the one that was meant
    Diagnostics& diagnostics;
    size_t position = 0;
    uint32_t depth = 0;
    bool lost = false;
    uint32_t mistakes = 0;      // grows with every error, heard or not
    size_t given_up = SIZE_MAX; // the first token that was not read because enough was said

private:
    Span span_of(const PlacedToken& placed) const { return {file, placed.begin, placed.end}; }
    void refuse_to_nest();

    uint32_t footing_line = 0; // where we last stood again; 0: nowhere yet
    bool end_is_reported = false;
    Diagnostic unheard;
};

// Words that only ever begin something: a bracket left open does not reach across them.
constexpr bool is_statement_word(Token kind)
{
    return kind >= Token::kw_if && kind <= Token::kw_return;
}

} // namespace haptel::lang
