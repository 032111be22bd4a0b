#include "lang/syntax/token_cursor.h"

#include <algorithm>

namespace haptel::lang {

namespace {

bool is_opener(Token kind)
{
    return kind == Token::left_paren || kind == Token::left_bracket || kind == Token::left_brace;
}

bool is_closer(Token kind)
{
    return kind == Token::right_paren || kind == Token::right_bracket || kind == Token::right_brace;
}

// Words that only ever begin something: a bracket left open does not reach across them.
bool begins_anew(Token kind)
{
    constexpr Token beginnings[] = {Token::kw_if,    Token::kw_else,   Token::kw_for,
                                    Token::kw_break, Token::kw_return, Token::end};
    return std::find(std::begin(beginnings), std::end(beginnings), kind) != std::end(beginnings);
}

} // namespace

TokenCursor::TokenCursor(const SourceSet& all_sources, uint32_t file_index, TokenList token_list, Diagnostics& sink)
    : sources(all_sources)
    , file(file_index)
    , list(std::move(token_list))
    , diagnostics(sink)
    , line_end(sources.file(file).text.find_first_of("\r\n"))
{
}

void TokenCursor::advance()
{
    if (position + 1 < list.tokens.size()) ++position;
}

bool TokenCursor::accept(Token wanted)
{
    if (!at(wanted)) return false;
    advance();
    return true;
}

bool TokenCursor::expect(Token wanted, std::string_view where)
{
    if (accept(wanted)) return true;
    std::string message = "expected " + std::string(describe(wanted));
    if (!where.empty()) message += " " + std::string(where);
    error(span(), "syntax", message + found());
    return false;
}

bool TokenCursor::expect_semicolon(std::string_view what)
{
    if (accept(Token::semicolon)) return true;
    if (on_new_line() || at(Token::right_brace) || at(Token::end)) {
        error(after_previous(), "syntax", "expected ';' at the end of " + std::string(what)).fix =
            FixIt{after_previous(), ";"};
        stand_again(); // nothing else is wrong
        return true;
    }
    error(span(), "syntax", "expected ';' at the end of " + std::string(what) + found());
    return false;
}

void TokenCursor::report_unclosed(Token closer, Span opener, bool list_may_go_on)
{
    if (lost) {
        ++mistakes;
        return;
    }
    const Position opened = sources.position(file, opener.begin);
    const bool same_line = opened.line == sources.position(file, span().begin).line;
    std::string message =
        "expected " + std::string(list_may_go_on ? "',' or " : "") + std::string(describe(closer)) + " to close '" +
        std::string(sources.text(opener)) + "' at " +
        (same_line ? "column " + std::to_string(opened.column) : "line " + std::to_string(opened.line)) + found();
    Diagnostic& reported = error(span(), "syntax", std::move(message));
    if (!same_line) reported.related.push_back({opener, "it was opened here"});
}

bool TokenCursor::close(Token closer, Span opener, bool list_may_go_on)
{
    if (accept(closer)) return true;
    report_unclosed(closer, opener, list_may_go_on);
    if (at(Token::right_brace) && kind(1) == Token::semicolon) advance(); // in the place of ')'
    skip_to({closer});
    return accept(closer);
}

bool TokenCursor::beside_invalid() const
{
    return at(Token::invalid) || (position > 0 && list.tokens[position - 1].kind == Token::invalid);
}

void TokenCursor::stand_again()
{
    lost = false;
    footing = position;
}

// On the line where we stood again, or before it.
bool TokenCursor::lingers(Span where)
{
    if (footing == SIZE_MAX) return false;
    const uint32_t from = footing > 0 ? list.tokens[footing - 1].end : 0;
    if (line_end < from) line_end = sources.file(file).text.find_first_of("\r\n", from);
    return where.begin <= line_end;
}

Diagnostic& TokenCursor::error(Span where, ErrorCode code, std::string message, std::string_view hint)
{
    const bool silent = lost || beside_invalid() || lingers(where) || (at(Token::end) && end_is_reported);
    lost = true;
    ++mistakes;
    if (silent) return unheard = {};
    end_is_reported = at(Token::end);
    Diagnostic& reported = diagnostics.error(where, code, std::move(message), hint);
    if (diagnostics.full()) position = list.tokens.size() - 1; // enough is said: run off the end
    return reported;
}

bool TokenCursor::at_texture_or_import() const
{
    return (at(Token::kw_texture) && kind(1) == Token::name) ||
           (at(Token::kw_import) && (kind(1) == Token::name || kind(1) == Token::string));
}

bool TokenCursor::on_new_line() const
{
    return sources.text({file, previous_span().end, span().begin}).find_first_of("\r\n") != std::string_view::npos;
}

std::string TokenCursor::found() const
{
    if (at(Token::end)) return ", found the end of the file";
    constexpr size_t shown = 40;
    const std::string_view word = text();
    return ", found '" + printable(word.substr(0, shown)) + (word.size() > shown ? "...'" : "'");
}

void TokenCursor::skip_to(std::initializer_list<Token> stops)
{
    uint32_t open = 0, open_braces = 0;
    for (;; advance()) {
        const Token here = kind();
        if (begins_anew(here) && open_braces == 0 && (here == Token::end || on_new_line())) return;
        if (here == Token::end || at_texture_or_import()) return;
        if (here == Token::semicolon && open_braces == 0) return;
        if (open == 0 && std::find(stops.begin(), stops.end(), here) != stops.end()) return;
        if (is_opener(here)) {
            ++open;
            if (here == Token::left_brace) ++open_braces;
        } else if (is_closer(here)) {
            if (open == 0) return;
            --open;
            if (here == Token::right_brace && open_braces > 0 && --open_braces == 0) open = 0;
        }
    }
}

void TokenCursor::skip_brackets()
{
    const Token opener = kind();
    const Token closer = opener == Token::left_paren     ? Token::right_paren
                         : opener == Token::left_bracket ? Token::right_bracket
                                                         : Token::right_brace;
    uint32_t open = 0;
    for (; !at(Token::end) && !at_texture_or_import(); advance()) {
        if (at(opener)) ++open;
        if (at(closer) && --open == 0) {
            advance();
            return;
        }
        if (at(Token::semicolon) && opener != Token::left_brace) return;
    }
}

TokenCursor::Nesting::Nesting(TokenCursor& owner, uint32_t weight_of_level) : cursor(owner), weight(weight_of_level)
{
    cursor.depth += weight;
    if (too_deep()) cursor.report_too_deep();
}

void TokenCursor::report_too_deep()
{
    error(span(), "too-deep", "this is nested more than 256 levels deep", "give parts of it names of their own");
}

} // namespace haptel::lang
