// Statements.
#include "lang/syntax/grammar.h"
#include "lang/syntax/operators.h"

#include <algorithm>

namespace haptel::lang {

using namespace ast;

// statement = macro | block | if | for | while | switch | "break" ";" | "continue" ";" | return | declaration
//           | assignment | ";"
// Appends none, one, or, for "float a, b;", several.
void Grammar::statement(Statements& into)
{
    lost = false;
    const Span first = span();
    const size_t first_position = position, first_made = into.size();
    if (accept(Token::semicolon) || skip_precision()) return;
    skip_foreign_qualifiers();
    read_misspelt_keyword();
    if (at(Token::define)) {
        definition();
    } else if (at(Token::left_brace)) {
        into.push_back(block());
    } else if (at(Token::kw_if)) {
        into.push_back(if_statement());
    } else if (at(Token::kw_for)) {
        into.push_back(for_statement());
    } else if (text() == "while" && kind(1) == Token::left_paren) {
        into.push_back(while_statement());
    } else if (at(Token::kw_switch)) {
        into.push_back(switch_statement());
    } else if (at(Token::kw_return)) {
        into.push_back(return_statement());
    } else if (accept(Token::kw_break)) {
        expect_semicolon("'break'");
        into.push_back(make_statement(since(first), Break{}));
    } else if (accept(Token::kw_continue)) {
        expect_semicolon("'continue'");
        into.push_back(make_statement(since(first), Continue{}));
    } else if (at(Token::kw_case) || at(Token::kw_default)) {
        error(first, "switch", "this '" + std::string(text()) + "' belongs to no 'switch'",
              "cases stand right inside the braces of a switch");
        advance();
        skip_to({Token::colon});
        accept(Token::colon);
        lost = false;
    } else if (at(Token::kw_struct)) {
        skip_foreign_declaration("a struct is declared outside of functions and textures",
                                 "move it to the top of the file", "struct");
        note_unread(first_position);
    } else if (at(Token::kw_else)) {
        error(first, "else-without-if", "this 'else' belongs to no 'if'",
              "an 'if' with several statements needs braces around them");
        advance();
        into.push_back(single_statement("'else'"));
    } else if (const ForeignWord* word = foreign_word(ForeignKind::statement, text()); word && !is_used_as_name()) {
        foreign_statement(*word, into);
    } else if (word = foreign_word(ForeignKind::declaration, text()); word && kind(1) == Token::name) {
        skip_foreign_declaration(not_in_haptel(), word->hint);
    } else if (at_declaration()) {
        declarations(into);
    } else {
        into.push_back(assignment_or_expression());
        if (!lost) expect_semicolon("the statement");
    }
    if (lost) {
        find_footing();
        forget(std::span(into).subspan(first_made));
        note_unread(first_position);
        stand_again();
    }
    if (position == first_position) advance();
}

// "default = 2;": a word that only other languages reserve.
bool Grammar::is_used_as_name() const
{
    return is_assignment(kind(1)) || kind(1) == Token::dot || kind(1) == Token::plus_plus ||
           kind(1) == Token::minus_minus;
}

// A function or texture begins here: a '}' must be missing above.
bool Grammar::at_top_level_start() const
{
    if (at_texture_or_import()) return true;
    if (kind() != Token::name || kind(1) != Token::name || kind(2) != Token::left_paren) return false;
    const size_t closer = closer_ahead(2);
    return kind(closer) == Token::right_paren && kind(closer + 1) == Token::left_brace;
}

// block = "{" {statement} "}"
StatementPtr Grammar::block()
{
    const Span opener = span();
    const Nesting nesting(*this, Nesting::bracket);
    advance();
    return rest_of_block(opener);
}

// Behind '{'.
StatementPtr Grammar::rest_of_block(Span opener)
{
    Scope scope;
    while (!at(Token::right_brace) && !at(Token::end) && !at_top_level_start()) statement(scope.statements);
    if (!accept(Token::right_brace)) {
        lost = false;
        const bool is_news = sources.text(opener) == "{" && !has_stray_brace; // or else enough has been said
        if (is_news) report_unclosed(Token::right_brace, opener);
        is_misshapen = true;
    }
    return make_statement(since(opener), std::move(scope));
}

// The body of an if or for: one statement, or several from one declaration, which are then a scope.
StatementPtr Grammar::single_statement(std::string_view after)
{
    const Span first = span();
    if (at(Token::left_brace)) return block();
    if (at(Token::semicolon) && !lost) {
        Diagnostic& reported = diagnostics.warning(first, "empty-body", "nothing stands after " + std::string(after),
                                                   "leave this ';' out, or write {} where nothing is meant");
        if (kind(1) == Token::left_brace) reported.fix = FixIt{first, ""};
    }
    if (at(Token::right_brace) || at(Token::end)) {
        error(first, "syntax", "expected a statement after " + std::string(after) + found());
        return make_statement(first, Scope{});
    }
    const Nesting nesting(*this, Nesting::bracket);
    Scope scope;
    statement(scope.statements);
    if (scope.statements.size() == 1) return std::move(scope.statements.front());
    return make_statement(since(first), std::move(scope));
}

// if = "if" "(" expression ")" statement {"else" "if" "(" expression ")" statement} ["else" statement]
StatementPtr Grammar::if_statement()
{
    const Span first = span();
    If result;
    do {
        If::Arm arm;
        const bool has_condition = accept(Token::kw_if); // not behind the last "else"
        if (has_condition) {
            const Span opener = span();
            const bool opened = expect(Token::left_paren, "after 'if'");
            arm.condition = expression();
            if (opened)
                close(Token::right_paren, opener);
            else
                accept(Token::right_paren);
            if (lost) arm.condition = unknown(arm.condition->span);
        }
        arm.body = single_statement(has_condition ? "the condition" : "'else'");
        result.arms.push_back(std::move(arm));
        if (!has_condition) break;
    } while (read_foreign_else() || accept(Token::kw_else));
    return make_statement(since(first), std::move(result));
}

// for = "for" "(" [declaration | assignment] ";" [expression] ";" [assignment] ")" statement
StatementPtr Grammar::for_statement()
{
    const Span first = span();
    const size_t first_position = position;
    advance();
    For loop;
    const Span opener = span();
    const auto end_part = [&](std::string_view part) {
        if (lost) skip_to({Token::right_paren});
        if (accept(Token::semicolon)) return;
        error(span(), "syntax", "expected ';' after the " + std::string(part) + " of the loop" + found(),
              "write for (int i = 0; i < count; i++)");
    };
    if (expect(Token::left_paren, "after 'for'")) {
        if (at_declaration()) {
            Statements made;
            declaration_list(made);
            if (made.size() > 1)
                error(made[1]->span, "syntax", "a loop has one variable, found a second",
                      "declare the others above the loop");
            if (!made.empty()) loop.init = std::move(made.front());
        } else if (!at(Token::semicolon)) {
            loop.init = assignment_or_expression();
        }
        end_part("start");
        if (!at(Token::semicolon) && !at(Token::right_paren)) loop.condition = expression();
        end_part("condition");
        if (!at(Token::right_paren)) loop.step = assignment_or_expression();
        if (at(Token::comma) && !lost)
            error(span(), "syntax", "a loop has one step, found a second", "put the others at the end of its body");
        while (!close(Token::right_paren, opener) && accept(Token::semicolon)) {
        }
    }
    if (lost) {
        if (loop.init) forget({&loop.init, 1});
        if (loop.condition) loop.condition = unknown(loop.condition->span);
        note_unread(first_position);
    }
    loop.body = single_statement("the loop's head");
    return make_statement(since(first), std::move(loop));
}

// while = "/// @bound" number  "while" "(" expression ")" statement
// Stands for "for (int turn = 0; turn < bound; ++turn) { if (!(expression)) break; statement }".
StatementPtr Grammar::while_statement()
{
    const Span first = span();
    ExpressionPtr bound = bound_before(position);
    if (!bound) {
        error(first, "unbounded-loop", "cannot tell how often this loop runs",
              "write /// @bound 64 above it: it then ends after 64 turns at the latest");
        lost = false;
        bound = unknown(first);
    }
    advance();
    const Span opener = span();
    advance();
    ExpressionPtr condition = expression();
    close(Token::right_paren, opener);
    if (lost) condition = unknown(condition->span);
    const Span head = condition->span;
    Scope turn;
    If::Arm ends{make(head, Unary{UnaryOp::logical_not, std::move(condition)}), make_statement(head, Break{})};
    If leave;
    leave.arms.push_back(std::move(ends));
    turn.statements.push_back(make_statement(head, std::move(leave)));
    turn.statements.push_back(single_statement("the loop's head"));

    const Name counter{" turn", first}; // which nobody can write
    const auto number = [&](uint64_t value) {
        return make(first, NumberLiteral{NumberLiteral::Kind::integer, 0, value, {}, std::to_string(value)});
    };
    const auto name_of_counter = [&] { return make(first, NameExpression{counter.text}); };
    For loop;
    loop.init = make_statement(first, Declaration{false, {{"int", first}, false, nullptr}, counter, number(0)});
    Chain compared{name_of_counter(), {}};
    compared.rest.push_back({BinaryOp::less, first, std::move(bound)});
    loop.condition = make(first, std::move(compared));
    loop.step = make_statement(first, Assignment{name_of_counter(), BinaryOp::add, first, number(1)});
    loop.body = make_statement(since(first), std::move(turn));
    return make_statement(since(first), std::move(loop));
}

// return = "return" [expression] ";"
StatementPtr Grammar::return_statement()
{
    const Span first = span();
    advance();
    Return result;
    if (!at(Token::semicolon) && !at(Token::right_brace)) result.value = expression();
    if (!lost) expect_semicolon("'return'");
    return make_statement(since(first), std::move(result));
}

// assignment = postfix ("=" | "+=" | ...) expression | postfix ("++" | "--") | ("++" | "--") postfix
// Without its ';': it may stand in the head of a loop.
StatementPtr Grammar::assignment_or_expression()
{
    const Span first = span();
    Assignment made;
    const auto step = [&] { // "++" and "--"
        if (!at(Token::plus_plus) && !at(Token::minus_minus)) return false;
        made.op_span = span();
        made.op = at(Token::plus_plus) ? BinaryOp::add : BinaryOp::subtract;
        made.value = make(made.op_span, NumberLiteral{NumberLiteral::Kind::integer, 1, 1, {}, "1"});
        advance();
        return true;
    };
    if (step()) {
        made.target = postfix();
        return make_statement(since(first), std::move(made));
    }
    constexpr Token starts[] = {Token::name,  Token::number, Token::kw_true, Token::kw_false, Token::left_paren,
                                Token::minus, Token::plus,   Token::bang,    Token::tilde,    Token::invalid};
    if (std::ranges::find(starts, kind()) == std::end(starts)) error(first, "syntax", "expected a statement" + found());
    made.target = conditional();
    if (is_assignment(kind())) {
        made.op_span = span();
        made.op = operation_in(kind());
        advance();
        const size_t value = position;
        made.value = conditional();
        if (is_assignment(kind()) && !lost) return chained(std::move(made), first, value);
    } else if (!step()) {
        const Span whole = made.target->span;
        return make_statement(whole, ExpressionStatement{std::move(made.target)});
    }
    return make_statement(since(first), std::move(made));
}

// "a = b = 0.0": first the one on the right, which is then read from its target.
StatementPtr Grammar::chained(Assignment left, Span first, size_t value)
{
    const Nesting nesting(*this, Nesting::bracket);
    if (at(Token::end)) return make_statement(first, Scope{}); // it nests too deep
    position = value;
    Scope both;
    both.statements.push_back(assignment_or_expression());
    const size_t behind = position;
    if (!at(Token::end)) {
        position = value;
        left.value = conditional();
        position = behind;
    }
    const Span whole = since(first);
    both.statements.push_back(make_statement(whole, std::move(left)));
    return make_statement(whole, std::move(both));
}

// A type is followed by a name: "vec3 q", "float[3] a", "const ...". A type's own word is enough ("float = 1" is a
// slip).
bool Grammar::at_declaration() const
{
    if (at(Token::kw_const)) return true;
    if (!at(Token::name)) return false;
    const bool is_cut_off = kind(3) == Token::name && kind(4) == Token::name; // "q.x" and, without a ';', "float y"
    const size_t behind = at_prefixed_type() && !is_cut_off ? 3 : 1;
    if (kind(behind) == Token::name) return true;
    if (kind(behind) == Token::left_bracket) {
        size_t closer = closer_ahead(behind);
        if (kind(closer) == Token::right_bracket && kind(closer + 1) == Token::left_bracket)
            closer = closer_ahead(closer + 1);
        return kind(closer) == Token::right_bracket && kind(closer + 1) == Token::name;
    }
    return is_own_type(text()) && kind(1) != Token::left_paren && kind(1) != Token::dot;
}

// declaration = ["const"] type declarator {"," declarator} ";"
// declarator = name ["[" [expression] "]"] ["=" initializer]          initializer = expression | brace_list
void Grammar::declarations(Statements& into)
{
    declaration_list(into);
    if (!lost) expect_semicolon("the declaration");
}

// An expression; in "float a = b = 0.0" what is assigned on the way stands before.
ExpressionPtr Grammar::initializer(Statements& before)
{
    const size_t first = position;
    ExpressionPtr value = conditional();
    read_decimal_comma();
    if (!is_assignment(kind()) || lost) return value;
    position = first;
    before.push_back(assignment_or_expression());
    if (at(Token::end)) return value;
    const size_t behind = position;
    position = first;
    value = conditional();
    position = behind;
    return value;
}

void Grammar::declaration_list(Statements& into)
{
    const Span first = span();
    const bool is_const = accept(Token::kw_const);
    read_type_behind_name(false);
    TypeName type = type_name();
    do {
        const Span begin = into.empty() ? first : span();
        Name name = name_after(type);
        Declaration made{is_const, type, std::move(name), nullptr};
        if (made.name.text.empty()) return;
        array_suffix(made.type);
        if (accept(Token::assign)) made.initializer = at(Token::left_brace) ? brace_list() : initializer(into);
        into.push_back(make_statement(since(begin), std::move(made)));
    } while (!lost && accept(Token::comma));
}

} // namespace haptel::lang
