// What the composed built-in functions are made of. Each is a function of its name in builtins.def: either of one
// component of every argument (Value), or of whole arguments (Values).
#include "lang/lower/lowering.h"
#include "lang/math/spline.h"

#include <numbers>
#include <variant>

namespace haptel::lang {

using ir::Builder;
using ir::Op;
using ir::Value;

namespace {

class Formulas {
public:
    using Parts = std::span<const Value>; // of the arguments, at one component
    using Whole = std::span<const Values>;

    Formulas(ModuleLowering& whole, Builder& target) : owner(whole), builder(target) {}

    Value radians(Parts x) { return mul(x[0], real(std::numbers::pi / 180)); }
    Value degrees(Parts x) { return mul(x[0], real(180 / std::numbers::pi)); }
    Value inversesqrt(Parts x) { return div(real(1), sqrt(x[0])); }
    Value iabs(Parts x) { return make(Op::imax, x[0], make(Op::isub, builder.i32(0), x[0])); }
    Value isign(Parts x) { return make(Op::imin, make(Op::imax, x[0], builder.i32(-1)), builder.i32(1)); }
    Value clamp(Parts x) { return make(Op::min, make(Op::max, x[0], x[1]), x[2]); }
    Value iclamp(Parts x) { return make(Op::imin, make(Op::imax, x[0], x[1]), x[2]); }
    Value uclamp(Parts x) { return make(Op::umin, make(Op::umax, x[0], x[1]), x[2]); }
    Value mix(Parts x) { return add(mul(x[0], sub(real(1), x[2])), mul(x[1], x[2])); }
    Value mix_either(Parts x) { return select(x[2], x[1], x[0]); }
    Value step(Parts x) { return select(less(x[1], x[0]), real(0), real(1)); }
    Value smoothstep(Parts x)
    {
        const Value ramp[] = {div(sub(x[2], x[0]), sub(x[1], x[0]))};
        return builder.call(owner.smooth_ramp(), ramp)[0];
    }
    Value isnan(Parts x) { return no(equal(x[0], x[0])); }
    Value isinf(Parts x) { return make(Op::land, equal(x[0], x[0]), no(builder.operation(Op::is_finite, {x[0]}))); }

    Value texel(Parts x)
    {
        const auto inside = [&](Value index, Op count) {
            const Value last = make(Op::isub, builder.operation(count, {x[0]}), builder.i32(1));
            return builder.operation(Op::i_to_r, {make(Op::imin, make(Op::imax, index, builder.i32(0)), last)});
        };
        return spline_of(x[0], inside(x[1], Op::image_width), inside(x[2], Op::image_height), HAPTEL_EDGE_CLAMPED);
    }
    Value spline(Parts x) { return spline_of(x[0], x[1], x[2], HAPTEL_EDGE_CLAMPED); }
    Value spline_tiled(Parts x) { return spline_of(x[0], x[1], x[2], HAPTEL_EDGE_TILED); }
    Value spline_mirrored(Parts x) { return spline_of(x[0], x[1], x[2], HAPTEL_EDGE_MIRRORED); }

    Values length(Whole x) { return {length_of(x[0])}; }
    Values stretch(Whole x)
    {
        Values rows;
        for (Value part : x[0]) {
            Values row;
            for (uint32_t axis = 0; axis < 3; ++axis) row.push_back(builder.point_derivative(axis, part));
            rows.push_back(length_of(row));
        }
        return {rows.size() == 1 ? rows[0] : length_of(rows)};
    }
    Values distance(Whole x)
    {
        return {length_of(each(x[0].size(), [&](size_t i) { return sub(x[0][i], x[1][i]); }))};
    }
    Values dot(Whole x) { return {product(x[0], x[1])}; }
    Values cross(Whole x)
    {
        return each(3, [&](size_t i) {
            const size_t j = (i + 1) % 3, k = (i + 2) % 3;
            return sub(mul(x[0][j], x[1][k]), mul(x[0][k], x[1][j]));
        });
    }
    Values normalize(Whole x)
    {
        if (x[0].size() == 1) return {builder.operation(Op::sign, {x[0][0]})};
        const Value length = length_of(x[0]), is_zero = equal(length, real(0));
        return each(x[0].size(), [&](size_t i) { return select(is_zero, real(0), div(x[0][i], length)); });
    }
    Values faceforward(Whole x)
    {
        const Value faces = less(product(x[2], x[1]), real(0));
        return each(x[0].size(), [&](size_t i) { return select(faces, x[0][i], negated(x[0][i])); });
    }
    Values reflect(Whole x)
    {
        const Value twice = mul(real(2), product(x[1], x[0]));
        return each(x[0].size(), [&](size_t i) { return sub(x[0][i], mul(twice, x[1][i])); });
    }
    Values refract(Whole x)
    {
        const Value eta = x[2][0], cosine = product(x[1], x[0]);
        const Value k = sub(real(1), mul(mul(eta, eta), sub(real(1), mul(cosine, cosine))));
        const Value reflected = less(k, real(0)), along = add(mul(eta, cosine), sqrt(k));
        return each(x[0].size(),
                    [&](size_t i) { return select(reflected, real(0), sub(mul(eta, x[0][i]), mul(along, x[1][i]))); });
    }

    Value less_than(Parts x) { return compared(x[0], x[1], Op::lt, Op::ilt, Op::ult); }
    Value less_than_equal(Parts x) { return compared(x[0], x[1], Op::le, Op::ile, Op::ule); }
    Value greater_than(Parts x) { return compared(x[1], x[0], Op::lt, Op::ilt, Op::ult); }
    Value greater_than_equal(Parts x) { return compared(x[1], x[0], Op::le, Op::ile, Op::ule); }
    Value equal_to(Parts x)
    {
        if (builder.type(x[0]) == ir::Type::boolean) return no(make(Op::lxor, x[0], x[1]));
        return compared(x[0], x[1], Op::eq, Op::ieq, Op::ueq);
    }
    Value not_equal_to(Parts x) { return no(equal_to(x)); }
    Values any(Whole x) { return {joined(x[0], Op::lor)}; }
    Values all(Whole x) { return {joined(x[0], Op::land)}; }

    Value matrix_comp_mult(Parts x) { return mul(x[0], x[1]); }
    Values outer_product(Whole x)
    {
        const size_t rows = x[0].size();
        return each(rows * x[1].size(), [&](size_t i) { return mul(x[0][i % rows], x[1][i / rows]); });
    }
    Values transpose(Whole x)
    {
        const size_t size = size_of(x[0]);
        return each(size * size, [&](size_t i) { return x[0][i % size * size + i / size]; });
    }
    Values determinant(Whole x)
    {
        const Lines all = lines_but(size_of(x[0]), SIZE_MAX);
        return {minor(x[0], all, all)};
    }
    Values inverse(Whole x) // the adjugate, divided
    {
        const size_t size = size_of(x[0]);
        const Value whole = determinant(x)[0];
        return each(size * size, [&](size_t i) {
            const size_t column = i / size, row = i % size;
            const Value cofactor = minor(x[0], lines_but(size, column), lines_but(size, row));
            const bool is_negative = (row + column) % 2 == 1;
            return div(is_negative ? negated(cofactor) : cofactor, whole);
        });
    }

private:
    template <typename Make>
    static Values each(size_t count, const Make& make)
    {
        Values made;
        for (size_t i = 0; i < count; ++i) made.push_back(make(i));
        return made;
    }

    Value spline_of(Value image, Value x, Value y, uint32_t edge)
    {
        const uint32_t orders = ir::spline_order(0, 0, edge);
        return builder.operation(Op::spline, {image, x, y, builder.i32(static_cast<int32_t>(orders))});
    }

    using Lines = std::vector<size_t>; // rows or columns of a matrix

    static size_t size_of(const Values& matrix) { return matrix.size() == 4 ? 2 : matrix.size() == 9 ? 3 : 4; }
    static Lines lines_but(size_t size, size_t left_out)
    {
        Lines lines;
        for (size_t i = 0; i < size; ++i)
            if (i != left_out) lines.push_back(i);
        return lines;
    }
    // Determinant of those rows and columns, by the first of these columns. The builder shares the smaller ones.
    Value minor(const Values& matrix, const Lines& rows, const Lines& columns)
    {
        const auto at = [&](size_t row) { return matrix[columns[0] * size_of(matrix) + rows[row]]; };
        if (rows.size() == 1) return at(0);
        const Lines other_columns(columns.begin() + 1, columns.end());
        Value sum{};
        for (size_t row = 0; row < rows.size(); ++row) {
            Lines other_rows = rows;
            other_rows.erase(other_rows.begin() + static_cast<std::ptrdiff_t>(row));
            const Value term = mul(at(row), minor(matrix, other_rows, other_columns));
            sum = row == 0 ? term : row % 2 == 1 ? sub(sum, term) : add(sum, term);
        }
        return sum;
    }

    Value compared(Value a, Value b, Op of_real, Op of_int, Op of_uint)
    {
        const ir::Type type = builder.type(a);
        return make(type == ir::Type::real ? of_real : type == ir::Type::i32 ? of_int : of_uint, a, b);
    }
    Value joined(const Values& parts, Op by)
    {
        Value all = parts[0];
        for (size_t i = 1; i < parts.size(); ++i) all = make(by, all, parts[i]);
        return all;
    }
    Value make(Op op, Value a, Value b) { return builder.operation(op, {a, b}); }
    Value real(double value) { return builder.real(value); }
    Value add(Value a, Value b) { return make(Op::add, a, b); }
    Value sub(Value a, Value b) { return make(Op::sub, a, b); }
    Value mul(Value a, Value b) { return make(Op::mul, a, b); }
    Value div(Value a, Value b) { return make(Op::div, a, b); }
    Value less(Value a, Value b) { return make(Op::lt, a, b); }
    Value equal(Value a, Value b) { return make(Op::eq, a, b); }
    Value negated(Value a) { return builder.operation(Op::neg, {a}); }
    Value no(Value a) { return builder.operation(Op::lnot, {a}); }
    Value sqrt(Value a) { return builder.operation(Op::sqrt, {a}); }
    Value select(Value condition, Value a, Value b) { return builder.operation(Op::select, {condition, a, b}); }
    Value product(const Values& a, const Values& b)
    {
        Value sum = mul(a[0], b[0]);
        for (size_t i = 1; i < a.size(); ++i) sum = add(sum, mul(a[i], b[i]));
        return sum;
    }
    Value length_of(const Values& a)
    {
        constexpr Op ops[] = {Op::abs, Op::length2, Op::length3, Op::length4};
        return builder.operation(ops[a.size() - 1], a);
    }

    ModuleLowering& owner;
    Builder& builder;
};

using Formula =
    std::variant<std::monostate, Value (Formulas::*)(Formulas::Parts), Values (Formulas::*)(Formulas::Whole)>;

constexpr Formula formulas[] = {
// by BuiltinId; empty where an operation does it
#define OPERATION(id, ...) Formula(),
#define COMPOSED(id, ...) Formula(&Formulas::id),
#include "lang/program/builtins.def"
};

} // namespace

Values lower_builtin(ModuleLowering& owner, Builder& builder, const BuiltinOverload& overload,
                     std::span<const Values> arguments)
{
    const Builtin& builtin = *overload.builtin;
    const Formula& formula = formulas[static_cast<size_t>(builtin.id)];
    Formulas maker(owner, builder);
    if (auto whole = std::get_if<2>(&formula)) return (maker.**whole)(arguments);
    Values made;
    for (size_t i = 0; i < overload.result.components(); ++i) {
        Values parts;
        for (const Values& argument : arguments) parts.push_back(argument[argument.size() == 1 ? 0 : i]);
        auto of_parts = std::get_if<1>(&formula);
        made.push_back(of_parts ? (maker.**of_parts)(parts) : builder.operation(*builtin.op, parts));
    }
    return made;
}

} // namespace haptel::lang
