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

std::string described(Type type)
{
    return type.is_struct()   ? "a struct"
           : type.is_array()  ? "an array"
           : type.is_matrix() ? "a matrix"
           : type.is_vector() ? "a vector"
                              : "a number";
}

Dimension DimensionBody::expression(const Expression& e)
{
    if (owner.nesting >= dimension_nesting_limit || !owner.spend(1)) return Dimension::any();
    ++owner.nesting;
    const Dimension found = find(e);
    --owner.nesting;
    // Whole numbers and truth values count: only the literal 0 may stand for a length too.
    const bool counts = e.type.is_whole() || e.type.scalar == Scalar::bool_;
    return counts && !bare_number(e) ? Dimension::plain() : found;
}

Dimension DimensionBody::find(const Expression& e)
{
    if (auto name = std::get_if<NameExpression>(&e.node)) return read(*name->symbol, e.span);
    if (auto list = std::get_if<BraceList>(&e.node)) return common(list->elements, "a table");
    if (auto unary = std::get_if<Unary>(&e.node)) return expression(*unary->operand);
    if (auto member = std::get_if<Member>(&e.node)) return expression(*member->object);
    if (auto grad = std::get_if<GradCall>(&e.node))
        return call(e, grad->function.text, grad->target, grad->arguments, grad->order);
    if (auto left_out = std::get_if<LeftOut>(&e.node))
        return left_out->parameter->value ? expression(*left_out->parameter->value) : Dimension::any();
    if (auto made = std::get_if<CallExpression>(&e.node)) {
        for (const auto& [input, value] : made->inputs) {
            const BuiltinInput& read = builtin_inputs[static_cast<size_t>(input)];
            const Dimension found = expression(*value), expected = dimension_of_unit(read.unit);
            if (!join(found, expected))
                report_expected("the input '" + std::string(read.name) + "' is", *value, expected, found);
        }
        return made->target.is_constructor ? constructor(e, *made)
                                           : call(e, made->callee.text, made->target, made->arguments, 0);
    }
    if (auto index = std::get_if<Index>(&e.node)) {
        expression(*index->index);
        return expression(*index->object);
    }
    if (auto literal = std::get_if<NumberLiteral>(&e.node)) {
        const bool is_zero = literal->kind == NumberLiteral::Kind::real ? literal->value == 0 : literal->integer == 0;
        return is_zero && literal->unit.empty() ? Dimension::any() : dimension_of_unit(literal->unit);
    }
    if (auto chain = std::get_if<Chain>(&e.node)) {
        Dimension left = expression(*chain->first);
        const Expression* first = chain->first.get();
        for (const Chain::Link& link : chain->rest) {
            const Span whole = join(chain->first->span, link.operand->span);
            left = binary(link.op, left, expression(*link.operand), whole, first, *link.operand);
            first = nullptr;
        }
        return left;
    }
    if (auto choice = std::get_if<Conditional>(&e.node)) {
        expression(*choice->condition);
        const Dimension a = expression(*choice->when_true), b = expression(*choice->when_false);
        const auto both = join(a, b);
        if (!both)
            report(e.span,
                   "both sides of ':' must have one dimension, found " + description(a) + " and " + description(b),
                   bare_number(*choice->when_true) ? proposal(*choice->when_true, b, a)
                                                   : proposal(*choice->when_false, a, b));
        return both.value_or(Dimension::any());
    }
    return Dimension::plain(); // a truth value
}

Dimension DimensionBody::read(const Symbol& symbol, Span span)
{
    if (symbol.kind == SymbolKind::input)
        return dimension_of_unit(builtin_inputs[static_cast<size_t>(symbol.input)].unit);
    if (symbol.kind != SymbolKind::local) {
        const auto known = owner.symbols.find(&symbol);
        return known == owner.symbols.end() ? Dimension::any() : known->second;
    }
    Variable& variable = (*flow)[symbol.slot];
    if (!variable.is_mixed()) return variable.first.dimension;
    const std::string one = description(variable.first.dimension), other = description(variable.other.dimension);
    report(span, "'" + symbol.name + "' is " + one + " on one path to here and " + other + " on another",
           {"give it one dimension on every path, or another name to what differs"},
           {{variable.first.span, "here it is " + one}, {variable.other.span, "here it is " + other}});
    variable = {};
    return Dimension::any();
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
        report(whole, mismatch(op, left, right),
               left_side && bare_number(*left_side) ? proposal(*left_side, right, left)
                                                    : proposal(right_side, left, right));
    return compares ? Dimension::plain() : both.value_or(Dimension::any());
}

Dimension DimensionBody::common(const std::vector<ExpressionPtr>& parts, const std::string& what)
{
    Dimension all = Dimension::any();
    for (const ExpressionPtr& part : parts) {
        const Dimension found = expression(*part);
        const auto both = join(all, found);
        if (!both)
            report(part->span, what + " has one dimension, found " + description(all) + " and " + description(found),
                   proposal(*part, all, found));
        all = both.value_or(all);
    }
    return all;
}

// That of its default; a default of 0 says nothing, then its range does.
Dimension DimensionBody::parameter(const CheckedParameter& parameter)
{
    const TextureParameter& tree = *parameter.tree;
    Dimension dimension = Dimension::any();
    for (const Expression* e : {tree.value.get(), tree.minimum.get(), tree.maximum.get()}) {
        if (!e) continue;
        const Dimension found = expression(*e);
        const auto both = join(dimension, found);
        if (!both)
            report_expected("the range of '" + tree.name.text + "' must be", *e, dimension, found,
                            " as its default is");
        dimension = both.value_or(dimension);
    }
    return dimension.is_any() ? Dimension::plain() : dimension;
}

// ---- findings

void DimensionBody::report(Span span, std::string message, DimensionHint hint, std::vector<Related> related)
{
    if (is_library)
        instance.is_at_fault = true;
    else
        instance.findings.push_back({span, std::move(message), std::move(hint), std::move(related)});
}

void DimensionBody::report_expected(const std::string& who, const Expression& e, Dimension expected, Dimension found,
                                    const std::string& where)
{
    std::string message = who + " " + description(expected) + where + ", got " + description(found);
    const std::string advice = expected.is_plain() ? advice_to_plain(found) : std::string{};
    report(e.span, message + (advice.empty() ? "" : ": " + advice), proposal(e, expected, found));
}

// Which wavelength or unit is meant is for the author to say.
DimensionHint DimensionBody::proposal(const Expression& e, Dimension expected, Dimension found) const
{
    const auto text_of = [&](const Expression& part) { return std::string(owner.sources.text(part.span)); };
    if (expected.is_plain()) {
        const std::string factor = factor_to_plain(found);
        if (factor.empty()) return {};
        const std::string fixed = (binds_tightly(e) ? text_of(e) : "(" + text_of(e) + ")") + factor;
        return {"write " + printable(fixed) + ", with the quantity you mean instead of " + factor.substr(3), true};
    }
    if (!found.is_plain()) return {};
    const std::string unit(literal_unit(expected));
    if (const Expression* literal = bare_number(e); literal && !unit.empty()) {
        const std::string number = text_of(*literal), hint = "give the number a unit";
        if (!takes_unit(number)) return {hint};
        return {hint + ": " + number + unit + ", if that is what it means", true};
    }
    if (expected == Dimension::length()) return {"multiply it by a length, for example 50um"};
    if (expected == Dimension::time()) return {"multiply it by a time, for example 1s"};
    return {};
}

} // namespace haptel::lang
