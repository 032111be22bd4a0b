#include "lang/check/type_hint.h"

#include <algorithm>

namespace haptel::lang {

using namespace ast;

std::string conversion_hint(Type from, Type to, const std::string& text, const std::string& operand)
{
    if (to.is_array() || to.is_error() || to == image_type) return {};
    if (from == image_type) return "read it: sample(" + text + ", uv)";
    if (from.is_array()) return "pick an element: " + operand + "[i]";
    if (from.is_struct() && to.is_struct() && from.structure->name == to.structure->name)
        return "two files declare a struct of this name: give one of them another";
    if (to.is_struct()) return "make one of its members: " + constructor_of(to);
    if (from.is_struct()) {
        const auto fits = std::ranges::find(from.structure->members, to, &StructMember::type);
        const bool has_one = fits != from.structure->members.end();
        return "pick a member: " + operand + "." + (has_one ? *fits : from.structure->members.front()).name;
    }
    if (from.is_matrix() || to.is_matrix()) {
        if (from.is_matrix() && to == from.element()) return "pick a column: " + operand + "[0]";
        if (from.is_matrix() && to.is_scalar()) return "pick an element: " + operand + "[0][0]";
        return from.is_vector() || to.is_vector() ? "" : "write " + to_string(to) + "(" + text + ")";
    }
    if (from.is_vector() && to.is_vector() && from.size == to.size) return "write " + to_string(to) + "(" + text + ")";
    if (from.is_vector() && to.is_vector())
        return from.size > to.size
                   ? "pick components: " + operand + "." + std::string("xyzw").substr(0, to.size)
                   : "write " + to_string(to) + "(" + text + ", 0.0" + (to.size - from.size > 1 ? ", 0.0" : "") + ")";
    if (from.is_vector() && from.scalar == Scalar::bool_) return "write any(" + text + ") or all(" + text + ")";
    if (from.is_vector()) return "pick a component, " + operand + ".x, or take length(" + text + ")";
    if (to == bool_type) return "write " + operand + (from == float_type ? " != 0.0" : " != 0");
    if (to == int_type && from == float_type) return "write int(" + text + "), which drops the fraction";
    return "write " + to_string(to) + "(" + text + ")";
}

std::string part_name(Type type, uint32_t part)
{
    if (type.is_struct()) {
        for (const StructMember& member : type.structure->members)
            if (part < member.first + member.type.components()) {
                const bool is_one = member.type.is_scalar() || member.type.is_array();
                return "." + member.name + (is_one ? "" : part_name(member.type, part - member.first));
            }
    }
    if (type.is_vector()) return std::string(".") + "xyzw"[part];
    if (!type.is_matrix() && !type.has_rows()) return "[" + std::to_string(part) + "]";
    const uint32_t size = type.has_rows() ? type.row_size : type.size;
    return "[" + std::to_string(part / size) + "][" + std::to_string(part % size) + "]";
}

std::string operator_hint(BinaryOp op, Type left, Type right)
{
    using enum BinaryOp;
    const bool vectors = !left.is_scalar() || !right.is_scalar();
    const bool matrices = left.is_matrix() || right.is_matrix();
    const bool reals = left.scalar == Scalar::float_ || right.scalar == Scalar::float_;
    const bool bools = left.scalar == Scalar::bool_ || right.scalar == Scalar::bool_;
    if (left.is_array() || right.is_array()) return "an array is used by its elements: a[i]";
    if (left.is_struct() || right.is_struct()) {
        const StructInfo& info = *(left.is_struct() ? left : right).structure;
        return "a struct is used by its members, as ." + info.members.front().name;
    }
    if (left == image_type || right == image_type) return "an image is read at a place: sample(picture, uv)";
    if (left.is_whole() && right.is_whole() && left.scalar != right.scalar)
        return "int and uint do not mix: write " + to_string(vec(right.size, left.scalar)) + "(...) round the second";
    switch (op) {
    case add:
    case subtract:
    case multiply:
    case divide:
        if (bools) return "write float(...) round the bool: it is then 0 or 1";
        if (matrices) return "matrices go with matrices, vectors and columns of their size, and with numbers";
        return "vectors must have the same size: pick components, for example .xy";
    case remainder: return reals ? "write mod(x, y)" : "% takes int or uint";
    case less:
    case less_equal:
    case greater:
    case greater_equal:
        if (matrices) return "compare their elements, a[0][0] < b[0][0]";
        if (vectors) return "compare components, a.x < b.x, all of them, all(lessThan(a, b)), or lengths";
        return "join comparisons with &&";
    case equal:
    case not_equal: return vectors ? "vectors must have the same size" : "both sides must be of one kind";
    case logical_and:
    case logical_or:
    case logical_xor: return vectors ? "write any(x) or all(x)" : "compare first, for example x != 0.0";
    case bit_and: return bools ? "write && for bool" : "bits are those of int or uint";
    case bit_or: return bools ? "write || for bool" : "bits are those of int or uint";
    case bit_xor:
        if (bools) return "write ^^ for bool";
        return "^ is exclusive or of bits; a power is pow(x, y)";
    case shift_left:
    case shift_right: return "bits are those of int or uint";
    }
    return {};
}

std::string zero_of(Type type)
{
    if (type.is_struct()) {
        std::string parts;
        for (const StructMember& member : type.structure->members)
            parts += (parts.empty() ? "" : ", ") + zero_of(member.type);
        return to_string(type) + "(" + parts + ")";
    }
    if (type.is_array()) { // a member
        std::string parts = zero_of(type.element());
        for (uint32_t i = 1; i < type.array_size; ++i) parts += ", " + zero_of(type.element());
        return to_string(type) + "(" + parts + ")";
    }
    const std::string zero = type.scalar == Scalar::bool_ ? "false" : type.scalar == Scalar::float_ ? "0.0" : "0";
    return type.is_scalar() ? zero : to_string(type) + "(" + zero + ")";
}

std::string constructor_of(Type type)
{
    std::string names;
    for (const StructMember& member : type.structure->members) names += (names.empty() ? "" : ", ") + member.name;
    return to_string(type) + "(" + names + ")";
}

} // namespace haptel::lang
