// What is written as in another language, or misspelt: said once, with what to write, and read as it was meant.
#include "lang/syntax/grammar.h"
#include "lang/text/near_name.h"

#include <algorithm>

namespace haptel::lang {

using namespace ast;

// "static const float A", "highp float x": words before a type.
void Grammar::skip_foreign_qualifiers()
{
    while (at(Token::name) && (kind(1) == Token::name || kind(1) == Token::kw_const)) {
        const ForeignWord* word = foreign_word(ForeignKind::qualifier, text());
        const bool stands_before_type = kind(2) == Token::name ||
                                        (kind(2) == Token::left_bracket && is_type_word(text(1))) ||
                                        kind(2) == Token::less || kind(1) == Token::kw_const;
        if (!word || !stands_before_type) return; // "flat x": a type that is misspelt
        if (word->replacement.empty())
            diagnostics.note(span(), "no-effect", "'" + std::string(text()) + "' changes nothing here", word->hint)
                .fix = FixIt{{file, span().begin, span(1).begin}, ""};
        else
            slip(span(), "foreign-word", not_in_haptel(), word->hint).fix =
                FixIt{span(), std::string(word->replacement)};
        advance();
    }
}

// "vec3<f32>"
void Grammar::skip_type_arguments()
{
    if (!at(Token::less) || kind(1) != Token::name || kind(2) != Token::greater) return;
    const Span whole = join(span(), span(2));
    Diagnostic& reported = slip(whole, "foreign-word", "types take no arguments in angle brackets",
                                "write float, vec3, mat3 ...; precision is chosen when the texture is compiled");
    const ForeignWord* argument = foreign_word(ForeignKind::type, text(1));
    const bool is_real = text(1) == "float" || (argument && argument->replacement == "float");
    if (is_real) reported.fix = FixIt{whole, ""};
    advance(3);
}

// "retrun 1.0;": a word that nothing else explains is read as the keyword it resembles.
void Grammar::read_misspelt_keyword()
{
    if (!at(Token::name) || text().size() < 2 || is_type_word(text()) || is_used_as_name() ||
        kind(1) == Token::left_bracket)
        return;
    constexpr std::pair<std::string_view, Token> keywords[] = {
        {"return", Token::kw_return}, {"if", Token::kw_if},       {"else", Token::kw_else},
        {"for", Token::kw_for},       {"break", Token::kw_break}, {"continue", Token::kw_continue},
        {"const", Token::kw_const}};
    // Between a name that is misspelt and a type that is, the nearer decides.
    std::vector<std::string_view> words(std::begin(own_types), std::end(own_types));
    for (const auto& [word, token] : keywords) words.push_back(word);
    const auto [meant, is_only] = near_name(text(), words);
    const auto keyword = std::ranges::find(keywords, meant, &std::pair<std::string_view, Token>::first);
    if (keyword == std::end(keywords) || foreign_word(ForeignKind::statement, text())) return;
    // What follows must be able to follow the keyword, and be no use of a name.
    const Token next = kind(1), then = keyword->second;
    const bool fits = then == Token::kw_if || then == Token::kw_for           ? next == Token::left_paren
                      : then == Token::kw_break || then == Token::kw_continue ? next == Token::semicolon
                      : then == Token::kw_const                               ? next == Token::name
                      : then == Token::kw_else
                          ? next != Token::left_paren && next != Token::semicolon
                          : next == Token::name || next == Token::number || next == Token::left_paren ||
                                next == Token::minus || next == Token::kw_true || next == Token::kw_false;
    if (!fits) return;
    Diagnostic& reported =
        slip(span(), "syntax", "expected a statement" + found(), "did you mean '" + std::string(meant) + "'?");
    if (is_only) reported.fix = FixIt{span(), std::string(meant)};
    list.tokens[position].kind = then;
}

// "float depth = 1mm if 0mm .. 2mm", ": 0mm .. 2mm": behind the default.
void Grammar::read_misspelt_in()
{
    if (at(Token::colon) && (kind(1) == Token::number || kind(1) == Token::minus) && !lost) {
        slip(span(), "syntax", "expected 'in', ',' or ')'" + found(), "a range is written in 0.2mm .. 5mm").fix =
            FixIt{span(), "in"};
        list.tokens[position].kind = Token::kw_in;
        return;
    }
    const bool is_word = (at(Token::name) && !is_type_word(text())) || at(Token::kw_if);
    if (lost || !is_word || near_name(text(), {"in"}).name.empty()) return;
    const Span word = span();
    list.tokens[position].kind = Token::kw_in;
    error(word, "syntax", "expected 'in', ',' or ')'" + found(), "did you mean 'in'?").fix = FixIt{word, "in"};
    lost = false;
}

// "[[ float min = 0 ]]", as in OSL: behind the default.
void Grammar::skip_metadata()
{
    if (!at(Token::left_bracket) || kind(1) != Token::left_bracket || lost) return;
    const Span first = span();
    while (!at(Token::end) && !at(Token::left_brace) && !(at(Token::right_bracket) && kind(1) == Token::right_bracket))
        advance();
    if (!at(Token::right_bracket)) return;
    advance(2);
    slip(since(first), "foreign-word", "there are no [[ ]] in Haptel",
         "a range stands behind the default, in 0mm .. 5mm, and what a parameter means in a comment before it, ///");
}

// "x: f32", "var x: f32": from now on "f32 x".
void Grammar::read_type_behind_name(bool is_told)
{
    const size_t word = text() == "var" || text() == "let" ? 1 : 0;
    if (kind(word) != Token::name || kind(word + 1) != Token::colon || kind(word + 2) != Token::name) return;
    const ForeignWord* foreign = foreign_word(ForeignKind::type, text(word + 2));
    const std::string meant(foreign && !foreign->replacement.empty() ? foreign->replacement : text(word + 2));
    const std::string written = meant + " " + std::string(text(word));
    const Span whole = join(span(), span(word + 2));
    if (!is_told) slip(whole, "foreign-word", "the type comes first", "write " + written).fix = FixIt{whole, written};
    told_type = span(word + 2).begin;
    const auto here = list.tokens.begin() + static_cast<std::ptrdiff_t>(position + word);
    const bool has_arguments = kind(word + 3) == Token::less && kind(word + 5) == Token::greater; // "vec3<f32>"
    std::rotate(here, here + 1, here + (has_arguments ? 6 : 3));
    advance(word + 1);
}

// "fn f(x: f32) -> f32", "function float f(float x)": before the result. Whether types stand behind names.
bool Grammar::skip_word_of_function()
{
    const ForeignWord* word = foreign_word(ForeignKind::type, text());
    if (!word || word != foreign_word(ForeignKind::type, "fn") || kind(1) != Token::name) return false;
    if (text() == "def") { // of a language without braces: nothing that follows is read
        error(span(), "foreign-word", not_in_haptel(), word->hint);
        return false;
    }
    if (kind(2) != Token::name) return true;
    slip(span(), "foreign-word", not_in_haptel(), word->hint).fix = FixIt{{file, span().begin, span(1).begin}, ""};
    advance();
    return false;
}

// "float depth = 1,5mm", behind the 1.
void Grammar::read_decimal_comma()
{
    const bool is_one = previous_kind() == Token::number && at(Token::comma) && kind(1) == Token::number && !lost;
    if (!is_one || previous_span().end != span().begin || span().end != span(1).begin) return;
    const std::string meant = std::string(sources.text(previous_span())) + "." + std::string(text(1));
    slip(join(previous_span(), span(1)), "syntax", "decimals stand behind a point", "write " + meant).fix =
        FixIt{span(), "."};
    advance(2);
}

// "a and b"; nothing but an operator can stand here.
void Grammar::read_foreign_operator()
{
    const ForeignWord* word = at(Token::name) ? foreign_word(ForeignKind::operation, text()) : nullptr;
    if (!word || lost) return;
    slip(span(), "foreign-word", not_in_haptel(), word->hint).fix = FixIt{span(), std::string(word->replacement)};
    list.tokens[position].kind = word->replacement == "&&"   ? Token::logical_and
                                 : word->replacement == "||" ? Token::logical_or
                                 : word->replacement == "^^" ? Token::logical_xor
                                                             : Token::bang;
}

// "elif (b)", behind the body of an if: from now on an "if".
bool Grammar::read_foreign_else()
{
    if (!at(Token::name) || kind(1) != Token::left_paren) return false;
    if (text() != "elif" && text() != "elsif" && text() != "elseif") return false;
    slip(span(), "foreign-word", not_in_haptel(), "write else if").fix = FixIt{span(), "else if"};
    list.tokens[position].kind = Token::kw_if;
    return true;
}

// "50 um", at the unit.
ExpressionPtr Grammar::parted_number(Span number)
{
    const Span whole = join(number, span());
    const std::string written = std::string(sources.text(number)) + std::string(text());
    slip(whole, "syntax", "a unit stands right behind its number", "write " + written).fix = FixIt{whole, written};
    advance();
    const Number read = read_number(written);
    return make(whole, NumberLiteral{read.kind, read.value, read.integer, std::string(read.unit), written});
}

// "in [0um, 200um]", at the bracket.
void Grammar::bracketed_range(TextureParameter& parameter)
{
    const Span opener = span();
    advance();
    parameter.minimum = binary(1);
    if (!accept(Token::comma)) expect(Token::dot_dot, "in the range");
    parameter.maximum = binary(1);
    if (!close(Token::right_bracket, opener) || lost) return;
    const std::string written = std::string(sources.text(parameter.minimum->span)) + " .. " +
                                std::string(sources.text(parameter.maximum->span));
    slip(since(opener), "range", "a range stands in no brackets", "write " + printable(written)).fix =
        FixIt{since(opener), written};
}

// "(float)x", at the opening bracket.
ExpressionPtr Grammar::cast()
{
    const Span first = span();
    Name type{std::string(text(1)), span(1)};
    advance(3);
    ExpressionPtr operand = unary();
    const Span whole = since(first);
    const std::string written = type.text + "(" + std::string(sources.text(operand->span)) + ")";
    slip(whole, "foreign-word", "a value is converted by the type's constructor", "write " + printable(written)).fix =
        FixIt{whole, written};
    std::vector<ExpressionPtr> arguments;
    arguments.push_back(std::move(operand));
    return make(whole, CallExpression{std::move(type), std::move(arguments)});
}

// "q.length()", at the bracket behind the member.
ExpressionPtr Grammar::method_call(ExpressionPtr object)
{
    const Span first = object->span;
    Member& member = std::get<Member>(object->node);
    std::string written = member.member.text + "(" + std::string(sources.text(member.object->span));
    Name callee = std::move(member.member);
    std::vector<ExpressionPtr> values;
    values.push_back(std::move(member.object));
    advance();
    for (ExpressionPtr& argument : arguments()) {
        written += ", " + std::string(sources.text(argument->span));
        values.push_back(std::move(argument));
    }
    const Span whole = since(first);
    if (!lost)
        diagnostics.error(whole, "not-callable", "values have no functions of their own",
                          "write " + printable(written + ")")); // GLSL's q.length() counts components
    ++mistakes;
    return make(whole, CallExpression{std::move(callee), std::move(values)});
}

// "precision highp float;"
bool Grammar::skip_precision()
{
    if (text() != "precision" || kind(1) != Token::name || kind(2) != Token::name || kind(3) != Token::semicolon)
        return false;
    const Span whole = join(span(), span(3));
    diagnostics
        .note(whole, "no-effect", "'precision' changes nothing here",
              foreign_word(ForeignKind::declaration, "precision")->hint)
        .fix = FixIt{whole, ""};
    advance(4);
    return true;
}

// "class S {...};", "uniform float x;", "in vec2 uv;": says what to write, skips the whole.
void Grammar::skip_foreign_declaration(std::string message, std::string_view hint, ErrorCode code)
{
    error(span(), code, std::move(message), hint);
    advance();
    skip_to({Token::left_brace});
    if (at(Token::left_brace)) skip_braces();
    while (at(Token::name) && !on_new_line()) advance(); // "class S {...} s;"
    accept(Token::semicolon);
    lost = false;
}

// "do {...} while (...);", "goto end;": says what to write. A loop's body, which may never run, is still read for its
// own mistakes.
void Grammar::foreign_statement(const ForeignWord& word, Statements& into)
{
    error(span(), "foreign-word", not_in_haptel(), word.hint);
    const bool is_loop = text() == "do";
    advance();
    const Span head = since(span());
    if (at(Token::left_paren)) {
        advance(closer_ahead(0));
        accept(Token::right_paren);
    }
    if (is_loop) {
        lost = false;
        If::Arm arm;
        arm.condition = unknown(head);
        arm.body = single_statement("the loop's head");
        If loop;
        loop.arms.push_back(std::move(arm));
        into.push_back(make_statement(since(head), std::move(loop)));
        if (at(Token::name) && text() == "while") advance(), skip_to({});
    } else {
        skip_to({});
    }
    accept(Token::semicolon);
    lost = false;
}

} // namespace haptel::lang
