// #define, as other shading languages write constants and short functions: a name for an expression. Each use is read
// anew from the tokens of the value, and an argument from those where it is written, as if in parentheses; so a
// mistake is told where it stands.
#include "lang/syntax/grammar.h"
#include "lang/syntax/operators.h"
#include "lang/text/limits.h"

#include <algorithm>

namespace haptel::lang {

using namespace ast;

// macro = "#define" name ["(" [name {"," name}] ")"] {token} line_end        "(" stands right behind the name
void Grammar::definition()
{
    const Span first = span();
    advance();
    Macro made;
    made.name = span();
    const Name word{std::string(TokenCursor::text()), made.name};
    advance();
    made.takes_arguments = at(Token::left_paren) && span().begin == made.name.end;
    if (made.takes_arguments) {
        const Span opener = span();
        advance();
        while (at(Token::name)) {
            made.parameters.push_back(TokenCursor::text());
            advance();
            if (!accept(Token::comma)) break;
        }
        close(Token::right_paren, opener, true);
    }
    made.first = position;
    while (!at(Token::line_end) && !at(Token::end)) advance();
    made.end = position;
    const Span whole = since(first);
    accept(Token::line_end);
    leave_semicolon_out(made);
    if (made.first == made.end && !made.takes_arguments) {
        macros.erase(word.text);
        lost = false;
        return;
    }
    if (!lost) note_constant(whole, word, made);
    macros.insert_or_assign(sources.text(made.name), std::move(made));
    lost = false;
}

// "#define HALF(x) (0.5 * (x));": behind an expression it is one too many, wherever the name is used.
void Grammar::leave_semicolon_out(Macro& macro)
{
    const auto value = std::span(list.tokens).subspan(macro.first, macro.end - macro.first);
    const auto makes_statements = [](const PlacedToken& token) {
        return token.kind == Token::semicolon || token.kind == Token::left_brace || is_assignment(token.kind);
    };
    if (value.size() < 2 || value.back().kind != Token::semicolon ||
        std::ranges::any_of(value.first(value.size() - 1), makes_statements))
        return;
    const Span there{file, value.back().begin, value.back().end};
    diagnostics.note(there, "directive", "the ';' is read as none: a name stands for an expression", "leave it out")
        .fix = FixIt{there, ""};
    --macro.end;
}

// What is a constant of plain type is better written as one.
void Grammar::note_constant(Span whole, const Name& word, const Macro& macro)
{
    if (macro.takes_arguments || macro.first == macro.end) return;
    const PlacedToken& head = list.tokens[macro.first];
    const std::string_view begins = sources.text({file, head.begin, head.end});
    std::string type;
    if (head.kind == Token::number && macro.end == macro.first + 1) {
        const Number read = read_number(begins);
        const bool is_whole = read.kind != Number::Kind::real;
        if (read.error.empty()) type = !is_whole ? "float" : read.kind == Number::Kind::integer ? "int" : "uint";
    } else if (head.kind == Token::name && is_own_type(begins) && macro.first + 1 < macro.end) {
        size_t open = 0, end = macro.first + 1; // one constructor, as a whole
        do {
            if (opens(list.tokens[end].kind)) ++open;
            if (closes(list.tokens[end].kind) && open > 0) --open;
            ++end;
        } while (open > 0 && end < macro.end);
        if (end == macro.end && list.tokens[macro.first + 1].kind == Token::left_paren) type = begins;
    }
    // Its parts are numbers; the name means nothing else, nor anything above: a constant is one of the whole file.
    const auto is_plain = [&](const PlacedToken& token) {
        const bool is_sign =
            token.kind == Token::comma || token.kind == Token::minus || opens(token.kind) || closes(token.kind);
        return is_sign || token.kind == Token::number ||
               (token.kind == Token::name && is_own_type(sources.text({file, token.begin, token.end})));
    };
    const auto tokens = std::span(list.tokens);
    const auto is_name = [&](const PlacedToken& token) {
        return token.kind == Token::name && sources.text({file, token.begin, token.end}) == word.text;
    };
    const bool is_used_above = std::ranges::any_of(tokens.first(macro.first - 1), is_name);
    bool is_declared = false; // a name or a type stands before it
    for (size_t i = macro.end; i + 1 < tokens.size(); ++i)
        is_declared |= is_name(tokens[i + 1]) && (tokens[i].kind == Token::name || tokens[i].kind == Token::define);
    if (type.empty() || list.asked.contains(word.text) || is_used_above || is_declared) return;
    if (!std::ranges::all_of(tokens.subspan(macro.first, macro.end - macro.first), is_plain)) return;
    const std::string value(sources.text({file, head.begin, list.tokens[macro.end - 1].end}));
    if (value.find_first_of("\n\r") != value.npos) return;
    const std::string written = "const " + type + " " + word.text + " = " + value + ";";
    diagnostics
        .note(whole, "directive", "'" + word.text + "' is read as if its value stood at each use",
              "write " + printable(written))
        .fix = FixIt{whole, written};
}

// "#define float3 vec3": another word for one word.
std::string_view Grammar::alias_of(std::string_view word) const
{
    for (size_t steps = 0; steps <= macros.size() && alias_steps < tokens_max; ++steps, ++alias_steps) {
        const auto found = macros.find(word);
        if (found == macros.end() || found->second.takes_arguments || found->second.end != found->second.first + 1)
            break;
        const PlacedToken& value = list.tokens[found->second.first];
        if (value.kind != Token::name) break;
        word = sources.text({file, value.begin, value.end});
    }
    return word;
}

// The macro that is used here; null: none. Inside of its own value a name stands for itself.
Grammar::Macro* Grammar::macro_here()
{
    if (macros.empty() || !at(Token::name)) return nullptr;
    const auto found = macros.find(text());
    if (found == macros.end()) return nullptr;
    for (const Use* use = macro_use; use; use = use->around)
        if (use->macro == &found->second) return nullptr;
    return !found->second.takes_arguments || kind(1) == Token::left_paren ? &found->second : nullptr;
}

// What a parameter of the macro that is being read stands for; null: it is none.
const Grammar::Range* Grammar::argument_here() const
{
    if (!macro_use || !at(Token::name)) return nullptr;
    const auto& names = macro_use->macro->parameters;
    const auto found = std::ranges::find(names, TokenCursor::text());
    return found == names.end() ? nullptr : &macro_use->arguments[static_cast<size_t>(found - names.begin())];
}

ExpressionPtr Grammar::use_of(Macro& macro)
{
    const Span first = span();
    advance();
    Use use{&macro, {}, macro_use};
    if (macro.takes_arguments) {
        use.arguments = macro_arguments();
        const Span whole = since(first);
        if (lost) return unknown(whole);
        const size_t wanted = macro.parameters.size(), found = use.arguments.size();
        if (wanted != found) {
            diagnostics
                .error(whole, "wrong-argument-count",
                       "'" + std::string(sources.text(macro.name)) + "' takes " + std::to_string(wanted) +
                           (wanted == 1 ? " argument" : " arguments") + ", found " + std::to_string(found))
                .related.push_back({macro.name, "it is defined here"});
            ++mistakes;
            return unknown(whole);
        }
    }
    const size_t behind = position;
    const Span whole = since(first);
    ExpressionPtr made = read_range({macro.first, macro.end}, &use, "'" + std::string(sources.text(macro.name)) + "'");
    if (is_open(*made) && !std::exchange(macro.is_open, true))
        diagnostics.warning(
            macro.name, "open-macro",
            "the value of '" + std::string(sources.text(macro.name)) +
                "' has an operator outside of parentheses; each use counts as if it stood in parentheses",
            "write the parentheses");
    if (!at(Token::end)) position = behind; // else it nests too deep, and nothing more is read
    made->span = whole;
    return made;
}

// Behind the name: "(" [tokens {"," tokens}] ")"
std::vector<Grammar::Range> Grammar::macro_arguments()
{
    std::vector<Range> ranges;
    const Span opener = span();
    advance();
    if (accept(Token::right_paren)) return ranges;
    size_t open = 0;
    ranges.push_back({position, position});
    for (; !at(Token::end) && !at(Token::semicolon) && !at(Token::line_end); advance()) {
        if (open == 0 && (at(Token::right_paren) || at(Token::comma))) {
            ranges.back().end = position;
            if (accept(Token::right_paren)) return ranges;
            ranges.push_back({position + 1, position + 1});
            continue;
        }
        if (opens(kind())) ++open;
        if (closes(kind()) && open > 0) --open;
    }
    report_unclosed(Token::right_paren, opener, true);
    return ranges;
}

// An expression that takes the whole range.
ExpressionPtr Grammar::read_range(Range range, const Use* names, const std::string& what)
{
    const Span here = previous_span();
    const Nesting nesting(*this, Nesting::bracket);
    if (at(Token::end)) return unknown(here); // it nests too deep
    if ((macro_tokens += range.end - range.first + 1) > tokens_max) {
        error(here, "too-large", "macros make more than " + std::to_string(tokens_max) + " words and signs here");
        return unknown(here);
    }
    const Use* const outside = std::exchange(macro_use, names);
    position = range.first;
    ExpressionPtr made = expression();
    if (position != range.end && !lost)
        error(span(), "preprocessor", "expected an expression as the value of " + what + found(),
              "statements and types stand in functions");
    macro_use = outside;
    return made;
}

} // namespace haptel::lang
