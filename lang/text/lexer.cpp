#include "lang/text/lexer.h"

#include "lang/text/lexing.h"
#include "lang/text/number.h"

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <utility>

namespace haptel::lang {

namespace {

using Spelling = std::pair<Token, std::string_view>;

// Characters that word processors and web pages put where ASCII was meant.
struct Lookalike {
    char32_t character;
    std::string_view meant;
};
constexpr Lookalike lookalikes[] = {
    {0x00A0, " "}, {0x00D7, "*"},  {0x00F7, "/"},  {0x2010, "-"},  {0x2011, "-"},  {0x2013, "-"}, {0x2014, "-"},
    {0x2018, "'"}, {0x2019, "'"},  {0x201C, "\""}, {0x201D, "\""}, {0x2026, ".."}, {0x2212, "-"}, {0x2215, "/"},
    {0x22C5, "*"}, {0x2264, "<="}, {0x2265, ">="}, {0x2260, "!="}, {0x037E, ";"},
};

// Of symbols and keywords; those with one first character stand in a row, the longest first.
constexpr auto spellings = [] {
    std::array all{
#define SYMBOL(name, spelling) Spelling{Token::name, spelling},
#define KEYWORD(name, spelling) Spelling{Token::name, spelling},
#include "lang/text/token.def"
#undef SYMBOL
#undef KEYWORD
    };
    std::ranges::sort(all, [](const Spelling& a, const Spelling& b) {
        return a.second[0] != b.second[0] ? a.second[0] < b.second[0] : a.second.size() > b.second.size();
    });
    return all;
}();
// Where those begin, so that a text is read at the speed of its bytes and not of the list.
constexpr auto first_with = [] {
    std::array<uint8_t, 257> first{};
    for (const auto& [token, spelling] : spellings) ++first[index_of(spelling[0]) + 1u];
    for (size_t c = 1; c < first.size(); ++c) first[c] = static_cast<uint8_t>(first[c] + first[c - 1]);
    return first;
}();
std::span<const Spelling> spellings_with(char c)
{
    const size_t first = first_with[index_of(c)], end = first_with[index_of(c) + 1u];
    return std::span(spellings).subspan(first, end - first);
}

Token keyword_or_name(std::string_view word)
{
    for (const auto& [token, spelling] : spellings_with(word[0]))
        if (word == spelling) return token;
    return Token::name;
}

// Where a file that is no text stops being one: at a zero byte, or at the first of many bytes that no text has.
std::optional<uint32_t> first_of_garbage(std::string_view text)
{
    constexpr size_t tolerated = 16, one_in = 20;
    size_t odd = 0;
    uint32_t first = 0;
    for (uint32_t at = 0; at < text.size();) {
        while (at < text.size() && ((text[at] >= ' ' && text[at] < 127) || text[at] == '\n')) ++at; // nearly all
        if (at == text.size()) break;
        if (text[at] == '\0') return odd > 0 ? first : at;
        const CodePoint point = decode_utf8(text, at);
        const bool is_control = point.value < 0x80 && !is_space(text[at]);
        if ((is_control || point.value == invalid_code_point) && odd++ == 0) first = at;
        at += point.length;
    }
    return odd > tolerated && odd > text.size() / one_in ? std::optional(first) : std::nullopt;
}

} // namespace

TokenList Lexer::run()
{
    list.tokens.reserve(std::min<size_t>(text.size() / 4, 1 << 16)); // as texts go
    while (at < text.size() && !diagnostics.full()) next();
    for (const Conditions::Open& left : conditions.open)
        diagnostics.error({file, left.begin, left.end}, "preprocessor",
                          "this choice is never ended: expected '#endif' before the end of the file");
    list.tokens.push_back({Token::end, size(), size()});
    return std::move(list);
}

void Lexer::next()
{
    const char c = text[at];
    const uint32_t begin = at;
    if (is_space(c)) {
        ++at;
    } else if (c == '/' && peek(1) == '/') {
        line_comment();
    } else if (c == '/' && peek(1) == '*') {
        block_comment();
    } else if (is_name_start(c)) {
        while (is_name_part(peek())) ++at;
        push(keyword_or_name(text.substr(begin, at - begin)), begin);
    } else if (is_digit(c) || (c == '.' && is_digit(peek(1)))) {
        number();
    } else if (c == '"') {
        string();
    } else if (c == '#' && !in_definition) {
        directive();
    } else if (!symbol()) {
        unexpected();
    }
}

void Lexer::push(Token kind, uint32_t begin)
{
    if (!has_room(begin)) return;
    if (kind != Token::invalid && at - begin > word_bytes_max) {
        diagnostics.error(span_from(begin), "too-large",
                          "expected at most " + std::to_string(word_bytes_max) +
                              " characters in a name, number or path, found " + std::to_string(at - begin));
        kind = Token::invalid;
    }
    list.tokens.push_back({kind, begin, at});
}

// For one more token or comment, which is at `begin`; else nothing is kept and the rest is not read.
bool Lexer::has_room(uint32_t begin)
{
    if (list.count++ < room) return true;
    diagnostics.error({file, begin, begin + 1}, "too-large",
                      "expected at most " + std::to_string(tokens_max) +
                          " words, numbers, signs and comments in a program with its imports",
                      "large tables belong into pictures: texture t(image picture)");
    list = {{}, {}, room, list.has_directives, {}};
    at = size();
    return false;
}

void Lexer::line_comment()
{
    const uint32_t begin = at;
    const bool doc = rest().starts_with("///") && !rest().starts_with("////");
    const std::string_view line = rest().substr(0, rest().find('\n'));
    at += static_cast<uint32_t>(std::min(line.size(), line.find('\r')));
    if (has_room(begin) && doc) list.docs.push_back({span_from(begin), static_cast<uint32_t>(list.tokens.size())});
}

void Lexer::block_comment()
{
    const size_t end = text.find("*/", at + 2);
    if (end != std::string_view::npos) {
        const uint32_t begin = std::exchange(at, static_cast<uint32_t>(end + 2));
        has_room(begin);
        return;
    }
    diagnostics.error({file, at, at + 2}, "open-comment",
                      "this comment is never closed: expected '*/' before the end of the file");
    const uint32_t begin = std::exchange(at, size());
    push(Token::invalid, begin); // silences the parser too
}

// number = (digit {digit} ["." {digit}] | "." digit {digit}) [("e" | "E") ["+" | "-"] digit {digit}] [suffix]
// (a sign without digits behind is taken too, for its message)
//        | "0" ("x" | "X") hex_digit {hex_digit} [suffix]
// suffix = letter {letter | digit}, glued to the number: a unit, "f" or "u".
// A dot that is followed by another dot begins a range: "0..1" is 0, "..", 1.
void Lexer::number()
{
    const uint32_t begin = at;
    const bool hex = text[at] == '0' && (peek(1) == 'x' || peek(1) == 'X');
    if (!hex) {
        while (is_digit(peek())) ++at;
        if (peek() == '.' && peek(1) != '.') {
            ++at;
            while (is_digit(peek())) ++at;
        }
        const uint32_t sign = peek(1) == '+' || peek(1) == '-' ? 1 : 0;
        if ((peek() == 'e' || peek() == 'E') && (sign == 1 || is_digit(peek(1)))) { // no unit ends with e
            at += 1 + sign;
            while (is_digit(peek())) ++at;
        }
    }
    while (is_name_part(peek()) || static_cast<unsigned char>(peek()) >= 0x80)
        ++at; // the suffix; "µm" too, for its message
    push(Token::number, begin);
}

void Lexer::string()
{
    const uint32_t begin = at++;
    while (!at_line_end() && text[at] != '"') ++at;
    if (peek() == '"' && at < text.size()) {
        ++at;
        push(Token::string, begin);
        return;
    }
    diagnostics.error({file, begin, begin + 1}, "open-string",
                      "this string is not closed: expected '\"' before the end of the line");
    push(Token::invalid, begin);
}

bool Lexer::symbol()
{
    for (const auto& [token, spelling] : spellings_with(text[at])) {
        if (spelling.size() > 1 && !rest().starts_with(spelling)) continue;
        const uint32_t begin = at;
        at += static_cast<uint32_t>(spelling.size());
        push(token, begin);
        return true;
    }
    return false;
}

void Lexer::unexpected()
{
    const uint32_t begin = at;
    const CodePoint point = decode_utf8(text, at);
    const bool is_text = point.value != invalid_code_point, is_ascii = point.value < 0x80;
    at += point.length;
    const Span first = span_from(begin);
    const std::string message = "unexpected character '" + printable(text.substr(begin, point.length)) + "'";
    const auto lookalike = std::ranges::find(lookalikes, point.value, &Lookalike::character);
    if (lookalike != std::end(lookalikes)) {
        const bool is_space = lookalike->meant == " ";
        diagnostics
            .error(first, "unexpected-character", is_space ? "unexpected no-break space" : message,
                   is_space ? "write an ordinary space" : "write " + std::string(lookalike->meant))
            .fix = FixIt{first, std::string(lookalike->meant)};
    } else {
        // One report for a whole run: binary garbage and text in another script would drown the rest.
        while (at < text.size() && static_cast<unsigned char>(text[at]) >= 0x80) ++at;
        const bool is_quote = text[begin] == '\'' || text[begin] == '`';
        if (is_text)
            diagnostics.error(first, "unexpected-character", message,
                              is_quote    ? "strings are written with double quotes"
                              : !is_ascii ? "names are made of a-z, A-Z, 0-9 and _; anything may stand in comments"
                                          : "");
        else
            diagnostics.error(first, "not-text", "this is not UTF-8 text");
    }
    push(Token::invalid, begin);
}

std::string_view describe(Token token)
{
    static constexpr std::string_view descriptions[] = {
        "the end of the file", "something unreadable", "a name", "a number", "a string",
        "'#define'",           "the end of the line",
#define SYMBOL(name, spelling) "'" spelling "'",
#define KEYWORD(name, spelling) "'" spelling "'",
#include "lang/text/token.def"
#undef SYMBOL
#undef KEYWORD
    };
    return descriptions[static_cast<size_t>(token)];
}

TokenList lex(const SourceSet& sources, uint32_t file, Diagnostics& diagnostics, size_t room)
{
    const std::string& text = sources.file(file).text;
    const auto refuse = [&](uint32_t begin, uint32_t end, ErrorCode code, const char* message, const char* hint) {
        diagnostics.error({file, begin, end}, code, message, hint);
        return TokenList{{{Token::invalid, begin, begin}, {Token::end, begin, begin}}, {}, 0};
    };
    if (text.size() > text_bytes_max) return refuse(0, 0, "too-large", "this file is larger than 64 MiB", "");
    if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF"))
        return refuse(0, 2, "not-text", "this file is UTF-16, expected UTF-8", "save it as UTF-8 in your editor");
    if (const auto garbage = first_of_garbage(text))
        return refuse(*garbage, *garbage + 1, "not-text", "this file is not text, expected UTF-8",
                      "is it the right file, and saved as UTF-8?");
    const uint32_t begin = text.starts_with("\xEF\xBB\xBF") ? 3 : 0; // behind a byte-order mark
    return Lexer(text, {file, begin, static_cast<uint32_t>(text.size())}, diagnostics, room).run();
}

TokenList lex(const SourceSet& sources, Span part, Diagnostics& diagnostics)
{
    return Lexer(sources.file(part.file).text, part, diagnostics, tokens_max).run();
}

} // namespace haptel::lang
