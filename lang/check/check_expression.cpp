// Types of expressions.
#include "lang/check/body_checker.h"
#include "lang/check/type_hint.h"
#include "lang/syntax/foreign.h"
#include "lang/syntax/operators.h"
#include "lang/text/number.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace haptel::lang {

using namespace ast;

bool converts(const Expression& e, Type wanted)
{
    return converts_implicitly(e.type, wanted) ||
           (e.type == int_type && wanted == uint_type && std::holds_alternative<NumberLiteral>(e.node));
}

void adopt_literal(Expression& e, Type wanted)
{
    if (wanted == uint_type && converts(e, wanted)) e.type = uint_type;
}

// That goes with each component, where the other operand is a vector.
Type operand_type(Type other)
{
    return other.is_vector() ? other.element() : other;
}

Type BodyChecker::expression(Expression& e)
{
    e.type = std::visit([&](auto& node) { return check(e, node); }, e.node);
    return e.type;
}

Type BodyChecker::fail(Span span, ErrorCode code, std::string message, std::string_view hint)
{
    diagnostics.error(span, code, std::move(message), hint);
    return Type::error();
}

std::string BodyChecker::excerpt(const Expression& e) const
{
    std::string text = printable(context.sources.text(e.span));
    return text.size() <= 32 ? text : "x";
}

std::string BodyChecker::operand(const Expression& e) const
{
    const std::string text = excerpt(e);
    return is_open(e) && text != "x" ? "(" + text + ")" : text;
}

void BodyChecker::require(Expression& e, Type wanted, const std::string& where)
{
    adopt_literal(e, wanted);
    if (e.type.is_error() || wanted.is_error())
        diagnostics.count_consequence();
    else if (!converts(e, wanted))
        diagnostics.error(e.span, "type-mismatch",
                          "expected " + to_string(wanted) + where + ", found " + to_string(e.type),
                          conversion_hint(e.type, wanted, excerpt(e), operand(e)));
}

// "0.142857142857", which in GLSL is the float nearest to 1 / 7, and here is less than that: floor(7.0 * x) is another
// number. 0: it is no such fraction, or as near to one as numbers are here.
static int denominator_meant(const NumberLiteral& node)
{
    constexpr int most = 1024;
    const size_t first = std::min(node.text.find_first_of("123456789"), node.text.size());
    const auto digits = std::ranges::count_if(node.text.substr(first), is_digit); // that count
    if (!node.unit.empty() || digits < 9 || node.value <= 1.0 / most || node.value > 0.5) return 0;
    const auto whole = static_cast<int>(std::lround(1 / node.value));
    int odd = whole; // what is left of 2 and 5 has endless decimals
    for (const int factor : {2, 5})
        while (odd % factor == 0) odd /= factor;
    const bool is_float = static_cast<float>(node.value) == static_cast<float>(1.0 / whole);
    const bool is_as_near = std::fabs(node.value * whole - 1) < 1e-15;
    return odd > 1 && is_float && !is_as_near ? whole : 0;
}

Type BodyChecker::check(Expression& e, NumberLiteral& node)
{
    if (const int whole = node.kind == NumberLiteral::Kind::real ? denominator_meant(node) : 0) {
        const std::string meant = "1.0 / " + std::to_string(whole) + ".0";
        diagnostics
            .note(e.span, "near-fraction",
                  quoted(node.text) + " is " + meant + " in the precision of GLSL, and a little " +
                      (node.value * whole < 1 ? "less" : "more") +
                      " here: floor() of what it multiplies may be another number",
                  "write (" + meant + ")")
            .fix = FixIt{e.span, "(" + meant + ")"};
    }
    if (node.kind == NumberLiteral::Kind::real) return float_type;
    const bool is_unsigned = node.kind == NumberLiteral::Kind::unsigned_integer;
    const bool is_bits = node.text.starts_with("0x") || node.text.starts_with("0X");
    if (node.integer > (is_unsigned || is_bits ? uint64_t{UINT32_MAX} : uint64_t{INT32_MAX}))
        return fail(e.span, "number",
                    quoted(node.text) + " does not fit into " + (is_unsigned ? "uint" : "int") + ", which has 32 bits",
                    is_unsigned ? "the largest is 4294967295u" : "write " + node.text + ".0 for a float");
    return is_unsigned ? uint_type : int_type;
}

// A name that is read, at least some parts of it.
Type BodyChecker::read(Expression& e, NameExpression& node, uint64_t parts)
{
    const Symbol* symbol = find(node.name);
    if ((!symbol || symbol->kind == SymbolKind::input) && may_be_unread(node.name)) {
        diagnostics.count_consequence();
        return Type::error();
    }
    mark_read(node.name);
    if (symbol ? symbol->kind == SymbolKind::function : !scope.functions(node.name).empty())
        return fail(e.span, "not-a-value", quoted(node.name) + " is a function, expected a value",
                    "call it: " + node.name + "(...)");
    if (!symbol && node.name == "_")
        return fail(e.span, "open-argument",
                    "'_' stands for an argument of a function that is passed, expected a value",
                    "a function that is passed stands as it is: fbm(cellular(_, 0.2), q, 4, 2.0, 0.5)");
    if (!symbol) {
        report_unknown_name(e.span, node.name);
        return Type::error();
    }
    node.symbol = symbol;
    if (symbol->kind == SymbolKind::input) reads |= 1u << static_cast<uint32_t>(symbol->input);
    if (symbol->type.is_error()) diagnostics.count_consequence();
    if (symbol->kind != SymbolKind::local || symbol->type.is_error()) return symbol->type;

    uint64_t& assigned = flow.variables[symbol->slot].assigned;
    const uint64_t whole = parts_of(symbol->type), missing = whole & parts & ~assigned;
    const bool has_some = assigned & whole;
    if (!missing) return symbol->type;
    assigned = whole;      // one report is enough
    if (in_damaged_body) { // most likely what assigns it could not be read
        diagnostics.count_consequence();
        return Type::error();
    }
    if (!(missing & ~symbol->parts_assigned)) {
        diagnostics.warning(e.span, "perhaps-unassigned",
                            quoted(node.name) + " is read here and has no value on some path: it is 0 there",
                            symbol->type.is_array() || symbol->is_parameter
                                ? "give it one first"
                                : "give it one where it is declared: " + to_string(symbol->type) + " " + node.name +
                                      " = " + zero_of(symbol->type) + ";");
        return symbol->type;
    }
    const std::string part = has_some ? part_name(symbol->type, static_cast<uint32_t>(std::countr_zero(missing))) : "";
    const std::string type = to_string(symbol->type), count = std::to_string(symbol->type.array_size);
    diagnostics
        .error(e.span, "unassigned", quoted(node.name + part) + " is read here before it has a value on every path",
               symbol->type.has_rows() ? "give each element one, in a loop over rows and one over the elements of a row"
               : symbol->type.is_array() ? "give each element one: for (int i = 0; i < " + count + "; ++i) " +
                                               node.name + "[i] = " + zero_of(symbol->type.element()) + ";"
                                         : "give it one where it is declared: " + type + " " + node.name + " = " +
                                               zero_of(symbol->type) + ";")
        .related.push_back({symbol->span, quoted(node.name) + " is declared here"});
    return symbol->type;
}

Type BodyChecker::check(Expression& e, Unary& node)
{
    auto literal = std::get_if<NumberLiteral>(&node.operand->node);
    if (literal && node.op == UnaryOp::negate && literal->kind == NumberLiteral::Kind::integer &&
        literal->integer == uint64_t{INT32_MAX} + 1) {
        node.operand->type = int_type; // -2147483648 is an int, though 2147483648 is none
        return int_type;
    }
    const Type type = expression(*node.operand);
    if (type.is_error()) return type;
    switch (node.op) {
    case UnaryOp::negate:
    case UnaryOp::plus:
        if (type.is_numeric() && !type.is_array()) return type;
        return fail(e.span, "type-mismatch",
                    (node.op == UnaryOp::negate ? "'-'" : "'+'") + std::string(" expects a number, found ") +
                        to_string(type),
                    type.is_array()    ? "an array is used by its elements: a[i]"
                    : type.is_struct() ? "a struct is used by its members, as ." + type.structure->members.front().name
                                       : "write !x for a bool");
    case UnaryOp::logical_not:
        if (type == bool_type) return type;
        return fail(
            e.span, "type-mismatch", "'!' expects bool, found " + to_string(type),
            type.is_vector() && type.scalar == Scalar::bool_ ? "of each component: not(" + excerpt(*node.operand) + ")"
            : !type.is_scalar()                              ? "compare its components"
                                : "compare: " + operand(*node.operand) + (type == float_type ? " == 0.0" : " == 0"));
    case UnaryOp::bit_not:
        if (type.is_whole() && !type.is_array()) return type;
        return fail(e.span, "type-mismatch", "'~' expects int or uint, found " + to_string(type),
                    type == bool_type ? "write !x for a bool" : "bits are those of int or uint");
    }
    return Type::error();
}

// Left to right and flat: a chain may have tens of thousands of links.
Type BodyChecker::check(Expression&, Chain& node)
{
    Type left = expression(*node.first);
    for (Chain::Link& link : node.rest) {
        const uint32_t may_be_left_out = link.op == BinaryOp::logical_and || link.op == BinaryOp::logical_or ? 1 : 0;
        choice_depth += may_be_left_out;
        const Type right = expression(*link.operand);
        choice_depth -= may_be_left_out;
        if (left.is_error() || right.is_error()) {
            left = Type::error();
            continue; // the other operands deserve their messages
        }
        adopt_literal(*link.operand, operand_type(left));
        if (&link == &node.rest.front()) {
            adopt_literal(*node.first, operand_type(right));
            left = node.first->type;
            warn_of_whole_division(*node.first, link);
        }
        const auto types = operator_types(link.op, left, link.operand->type);
        left = types ? types->result
                     : report_operator(link.op, join(node.first->span, link.operand->span), left, *link.operand);
    }
    return left;
}

// "1 / 2 * depth" is flat.
void BodyChecker::warn_of_whole_division(const Expression& dividend, const Chain::Link& link)
{
    const auto whole = [](const Expression& e) -> const NumberLiteral* {
        const auto* literal = std::get_if<NumberLiteral>(&e.node);
        return literal && (e.type == int_type || e.type == uint_type) ? literal : nullptr;
    };
    const NumberLiteral *a = whole(dividend), *b = whole(*link.operand);
    const Type by = link.operand->type;
    if (link.op == BinaryOp::divide && a && a->integer == 1 && !b && (by == int_type || by == uint_type)) // "1 / i"
        diagnostics.warning(join(dividend.span, link.operand->span), "whole-division",
                            "whole numbers are divided without a rest: this is 0 beyond 1",
                            "write 1.0 / " + printable(context.sources.text(link.operand->span)));
    if (link.op != BinaryOp::divide || !a || !b || b->integer == 0 || a->integer % b->integer == 0) return;
    diagnostics.warning(join(dividend.span, link.operand->span), "whole-division",
                        "whole numbers are divided without a rest: this is " + std::to_string(a->integer / b->integer),
                        "write " + std::to_string(a->integer) + ".0 / " + std::to_string(b->integer) + ".0");
}

Type BodyChecker::report_operator(BinaryOp op, Span span, Type left, const Expression& right)
{
    return fail(span, "type-mismatch",
                std::string(describe(operator_of(op).token)) + " does not take " + to_string(left) + " and " +
                    to_string(right.type),
                operator_hint(op, left, right.type));
}

Type BodyChecker::check(Expression& e, Conditional& node)
{
    condition(node.condition, "before '?'");
    ++choice_depth;
    const Type a = expression(*node.when_true), b = expression(*node.when_false);
    --choice_depth;
    if (a.is_error() || b.is_error()) return Type::error();
    if (a == image_type && b == image_type)
        return fail(e.span, "image", "an image cannot be chosen by '?:'",
                    "choose between what is read of them: c ? sample(a, q) : sample(b, q)");
    if (a == b) return a;
    if (converts_implicitly(a, b)) return b;
    if (converts_implicitly(b, a)) return a;
    return fail(e.span, "type-mismatch",
                "both sides of ':' must have one type, found " + to_string(a) + " and " + to_string(b),
                conversion_hint(b, a, excerpt(*node.when_false), operand(*node.when_false)));
}

// The parts that "[...][column]" may pick of an array of arrays, whose rows are all that is known; of others all.
uint64_t BodyChecker::column_of(const Expression& object, int64_t column) const
{
    auto name = std::get_if<NameExpression>(&object.node);
    const Symbol* symbol = name ? find(name->name) : nullptr;
    if (!symbol || !symbol->type.has_rows() || symbol->type.cell_count() > 64) return all_parts;
    uint64_t parts = 0;
    for (uint32_t row = 0; row < symbol->type.array_size; ++row)
        if (column >= 0 && column < symbol->type.row_size)
            parts |= uint64_t{1} << (row * symbol->type.row_size + static_cast<uint32_t>(column));
    return parts;
}

Type BodyChecker::check(Expression& e, Index& node)
{
    auto name = std::get_if<NameExpression>(&node.object->node);
    const uint64_t columns = std::exchange(columns_read, all_parts);
    const Type index = expression(*node.index); // first: it says which part is read
    const Symbol* symbol = name ? find(name->name) : nullptr;
    const ir::IntRange at = range(*node.index);
    const bool is_one_part = symbol && is_integer(index) && at.is_constant();
    const uint64_t parts = (is_one_part ? parts_at(symbol->type, at.minimum) : all_parts) & columns;
    if (auto row = std::get_if<Index>(&node.object->node); row && is_integer(index) && at.is_constant())
        columns_read = column_of(*row->object, at.minimum);
    const Type object = node.object->type = name ? read(*node.object, *name, parts) : expression(*node.object);
    if (object.is_error()) return object;
    if (object.is_scalar() || object.is_struct())
        return fail(e.span, "not-indexable",
                    quoted(excerpt(*node.object)) + " is a " + to_string(object) +
                        ", expected an array, a matrix or a vector before '['");
    const Type element = object.element();
    if (!is_integer(index)) {
        require(*node.index, int_type, " as an index");
        return element;
    }
    // Certain mistakes only: what cannot be proven in range is clamped in code.
    if (at.maximum >= 0 && at.minimum < object.element_count()) return element;
    const std::string of_what = excerpt(*node.object), count = std::to_string(object.element_count()),
                      last = std::to_string(object.element_count() - 1);
    std::string found = std::to_string(at.minimum);
    if (!at.is_constant()) found += " .. " + std::to_string(at.maximum);
    Diagnostic& reported =
        diagnostics.error(node.index->span, "index-out-of-range",
                          "index " + found + " is outside " + quoted(of_what) + ", expected 0 .. " + last,
                          "counted from 0, the last of " + count + " is " + of_what + "[" + last + "]");
    if (symbol && symbol->span.end > 0)
        reported.related.push_back({symbol->span, quoted(name->name) + " is declared here"});
    return element;
}

} // namespace haptel::lang
