#include "lang/syntax/token_cursor.h"

#include <algorithm>

namespace haptel::lang {

bool TokenCursor::accept(Token wanted)
{
    if (!at(wanted)) return false;
    advance();
    return true;
}

bool TokenCursor::expect(Token wanted, std::string_view where)
{
    if (accept(wanted)) return true;
    error(span(), "syntax", "expected " + std::string(describe(wanted)) + " " + std::string(where) + found());
    return false;
}

void TokenCursor::expect_semicolon(std::string_view what)
{
    if (accept(Token::semicolon)) return;
    const std::string message = "expected ';' at the end of " + std::string(what);
    if (on_new_line() || at(Token::right_brace) || at(Token::end)) {
        error(after_previous(), "syntax", message).fix = FixIt{after_previous(), ";"};
        stand_again(); // nothing else is wrong
    } else {
        error(span(), "syntax", message + found());
    }
}

void TokenCursor::report_unclosed(Token closer, Span opener, bool list_may_go_on)
{
    if (lost) {
        ++mistakes;
        return;
    }
    const Position opened = sources.position(file, opener.begin);
    const bool same_line = opened.line == sources.line_of(file, span().begin);
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

void TokenCursor::stand_again()
{
    lost = false;
    footing_line = sources.line_of(file, previous_span().end);
}

void TokenCursor::give_up()
{
    given_up = std::min(given_up, position);
    position = list.tokens.size() - 1;
    end_is_reported = true;
}

Diagnostic& TokenCursor::error(Span where, ErrorCode code, std::string message, std::string_view hint)
{
    const bool beside_invalid = at(Token::invalid) || previous_kind() == Token::invalid;
    const bool silent = lost || beside_invalid || (at(Token::end) && end_is_reported) ||
                        sources.line_of(file, where.begin) <= footing_line;
    lost = true;
    ++mistakes;
    if (silent) return unheard = {};
    end_is_reported = at(Token::end);
    Diagnostic& reported = diagnostics.error(where, code, std::move(message), hint);
    if (diagnostics.full()) give_up();
    return reported;
}

Diagnostic& TokenCursor::slip(Span where, ErrorCode code, std::string message, std::string_view hint)
{
    ++mistakes;
    return diagnostics.error(where, code, std::move(message), hint);
}

bool TokenCursor::at_texture_or_import() const
{
    return (at(Token::kw_texture) && kind(1) == Token::name) ||
           (at(Token::kw_import) && (kind(1) == Token::name || kind(1) == Token::string));
}

bool TokenCursor::on_new_line() const
{
    return sources.line_of(file, previous_span().end) < sources.line_of(file, span().begin);
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
        if (is_statement_word(here) && open_braces == 0 && on_new_line()) return;
        if (here == Token::end || at_texture_or_import()) return;
        if (here == Token::semicolon && open_braces == 0) return;
        if (open == 0 && std::find(stops.begin(), stops.end(), here) != stops.end()) return;
        if (opens(here)) {
            ++open;
            if (here == Token::left_brace) ++open_braces;
        } else if (closes(here)) {
            if (open == 0) return;
            --open;
            if (here == Token::right_brace && open_braces > 0 && --open_braces == 0) open = 0;
        }
    }
}

void TokenCursor::skip_braces()
{
    for (uint32_t open = 0; !at(Token::end) && !at_texture_or_import(); advance()) {
        if (at(Token::left_brace)) ++open;
        if (at(Token::right_brace) && --open == 0) return advance();
    }
}

size_t TokenCursor::closer_ahead(size_t opener, size_t farthest) const
{
    size_t open = 0, ahead = opener;
    for (; ahead - opener < farthest; ++ahead) {
        const Token here = kind(ahead);
        if (opens(here)) ++open;
        if (closes(here) && --open == 0) break;
        if (here == Token::left_brace || here == Token::right_brace || here == Token::semicolon || here == Token::end)
            break;
    }
    return ahead;
}

size_t TokenCursor::first_ahead(std::initializer_list<Token> wanted) const
{
    size_t ahead = 0;
    while (ahead < farthest_look && std::ranges::find(wanted, kind(ahead)) == wanted.end()) ++ahead;
    return ahead;
}

void TokenCursor::refuse_to_nest()
{
    error(span(), "too-deep", "this is nested more than 256 levels deep", "give parts of it names of their own");
    give_up();
}

} // namespace haptel::lang
