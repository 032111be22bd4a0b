// What the builder simplifies. Only identities that hold for every bit pattern of the operands, infinities, NaN and
// both zeros included (any NaN equals any NaN), so that code before and after is the same function:
//
//   constant operands        the scalar meaning of semantics.h
//   reals                    x*1  x/1  x+(-0)  x-(+0) -> x      x*-1  x/-1  (-0)-x -> -x       -(-x) -> x
//                            x+(-y) -> x-y   x-(-y) -> x+y      (-x)*(-y) -> x*y   (-x)/(-y) -> x/y
//                            (-x)*c -> x*(-c)   (-x)/c -> x/(-c)   x/2^k -> x*2^-k where both are normal
//                            x-floor(x) -> fract(x)   min(x,x)  max(x,x) -> x   fma(x,y,-0) -> x*y   fma(1,y,z) -> y+z
//                            |-x|  ||x|| -> |x|   a rounding of a whole number -> that number   pow(x,1) -> x  pow(x,0)
//                            -> 1
//   choice                   select(c,x,x) -> x   select(!c,x,y) -> select(c,y,x)   of booleans: c, !c
//   booleans, integers       the usual ones; comparisons of x with itself, where NaN allows; casts there and back;
//                            min, max and % that the operands' ranges decide
//
// Not among them: x+0 (loses -0), x*0 and x-x (lose NaN), -(x-y) -> y-x (loses -0), reassociation.
#include "lang/ir/builder.h"
#include "lang/ir/op_info.h"
#include "lang/ir/semantics.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace haptel::ir {
namespace {

bool is_power_of_two(double value)
{
    int exponent = 0;
    return std::isnormal(value) && std::isnormal(1 / value) && std::fabs(std::frexp(value, &exponent)) == 0.5;
}

bool is_rounding(Op op)
{
    return op == Op::floor || op == Op::ceil || op == Op::trunc || op == Op::round;
}

} // namespace

// One attempt: the operands and what is known of them.
class Builder::Fold {
public:
    Fold(Builder& maker, Op tried, std::span<const Value> given) : builder(maker), op(tried), operands(given) {}

    std::optional<Value> run()
    {
        if (std::ranges::all_of(operands, [&](Value value) { return builder.definition(value).is_constant; }))
            return constant();
        if (op == Op::select) return choice();
        switch (builder.type(operands[0])) {
        case Type::real: return operands.size() == 1 ? real_unary() : real();
        case Type::boolean: return boolean();
        case Type::i32:
        case Type::u32: return operands.size() == 1 ? cast() : integer();
        case Type::image: break; // known when a texture is bound
        }
        return std::nullopt;
    }

private:
    Builder& builder;
    Op op;
    std::span<const Value> operands;

    Value make(Op made, std::initializer_list<Value> values) { return builder.operation(made, values); }
    bool was(Value value, Op made) const { return builder.definition(value).op == made; }
    Value inner(Value value, size_t i = 0) const { return builder.definition(value).operand[i]; }
    bool is(Value value, double constant) const
    {
        std::optional<double> known = builder.real_constant(value);
        return known && *known == constant && std::signbit(*known) == std::signbit(constant);
    }
    bool is_int(Value value, int64_t constant) const { return range(value) == IntRange{constant, constant}; }
    IntRange range(Value value) const { return builder.range(value); }
    std::optional<bool> truth(Value value) const
    {
        const auto known = builder.word_constant(value);
        return known && builder.type(value) == Type::boolean ? std::optional(*known != 0) : std::nullopt;
    }

    Value constant()
    {
        Slot<double> in[4], out;
        Type types[4];
        for (size_t i = 0; i < operands.size(); ++i) {
            in[i] = {builder.definition(operands[i]).real, static_cast<uint32_t>(range(operands[i]).minimum)};
            types[i] = builder.type(operands[i]);
        }
        execute(op, out, in[0], in[1], in[2], in[3]);
        const Type type = *result_type(op, {types, operands.size()});
        return type == Type::real ? builder.real(out.real) : builder.word(out.bits, type);
    }

    std::optional<Value> choice()
    {
        Value condition = operands[0], a = operands[1], b = operands[2];
        if (a == b) return a;
        if (std::optional<bool> known = truth(condition)) return *known ? a : b;
        if (was(condition, Op::lnot)) return make(Op::select, {inner(condition), b, a});
        if (auto x = truth(a), y = truth(b); x && y) return *x ? condition : make(Op::lnot, {condition});
        return std::nullopt;
    }

    std::optional<Value> real_unary()
    {
        Value x = operands[0];
        if (op == Op::neg && was(x, Op::neg)) return inner(x);
        if (op == Op::abs && was(x, Op::neg)) return make(Op::abs, {inner(x)});
        if (op == Op::abs && was(x, Op::abs)) return x;
        bool is_whole = was(x, Op::i_to_r) || was(x, Op::u_to_r) || was(x, Op::floor) || was(x, Op::ceil) ||
                        was(x, Op::trunc) || was(x, Op::round);
        if (is_rounding(op) && is_whole) return x;
        if (op == Op::is_finite && (was(x, Op::i_to_r) || was(x, Op::u_to_r))) return builder.boolean(true);
        if (op == Op::r_to_i && was(x, Op::i_to_r)) return inner(x);
        if (op == Op::r_to_u && was(x, Op::u_to_r)) return inner(x);
        return std::nullopt;
    }

    std::optional<Value> real()
    {
        Value x = operands[0], y = operands[1];
        if (op == Op::add) {
            if (is(y, -0.0)) return x;
            if (is(x, -0.0)) return y;
            if (was(y, Op::neg)) return make(Op::sub, {x, inner(y)});
            if (was(x, Op::neg)) return make(Op::sub, {y, inner(x)});
        }
        if (op == Op::sub) {
            if (is(y, 0.0)) return x;
            if (is(x, -0.0)) return make(Op::neg, {y});
            if (was(y, Op::neg)) return make(Op::add, {x, inner(y)});
            if (was(y, Op::floor) && inner(y) == x) return make(Op::fract, {x});
        }
        if (op == Op::mul) {
            if (is(y, 1)) return x;
            if (is(x, 1)) return y;
            if (is(y, -1)) return make(Op::neg, {x});
            if (is(x, -1)) return make(Op::neg, {y});
        }
        if (op == Op::div) {
            if (is(y, 1)) return x;
            if (is(y, -1)) return make(Op::neg, {x});
            if (auto c = builder.real_constant(y); c && is_power_of_two(*c))
                return make(Op::mul, {x, builder.real(1 / *c)});
        }
        if (op == Op::mul || op == Op::div) {
            if (was(x, Op::neg) && was(y, Op::neg)) return make(op, {inner(x), inner(y)});
            if (auto c = builder.real_constant(y); c && was(x, Op::neg)) return make(op, {inner(x), builder.real(-*c)});
            if (auto c = builder.real_constant(x); c && was(y, Op::neg)) return make(op, {builder.real(-*c), inner(y)});
        }
        if (op == Op::fma && is(operands[2], -0.0)) return make(Op::mul, {x, y});
        if (op == Op::fma && is(x, 1)) return make(Op::add, {y, operands[2]});
        if (op == Op::fma && is(y, 1)) return make(Op::add, {x, operands[2]});
        if ((op == Op::min || op == Op::max) && x == y) return x;
        if (op == Op::lt && x == y) return builder.boolean(false);
        if (op == Op::pow && is(y, 1)) return x;
        if (op == Op::pow && (is(y, 0.0) || is(y, -0.0))) return builder.real(1);
        return std::nullopt;
    }

    std::optional<Value> boolean()
    {
        Value x = operands[0];
        if (op == Op::lnot && was(x, Op::lnot)) return inner(x);
        if (operands.size() != 2) return std::nullopt;
        Value y = operands[1];
        if (truth(x)) std::swap(x, y);
        std::optional<bool> known = truth(y);
        if (op == Op::land && (x == y || known)) return x == y || *known ? x : y;
        if (op == Op::lor && (x == y || known)) return x == y || !*known ? x : y;
        if (op == Op::lxor && x == y) return builder.boolean(false);
        if (op == Op::lxor && known) return *known ? make(Op::lnot, {x}) : x;
        return std::nullopt;
    }

    std::optional<Value> cast()
    {
        Value x = operands[0];
        if (op == Op::i_as_u && was(x, Op::u_as_i)) return inner(x);
        if (op == Op::u_as_i && was(x, Op::i_as_u)) return inner(x);
        return std::nullopt;
    }

    std::optional<Value> integer()
    {
        Value x = operands[0], y = operands[1];
        const auto zero = [&] { return builder.word(0, builder.type(x)); };
        const IntRange rx = range(x), ry = range(y);
        if (op == Op::iadd || op == Op::ior || op == Op::ixor) {
            if (is_int(y, 0)) return x;
            if (is_int(x, 0)) return y;
        }
        if (op == Op::isub || op == Op::ishl || op == Op::ishr || op == Op::ushr)
            if (is_int(y, 0)) return x;
        if ((op == Op::isub || op == Op::ixor) && x == y) return zero();
        if (op == Op::imul && is_int(y, 1)) return x;
        if (op == Op::imul && is_int(x, 1)) return y;
        if ((op == Op::idiv || op == Op::udiv) && is_int(y, 1)) return x;
        if (op == Op::irem || op == Op::urem) {
            if (is_int(y, 1)) return zero();
            if (rx.minimum >= 0 && rx.maximum < ry.minimum) return x;
        }
        if (op == Op::iand && is_int(y, -1)) return x;
        if (op == Op::iand && is_int(x, -1)) return y;
        if ((op == Op::imul || op == Op::iand) && (is_int(x, 0) || is_int(y, 0))) return zero();
        if ((op == Op::iand || op == Op::ior || op == Op::imin || op == Op::imax || op == Op::umin || op == Op::umax) &&
            x == y)
            return x;
        if (op == Op::imin || op == Op::umin) {
            if (rx.maximum <= ry.minimum) return x;
            if (ry.maximum <= rx.minimum) return y;
        }
        if (op == Op::imax || op == Op::umax) {
            if (rx.minimum >= ry.maximum) return x;
            if (ry.minimum >= rx.maximum) return y;
        }
        if (op == Op::ilt || op == Op::ult) {
            if (rx.maximum < ry.minimum) return builder.boolean(true);
            if (x == y || rx.minimum >= ry.maximum) return builder.boolean(false);
        }
        if (op == Op::ile || op == Op::ule) {
            if (x == y || rx.maximum <= ry.minimum) return builder.boolean(true);
            if (rx.minimum > ry.maximum) return builder.boolean(false);
        }
        if ((op == Op::ieq || op == Op::ueq) && x == y) return builder.boolean(true);
        return std::nullopt;
    }
};

std::optional<Value> Builder::fold(Op op, std::span<const Value> operands)
{
    return Fold(*this, op, operands).run();
}

} // namespace haptel::ir
