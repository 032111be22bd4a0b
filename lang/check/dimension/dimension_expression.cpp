// Dimensions of expressions that call nothing.
#include "lang/check/dimension/dimension_checker.h"

namespace haptel::lang {

using namespace ast;

namespace {

// An operand of '*' or '/' as it stands.
bool binds_tightly(const Expression& e)
{
    if (!is_open(e)) return true;
    auto chain = std::get_if<Chain>(&e.node);
    return chain && (chain->rest.front().op == BinaryOp::multiply || chain->rest.front().op == BinaryOp::divide);
}

// A number to whose end a unit may be written.
bool takes_unit(std::string_view text)
{
    return !text.empty() && text.back() >= '0' && text.back() <= '9' && text.find_first_of("xX") == text.npos;
}

std::string mismatch(BinaryOp op, Dimension left, Dimension right)
{
    const std::string a = description(left), b = description(right);
    if (op == BinaryOp::add) return "cannot add " + b + " to " + a;
    if (op == BinaryOp::subtract) return "cannot subtract " + b + " from " + a;
    return "cannot compare " + a + " with " + b;
}

} // namespace

const Expression* bare_number(const Expression& e)
{
    if (auto unary = std::get_if<Unary>(&e.node)) return bare_number(*unary->operand);
    auto literal = std::get_if<NumberLiteral>(&e.node);
    return literal && literal->unit.empty() ? &e : nullptr;
}

Dimension DimensionBody::expression(const Expression& e)
{
    if (owner.nesting >= dimension_nesting_limit || !owner.spend(1)) return Dimension::any();
    ++owner.nesting;
    const Dimension found = std::visit([&](const auto& node) { return find(e, node); }, e.node);
    --owner.nesting;
    // Whole numbers and truth values count: only the literal 0 may stand for a length too.
    const bool counts = e.type == int_type || e.type == uint_type || e.type == bool_type;
    return counts && !bare_number(e) ? Dimension::plain() : found;
}

Dimension DimensionBody::find(const Expression&, const ErrorExpression&)
{
    return Dimension::any();
}

Dimension DimensionBody::find(const Expression&, const NumberLiteral& node)
{
    const bool is_zero = node.kind == NumberLiteral::Kind::real ? node.value == 0 : node.integer == 0;
    return is_zero && node.unit.empty() ? Dimension::any() : dimension_of_unit(node.unit);
}

Dimension DimensionBody::find(const Expression&, const BoolLiteral&)
{
    return Dimension::plain();
}

Dimension DimensionBody::find(const Expression& e, const NameExpression& node)
{
    if (!node.symbol) return Dimension::any();
    const Symbol& symbol = *node.symbol;
    switch (symbol.kind) {
    case SymbolKind::input:
        switch (symbol.input) {
        case InputName::p:
        case InputName::center:
        case InputName::extent:
        case InputName::footprint: return Dimension::length();
        case InputName::time: return Dimension::time();
        case InputName::n:
        case InputName::uv: return Dimension::plain();
        }
        return Dimension::any();
    case SymbolKind::local: {
        Variable& variable = flow.variables[symbol.slot];
        if (!variable.is_mixed()) return variable.dimension;
        if (auto finding =
                report(e.span, "'" + node.name + "' is " + description(variable.dimension) +
                                   " on one path to here and " + description(variable.other) + " on another")) {
            finding->hint = "give it one dimension on every path, or another name to what differs";
            finding->related.push_back({variable.set, "here it is " + description(variable.dimension)});
            finding->related.push_back({variable.other_set, "here it is " + description(variable.other)});
        }
        variable = {};
        return Dimension::any();
    }
    case SymbolKind::constant:
    case SymbolKind::table:
    case SymbolKind::texture_parameter: {
        const auto known = owner.symbols.find(&symbol);
        return known == owner.symbols.end() ? Dimension::any() : known->second;
    }
    case SymbolKind::function: break;
    }
    return Dimension::any();
}

Dimension DimensionBody::find(const Expression&, const Unary& node)
{
    return expression(*node.operand);
}

Dimension DimensionBody::find(const Expression& e, const Chain& node)
{
    Dimension left = expression(*node.first);
    const Expression* first = node.first.get();
    for (const Chain::Link& link : node.rest) {
        const Dimension right = expression(*link.operand);
        const Span whole{e.span.file, node.first->span.begin, link.operand->span.end};
        left = binary(link.op, left, right, whole, first, *link.operand);
        first = nullptr;
    }
    return left;
}

Dimension DimensionBody::binary(BinaryOp op, Dimension left, Dimension right, Span whole, const Expression* left_side,
                                const Expression& right_side)
{
    using enum BinaryOp;
    if (op == multiply) return left * right;
    if (op == divide) return left / right;
    const bool adds = op == add || op == subtract;
    const bool compares =
        op == less || op == less_equal || op == greater || op == greater_equal || op == equal || op == not_equal;
    if (!adds && !compares) return Dimension::plain(); // of whole numbers and truth values
    const auto both = join(left, right);
    if (!both)
        if (auto finding = report(whole, mismatch(op, left, right))) {
            if (left_side && bare_number(*left_side))
                propose(*finding, *left_side, right, left);
            else
                propose(*finding, right_side, left, right);
        }
    if (compares) return Dimension::plain();
    return both.value_or(Dimension::any());
}

Dimension DimensionBody::find(const Expression& e, const Conditional& node)
{
    expression(*node.condition);
    const Dimension a = expression(*node.when_true), b = expression(*node.when_false);
    const auto both = join(a, b);
    if (!both)
        if (auto finding = report(e.span, "both sides of ':' must have one dimension, found " + description(a) +
                                              " and " + description(b))) {
            const bool mend_first = bare_number(*node.when_true) != nullptr;
            propose(*finding, mend_first ? *node.when_true : *node.when_false, mend_first ? b : a, mend_first ? a : b);
        }
    return both.value_or(Dimension::any());
}

Dimension DimensionBody::find(const Expression&, const Member& node)
{
    return expression(*node.object);
}

Dimension DimensionBody::find(const Expression&, const Index& node)
{
    expression(*node.index);
    return expression(*node.object);
}

Dimension DimensionBody::find(const Expression&, const BraceList& node)
{
    return common(node.elements, "a table");
}

Dimension DimensionBody::common(const std::vector<ExpressionPtr>& parts, const std::string& what)
{
    Dimension all = Dimension::any();
    for (const ExpressionPtr& part : parts) {
        const Dimension found = expression(*part);
        const auto both = join(all, found);
        if (!both)
            if (auto finding = report(part->span, what + " has one dimension, found " + description(all) + " and " +
                                                      description(found)))
                propose(*finding, *part, all, found);
        all = both.value_or(all);
    }
    return all;
}

// ---- findings

DimensionFinding* DimensionBody::report(Span span, std::string message)
{
    if (is_library) {
        instance.is_at_fault = true;
        return nullptr;
    }
    instance.findings.push_back({span, std::move(message), {}, {}});
    return &instance.findings.back();
}

void DimensionBody::report_expected(const std::string& who, const Expression& e, Dimension expected, Dimension found,
                                    const std::string& where)
{
    std::string message = who + " " + description(expected) + where + ", got " + description(found);
    const std::string advice = expected.is_plain() ? advice_to_plain(found) : std::string{};
    if (!advice.empty()) message += ": " + advice;
    if (auto finding = report(e.span, std::move(message))) propose(*finding, e, expected, found);
}

// Which wavelength or unit is meant is for the author to say.
void DimensionBody::propose(DimensionFinding& finding, const Expression& e, Dimension expected, Dimension found)
{
    const std::string text(owner.sources.text(e.span));
    if (expected.is_plain()) {
        const std::string factor = factor_to_plain(found);
        if (factor.empty()) return;
        const std::string fixed = (binds_tightly(e) ? text : "(" + text + ")") + factor;
        finding.changes_body = true;
        finding.hint = "write " + printable(fixed) + ", with the quantity you mean instead of " + factor.substr(3);
        return;
    }
    if (!found.is_plain()) return;
    const std::string unit(literal_unit(expected));
    const Expression* literal = bare_number(e);
    if (literal && !unit.empty()) {
        const std::string number(owner.sources.text(literal->span));
        finding.hint = "give the number a unit";
        if (!takes_unit(number)) return;
        finding.changes_body = true;
        finding.hint += ": " + number + unit + ", if that is what it means";
    } else if (expected == Dimension::length()) {
        finding.hint = "multiply it by a length, for example 50um";
    } else if (expected == Dimension::time()) {
        finding.hint = "multiply it by a time, for example 1s";
    }
}

} // namespace haptel::lang
