#include "lang/emit_c/words.h"

#include "lang/emit/shortest.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace haptel::emit_c {

namespace {

// Of C23 and C++23, and what <math.h> and <stdint.h> may define as macros.
constexpr std::string_view reserved[] = {"alignas",      "alignof",   "and",
                                         "and_eq",       "asm",       "auto",
                                         "bitand",       "bitor",     "bool",
                                         "break",        "case",      "catch",
                                         "char",         "char16_t",  "char32_t",
                                         "char8_t",      "class",     "co_await",
                                         "co_return",    "co_yield",  "compl",
                                         "concept",      "const",     "const_cast",
                                         "consteval",    "constexpr", "constinit",
                                         "continue",     "decltype",  "default",
                                         "delete",       "do",        "double",
                                         "dynamic_cast", "else",      "enum",
                                         "explicit",     "export",    "extern",
                                         "false",        "float",     "for",
                                         "friend",       "goto",      "head",
                                         "if",           "inline",    "int",
                                         "isfinite",     "isinf",     "isnan",
                                         "isnormal",     "linux",     "long",
                                         "mutable",      "namespace", "new",
                                         "noexcept",     "not",       "not_eq",
                                         "nullptr",      "operator",  "or",
                                         "or_eq",        "private",   "protected",
                                         "public",       "register",  "reinterpret_cast",
                                         "requires",     "restrict",  "return",
                                         "short",        "signbit",   "signed",
                                         "sizeof",       "static",    "static_assert",
                                         "static_cast",  "struct",    "switch",
                                         "template",     "this",      "thread_local",
                                         "throw",        "true",      "try",
                                         "typedef",      "typeid",    "typename",
                                         "typeof",       "union",     "unix",
                                         "unsigned",     "using",     "virtual",
                                         "void",         "volatile",  "wchar_t",
                                         "while",        "xor",       "xor_eq"};

} // namespace

std::string literal(double value, bool is_single)
{
    const double held = is_single ? static_cast<float>(value) : value;
    if (std::isnan(held)) return is_single ? "NAN" : "(double)NAN";
    const std::string infinite = is_single ? "HUGE_VALF" : "HUGE_VAL";
    const std::string text = std::isinf(held)
                                 ? (held < 0 ? "-" : "") + infinite
                                 : (is_single ? emit::shortest(static_cast<float>(held)) + "F" : emit::shortest(held));
    return std::signbit(held) ? "(" + text + ")" : text;
}

std::string literal(uint32_t word)
{
    return std::to_string(word) + "u";
}

std::string quoted(std::string_view text)
{
    std::string literal = "\"";
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        if (byte >= ' ' && byte < 127 && c != '"' && c != '\\' && c != '?') { // ??/ was a backslash once
            literal += c;
            continue;
        }
        literal += '\\';
        for (const int shift : {6, 3, 0}) literal += static_cast<char>('0' + (byte >> shift & 7));
    }
    return literal + '"';
}

std::string in_comment(std::string_view text, std::string_view margin)
{
    std::string comment;
    for (const char c : text) {
        const bool would_end =
            !comment.empty() && ((comment.back() == '*' && c == '/') || (comment.back() == '/' && c == '*'));
        if (would_end) comment += ' ';
        if (c == '\n')
            comment.append("\n").append(margin);
        else
            comment += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
    }
    return comment;
}

std::string member_name(const ir::Texture& texture, const ir::Parameter& parameter)
{
    std::string name = parameter.name;
    std::ranges::replace(name, '.', '_');
    const auto is_taken = [&](const ir::Parameter& other) { return &other != &parameter && other.name == name; };
    if (std::ranges::binary_search(reserved, name)) name += '_';
    while (std::ranges::any_of(texture.parameters, is_taken)) name += '_';
    return name;
}

} // namespace haptel::emit_c
