// Lines of other shading languages' preprocessor; see directive.h.
#include "lang/text/lexing.h"

#include <algorithm>
#include <optional>
#include <utility>

namespace haptel::lang {

void Lexer::directive()
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

void Lexer::note_names(std::string_view line)
{
    for (size_t i = 0; i < line.size(); ++i) {
        if (!is_name_start(line[i])) continue;
        const size_t first = i;
        while (i < line.size() && is_name_part(line[i])) ++i;
        list.asked.insert(line.substr(first, i - first));
    }
}

void Lexer::refuse(Span where, std::string message, std::string_view hint)
{
    diagnostics.error(where, "preprocessor", std::move(message), hint);
}

bool Lexer::choose(Span where, std::string_view word, std::string_view line)
{
    const std::optional<bool> chosen = conditions.chosen(word, line.substr(0, line.find("//")));
    if (!chosen)
        refuse(where, "expected a condition of whole numbers after '#if'",
               "such as defined(A) && B > 2; or keep the lines that are meant, without it");
    return chosen.value_or(true);
}

// Takes it, with lines that continue it.
std::string_view Lexer::rest_of_line()
{
    const uint32_t begin = at;
    while (!at_line_end())
        if (!take_continuation()) ++at;
    return text.substr(begin, at - begin);
}

// A backslash and the end of the line behind it.
bool Lexer::take_continuation()
{
    if (peek() != '\\') return false;
    const uint32_t length = peek(1) == '\r' && peek(2) == '\n' ? 3 : peek(1) == '\n' || peek(1) == '\r' ? 2 : 0;
    at += length;
    return length > 0;
}

// To behind the "#else", the "#elif" that is chosen or the "#endif" of the innermost open choice.
void Lexer::skip_choice()
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
void Lexer::undefinition(Span where, std::string_view line)
{
    const size_t first = line.find_first_not_of(" \t");
    if (first == line.npos || !is_name_start(line[first])) return refuse(where, "expected a name after '#undef'", "");
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
void Lexer::definition(Span where)
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

} // namespace haptel::lang
