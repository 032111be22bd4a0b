// The class behind lex(): lexer.cpp has what a character begins, lex_directive.cpp lines that begin with '#'.
#pragma once

#include "lang/text/directive.h"
#include "lang/text/lexer.h"

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

namespace haptel::lang {

constexpr uint8_t index_of(char c)
{
    return static_cast<uint8_t>(c);
}

constexpr bool is_space(char c)
{
    return c == ' ' || (c >= '\t' && c <= '\r'); // '\n', '\v' and '\f' between them
}

constexpr bool is_name_start(char c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}
inline constexpr auto name_parts = [] {
    std::array<bool, 256> is_part{};
    for (const char c : std::string_view("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_"))
        is_part[index_of(c)] = true;
    return is_part;
}();
constexpr bool is_name_part(char c)
{
    return name_parts[index_of(c)];
}

class Lexer {
public:
    Lexer(std::string_view file_text, Span part, Diagnostics& sink, size_t max)
        : text(file_text.substr(0, part.end)), file(part.file), at(part.begin), diagnostics(sink), room(max)
    {
    }

    TokenList run();

private:
    // lexer.cpp
    void next();
    void push(Token kind, uint32_t begin);
    bool has_room(uint32_t begin);
    void line_comment();
    void block_comment();
    void number();
    void string();
    bool symbol();
    void unexpected();

    // lex_directive.cpp
    void directive();
    void note_names(std::string_view line);
    void refuse(Span where, std::string message, std::string_view hint);
    bool choose(Span where, std::string_view word, std::string_view line);
    std::string_view rest_of_line();
    bool take_continuation();
    void skip_choice();
    void undefinition(Span where, std::string_view line);
    void definition(Span where);

    std::string_view rest() const { return text.substr(at); }
    char peek(uint32_t ahead = 0) const { return at + ahead < text.size() ? text[at + ahead] : '\0'; }
    uint32_t size() const { return static_cast<uint32_t>(text.size()); }
    bool at_line_end() const { return at >= text.size() || text[at] == '\n' || text[at] == '\r'; }

    Span span_from(uint32_t begin) const { return {file, begin, at}; }

    std::string_view text; // of the whole file up to the end of the part
    uint32_t file;
    uint32_t at;
    Diagnostics& diagnostics;
    size_t room;
    TokenList list;
    Conditions conditions;
    bool in_definition = false;
};

} // namespace haptel::lang
