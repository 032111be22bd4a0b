#include "lang/ir/derive/derivative_rules.h"

#include "lang/ir/op_info.h"
#include "lang/math/spline.h"

#include <algorithm>
#include <numbers>

namespace haptel::ir {
namespace {

// A real expression under construction, or an exact zero, which costs nothing and stays out of the code.
struct Term {
    Builder* builder;
    Tangent value;

    bool is_zero() const { return !value; }
    Value made() const { return value ? *value : builder->real(0); }
};

Term term(const Term& like, double constant)
{
    return {like.builder, like.builder->real(constant)};
}

template <typename... Terms>
Term apply(Op op, const Term& first, const Terms&... rest)
{
    return {first.builder, first.builder->operation(op, {first.made(), rest.made()...})};
}

Term operator-(const Term& a)
{
    return a.is_zero() ? a : apply(Op::neg, a);
}
Term operator+(const Term& a, const Term& b)
{
    return a.is_zero() ? b : b.is_zero() ? a : apply(Op::add, a, b);
}
Term operator-(const Term& a, const Term& b)
{
    return a.is_zero() ? -b : b.is_zero() ? a : apply(Op::sub, a, b);
}
Term operator*(const Term& a, const Term& b)
{
    return a.is_zero() ? a : b.is_zero() ? b : apply(Op::mul, a, b);
}
Term operator/(const Term& a, const Term& b)
{
    return a.is_zero() ? a : apply(Op::div, a, b);
}
Term operator*(double a, const Term& b)
{
    return b.is_zero() ? b : term(b, a) * b;
}
Term operator-(double a, const Term& b)
{
    return term(b, a) - b;
}
Term operator+(double a, const Term& b)
{
    return term(b, a) + b;
}
Term operator/(double a, const Term& b)
{
    return term(b, a) / b;
}

Term where(Value condition, const Term& a, const Term& b)
{
    if (a.is_zero() && b.is_zero()) return a;
    return {a.builder, a.builder->operation(Op::select, {condition, a.made(), b.made()})};
}

// `partial`, but 0 where `at` is 0: there the true derivative is infinite, or there is none.
Term zero_where_zero(const Term& at, const Term& partial)
{
    Value is_zero = apply(Op::eq, at, term(at, 0)).made();
    return where(is_zero, {at.builder, {}}, partial);
}

// Taken side where a < b, other side where b < a, the mean on a tie: no net lateral force on a crest.
Term pick(const Term& a, const Term& b, const Term& less, const Term& greater)
{
    Value a_less = apply(Op::lt, a, b).made(), b_less = apply(Op::lt, b, a).made();
    return where(a_less, less, where(b_less, greater, 0.5 * (less + greater)));
}

} // namespace

bool has_derivative(Op op)
{
    return op_info(op).kind != OpKind::discrete && op != Op::detach;
}

Tangent differentiate(Builder& builder, Op op, std::span<const Value> operands, Value result,
                      std::span<const Tangent> tangents)
{
    const auto is_zero = [](const Tangent& tangent) { return !tangent; };
    if (!has_derivative(op) || std::all_of(tangents.begin(), tangents.end(), is_zero)) return {};

    const auto operand = [&](size_t i) {
        return Term{&builder, i < operands.size() ? Tangent(operands[i]) : Tangent()};
    };
    const auto tangent = [&](size_t i) { return Term{&builder, i < tangents.size() ? tangents[i] : Tangent()}; };
    const Term a = operand(0), b = operand(1), c = operand(2), d = operand(3), r{&builder, result};
    const Term da = tangent(0), db = tangent(1), dc = tangent(2), dd = tangent(3);
    const auto unary = [&](const auto& partial) -> Tangent { return (da * partial()).value; };
    using std::numbers::ln2, std::numbers::pi;

    switch (op) {
    case Op::add: return (da + db).value;
    case Op::sub: return (da - db).value;
    case Op::mul: return (da * b + a * db).value;
    case Op::div: return ((da - r * db) * (1.0 / b)).value;
    case Op::neg: return (-da).value;
    case Op::fma: return (da * b + a * db + dc).value;
    case Op::min: return pick(a, b, da, db).value;
    case Op::max: return pick(a, b, db, da).value;
    case Op::abs: return unary([&] { return apply(Op::sign, a); });
    case Op::fract: return da.value;
    case Op::mod: return (da - apply(Op::floor, a / b) * db).value;
    case Op::sqrt: return unary([&] { return zero_where_zero(r, 0.5 / r); });
    case Op::length2:
    case Op::length3:
    case Op::length4: {
        const auto along = [&](const Term& x, const Term& dx) {
            return dx.is_zero() ? dx : dx * zero_where_zero(r, x / r);
        };
        return (along(a, da) + along(b, db) + along(c, dc) + along(d, dd)).value;
    }
    case Op::sin: return unary([&] { return apply(Op::cos, a); });
    case Op::cos: return unary([&] { return -apply(Op::sin, a); });
    case Op::tan: return unary([&] { return 1.0 + r * r; });
    case Op::sinturn: return unary([&] { return 2 * pi * apply(Op::costurn, a); });
    case Op::costurn: return unary([&] { return -2 * pi * apply(Op::sinturn, a); });
    case Op::asin:
    case Op::acos: {
        Term root = apply(Op::sqrt, (1.0 - a) * (1.0 + a));
        Term partial = zero_where_zero(root, 1.0 / root);
        return (op == Op::asin ? da * partial : -(da * partial)).value;
    }
    case Op::atan: return unary([&] { return 1.0 / (1.0 + a * a); });
    case Op::atan2:
    case Op::atan2pi: { // angle of the point (b, a)
        Term distance = apply(Op::length2, b, a);
        Term across = da.is_zero() ? da : da * zero_where_zero(distance, b / distance / distance);
        Term along = db.is_zero() ? db : db * zero_where_zero(distance, a / distance / distance);
        const Term angle = across - along;
        return (op == Op::atan2 ? angle : 1 / pi * angle).value;
    }
    case Op::sinh: return unary([&] { return apply(Op::cosh, a); });
    case Op::cosh: return unary([&] { return apply(Op::sinh, a); });
    case Op::tanh:
        return unary([&] {
            Term sech = 1.0 / apply(Op::cosh, a);
            return sech * sech;
        });
    case Op::asinh: return unary([&] { return 1.0 / apply(Op::length2, term(a, 1), a); });
    case Op::acosh:
        return unary([&] {
            Term root = apply(Op::sqrt, a - term(a, 1)) * apply(Op::sqrt, 1.0 + a);
            return zero_where_zero(root, 1.0 / root);
        });
    case Op::atanh: return unary([&] { return 1.0 / ((1.0 - a) * (1.0 + a)); });
    case Op::exp: return unary([&] { return r; });
    case Op::exp2: return unary([&] { return ln2 * r; });
    case Op::log: return unary([&] { return 1.0 / a; });
    case Op::log2: return unary([&] { return 1.0 / (ln2 * a); });
    case Op::pow: {
        Term slope_a = da, slope_b = db; // zero where that tangent is
        if (!da.is_zero()) {
            Value at_zero = apply(Op::eq, a, term(a, 0)).made(), below_one = apply(Op::lt, b, term(b, 1)).made();
            Value infinite = builder.operation(Op::land, {at_zero, below_one});
            Term partial = where(infinite, {&builder, {}}, b * apply(Op::pow, a, b - term(b, 1)));
            slope_a = da * zero_where_zero(b, partial);
        }
        if (!db.is_zero()) slope_b = db * zero_where_zero(a, r * apply(Op::log, a));
        return (slope_a + slope_b).value;
    }
    case Op::spline: { // the fourth of a cubic is 0
        const auto along = [&](const Term& by, uint32_t axis) {
            const uint32_t step = spline_order(axis == 0, axis == 1);
            const std::optional<uint32_t> order = builder.word_constant(operands[3]);
            if (by.is_zero() || (order && spline_order_along(*order, axis) >= 3)) return Term{&builder, {}};
            const Value next = builder.operation(Op::iadd, {operands[3], builder.i32(static_cast<int32_t>(step))});
            return by * Term{&builder, builder.operation(Op::spline, {operands[0], operands[1], operands[2], next})};
        };
        return (along(db, 0) + along(dc, 1)).value;
    }
    case Op::select: return where(operands[0], db, dc).value;
    case Op::detach:
#define DISCRETE(name, ...) case Op::name:
#include "lang/ir/ops.def"
        return {}; // see has_derivative
    }
    return {};
}

} // namespace haptel::ir
