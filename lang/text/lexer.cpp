#include "lang/text/lexer.h"

#include "lang/text/directive.h"
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

constexpr uint8_t index_of(char c)
{
    return static_cast<uint8_t>(c);
}

constexpr bool is_space(char c)
{
    return c == ' ' || (c >= '\t' && c <= '\r'); // '\n', '\v' and '\f' between them
}

bool is_name_start(char c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}
constexpr auto name_parts = [] {
    std::array<bool, 256> is_part{};
    for (const char c : std::string_view("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_"))
        is_part[index_of(c)] = true;
    return is_part;
}();
bool is_name_part(char c)
{
    return name_parts[index_of(c)];
}

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

class Lexer {
public:
    Lexer(std::string_view file_text, Span part, Diagnostics& sink, size_t max)
        : text(file_text.substr(0, part.end)), file(part.file), at(part.begin), diagnostics(sink), room(max)
    {
    }

    TokenList run()
    {
        list.tokens.reserve(std::min<size_t>(text.size() / 4, 1 << 16)); // as texts go
        while (at < text.size() && !diagnostics.full()) next();
        for (const Conditions::Open& left : conditions.open)
            diagnostics.error({file, left.begin, left.end}, "preprocessor",
                              "this choice is never ended: expected '#endif' before the end of the file");
        list.tokens.push_back({Token::end, size(), size()});
        return std::move(list);
    }

private:
    void next()
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

    std::string_view rest() const { return text.substr(at); }
    char peek(uint32_t ahead = 0) const { return at + ahead < text.size() ? text[at + ahead] : '\0'; }
    uint32_t size() const { return static_cast<uint32_t>(text.size()); }
    bool at_line_end() const { return at >= text.size() || text[at] == '\n' || text[at] == '\r'; }

    Span span_from(uint32_t begin) const { return {file, begin, at}; }

    void push(Token kind, uint32_t begin)
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
    bool has_room(uint32_t begin)
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

    static Token keyword_or_name(std::string_view word)
    {
        for (const auto& [token, spelling] : spellings_with(word[0]))
            if (word == spelling) return token;
        return Token::name;
    }

    void line_comment()
    {
        const uint32_t begin = at;
        const bool doc = rest().starts_with("///") && !rest().starts_with("////");
        const std::string_view line = rest().substr(0, rest().find('\n'));
        at += static_cast<uint32_t>(std::min(line.size(), line.find('\r')));
        if (has_room(begin) && doc) list.docs.push_back({span_from(begin), static_cast<uint32_t>(list.tokens.size())});
    }

    void block_comment()
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
    void number()
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

    void string()
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

    // A line of other shading languages' preprocessor; see directive.h.
    void directive()
    {
        list.has_directives = true;
        const uint32_t begin = at++;
        while (peek() == ' ' || peek() == '\t') ++at; // "# define"
        const uint32_t name_begin = at;
        while (is_name_part(peek())) ++at;
        const Span where = span_from(begin);
        const std::string word = "#" + std::string(text.substr(name_begin, at - name_begin));
        if (word == "#define") return definition(where);
        const std::string_view line = rest_of_line();
        if (word.starts_with("#if") || word == "#elif" || word == "#undef") note_names(line);
        if (word == "#ifdef" || word == "#ifndef" || word == "#if") {
            conditions.open.push_back({begin, where.end, choose(where, word, line)});
            if (!conditions.open.back().is_taken) skip_choice();
        } else if (word == "#else" || word == "#elif" || word == "#endif") {
            if (conditions.open.empty())
                refuse(where, "'" + word + "' belongs to no '#if' above", "leave it out");
            else if (word == "#endif")
                conditions.open.pop_back();
            else
                skip_choice(); // what stands above was taken
        } else if (word == "#undef") {
            undefinition(where, line);
        } else if (word == "#version" || word == "#extension" || word == "#pragma" || word == "#line") {
            diagnostics.note(where, "directive", "'" + word + "' changes nothing here", "leave the line out").fix =
                FixIt{span_from(begin), ""};
        } else {
            refuse(where, "Haptel has no '" + word + "'",
                   word == "#include" ? "write import \"file.haptel\"; what it imports must be Haptel too"
                                      : "leave this line out");
        }
    }

    void note_names(std::string_view line)
    {
        for (size_t i = 0; i < line.size(); ++i) {
            if (!is_name_start(line[i])) continue;
            const size_t first = i;
            while (i < line.size() && is_name_part(line[i])) ++i;
            list.asked.insert(line.substr(first, i - first));
        }
    }

    void refuse(Span where, std::string message, std::string_view hint)
    {
        diagnostics.error(where, "preprocessor", std::move(message), hint);
    }

    bool choose(Span where, std::string_view word, std::string_view line)
    {
        const std::optional<bool> chosen = conditions.chosen(word, line.substr(0, line.find("//")));
        if (!chosen)
            refuse(where, "expected a condition of whole numbers after '#if'",
                   "such as defined(A) && B > 2; or keep the lines that are meant, without it");
        return chosen.value_or(true);
    }

    // Takes it, with lines that continue it.
    std::string_view rest_of_line()
    {
        const uint32_t begin = at;
        while (!at_line_end())
            if (!take_continuation()) ++at;
        return text.substr(begin, at - begin);
    }

    // A backslash and the end of the line behind it.
    bool take_continuation()
    {
        if (peek() != '\\') return false;
        const uint32_t length = peek(1) == '\r' && peek(2) == '\n' ? 3 : peek(1) == '\n' || peek(1) == '\r' ? 2 : 0;
        at += length;
        return length > 0;
    }

    // To behind the "#else", the "#elif" that is chosen or the "#endif" of the innermost open choice.
    void skip_choice()
    {
        for (size_t inner = 0; at < text.size();) {
            while (at < text.size() && (is_space(text[at]))) ++at;
            const uint32_t begin = at;
            const std::string_view line = rest_of_line();
            const size_t comment = line.substr(0, line.find("//")).find("/*"), ended = line.rfind("*/");
            if (comment != line.npos && (ended == line.npos || ended < comment)) {
                const size_t end = text.find("*/", at);
                at = end == text.npos ? size() : static_cast<uint32_t>(end + 2);
            }
            if (!line.starts_with('#')) continue;
            const size_t name = std::min(line.size(), line.find_first_not_of(" \t", 1));
            const std::string_view word = line.substr(name);
            if (word.starts_with("if")) ++inner;
            if (word.starts_with("endif") && inner-- == 0) {
                conditions.open.pop_back();
                return;
            }
            bool& is_taken = conditions.open.back().is_taken;
            if (inner > 0 || is_taken || (!word.starts_with("else") && !word.starts_with("elif"))) continue;
            note_names(line);
            is_taken = word.starts_with("else") || choose({file, begin, at}, "#if", word.substr(4));
            if (is_taken) return;
        }
    }

    // "#undef NAME": a #define of nothing.
    void undefinition(Span where, std::string_view line)
    {
        const size_t first = line.find_first_not_of(" \t");
        if (first == line.npos || !is_name_start(line[first]))
            return refuse(where, "expected a name after '#undef'", "");
        size_t length = 1;
        while (first + length < line.size() && is_name_part(line[first + length])) ++length;
        conditions.undefine(line.substr(first, length));
        const uint32_t behind = std::exchange(at, where.end), name = where.end + static_cast<uint32_t>(first);
        push(Token::define, where.begin);
        at = name + static_cast<uint32_t>(length);
        push(Token::name, name);
        at = behind;
        push(Token::line_end, at);
    }

    // "#define NAME value": the line's own tokens, between two that mark it. Without a value it only tells "#ifdef".
    void definition(Span where)
    {
        const auto take_spaces = [&] {
            while (peek() == ' ' || peek() == '\t' || take_continuation())
                if (peek() == ' ' || peek() == '\t') ++at;
        };
        take_spaces();
        const uint32_t name_begin = at;
        if (is_name_start(peek()))
            while (is_name_part(peek())) ++at;
        const uint32_t name_end = at;
        if (name_begin == name_end) return refuse(where, "expected a name after '#define'", "#define WIDTH 0.5");
        const std::string_view name = text.substr(name_begin, name_end - name_begin);
        take_spaces();
        const uint32_t value = at;
        const bool is_empty = at_line_end() || rest().starts_with("//");
        const std::string_view line = rest_of_line();
        conditions.define(name, line.substr(0, line.find("//")));
        if (is_empty) return static_cast<void>(at = value);
        at = where.end;
        push(Token::define, where.begin);
        at = name_end;
        push(Token::name, name_begin);
        in_definition = true;
        while (!at_line_end() && !diagnostics.full())
            if (!take_continuation()) next();
        in_definition = false;
        push(Token::line_end, at);
    }

    bool symbol()
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

    void unexpected()
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

    std::string_view text; // of the whole file up to the end of the part
    uint32_t file;
    uint32_t at;
    Diagnostics& diagnostics;
    size_t room;
    TokenList list;
    Conditions conditions;
    bool in_definition = false;
};

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
