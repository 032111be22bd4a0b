// Types of the language: scalars, vectors of 2 to 4 of them, square matrices, structs, arrays of all these, and images.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace haptel::lang {

enum class Scalar : uint8_t { error, void_, float_, int_, uint_, bool_, image_, struct_ };

struct StructInfo;

struct Type {
    Scalar scalar = Scalar::error;
    uint8_t size = 1;                      // 1: scalar; 2 to 4: components of a vector, rows of a matrix
    uint32_t array_size = 0;               // 0: not an array
    uint8_t columns = 1;                   // 2 to 4: square matrix of floats, column after column as in GLSL
    const StructInfo* structure = nullptr; // of a struct, which is its members one behind the other
    uint32_t row_size = 0; // of an array of arrays: how many elements each has; 0: its elements are no arrays

    static constexpr Type error() { return {}; }
    bool is_error() const { return scalar == Scalar::error; }
    bool is_array() const { return array_size > 0; }
    bool is_scalar() const { return size == 1 && !is_array() && !structure; }
    bool is_vector() const { return size > 1 && columns == 1 && !is_array(); }
    bool is_matrix() const { return columns > 1 && !is_array(); }
    bool is_struct() const { return structure && !is_array(); }
    bool is_numeric() const { return scalar == Scalar::float_ || is_whole(); }
    bool is_whole() const { return scalar == Scalar::int_ || scalar == Scalar::uint_; } // or of whole numbers
    bool has_rows() const { return row_size > 0; }
    // What an index picks: an element of an array, a column of a matrix, a component of a vector.
    constexpr Type element() const
    {
        if (array_size > 0) return {scalar, size, row_size, columns, structure, 0};
        return {scalar, columns > 1 ? size : uint8_t{1}, 0, 1};
    }
    // Of an array, what is in it after all indices, and how many of that.
    constexpr Type cell() const { return {scalar, size, 0, columns, structure}; }
    uint32_t cell_count() const { return array_size * (has_rows() ? row_size : 1); }
    uint32_t element_count() const { return is_array() ? array_size : is_matrix() ? columns : size; }
    uint32_t components() const;
    bool operator==(const Type&) const = default;
};

inline constexpr Type float_type{Scalar::float_, 1, 0, 1}, int_type{Scalar::int_, 1, 0, 1},
    uint_type{Scalar::uint_, 1, 0, 1}, bool_type{Scalar::bool_, 1, 0, 1}, void_type{Scalar::void_, 1, 0, 1},
    image_type{Scalar::image_, 1, 0, 1};
constexpr bool is_integer(Type type)
{
    return type == int_type || type == uint_type;
}
inline constexpr Type vec(uint8_t size, Scalar of = Scalar::float_)
{
    return {of, size, 0, 1};
}
inline constexpr Type mat(uint8_t size)
{
    return {Scalar::float_, size, 0, size};
}

// Elements of an array that is no constant table. All its parts are values of the program, so that an index known only
// at run time costs a choice per element.
inline constexpr uint32_t array_size_max = 64, array_components_max = 256;

// A member stands behind the components of those before it.
struct StructMember {
    std::string name;
    Type type;
    uint32_t first = 0; // of its components
};

// Two structs are one type only if they are one declaration. Owned by CheckedProgram.
struct StructInfo {
    std::string name;
    std::vector<StructMember> members;
    uint32_t components = 0;

    const StructMember* member(std::string_view wanted) const // null: it has none of that name
    {
        const auto found = std::ranges::find(members, wanted, &StructMember::name);
        return found == members.end() ? nullptr : &*found;
    }
};

inline uint32_t Type::components() const
{
    const uint32_t of_element = structure ? structure->components : uint32_t{size} * columns;
    return of_element * (is_array() ? cell_count() : 1);
}

// As written in source: "mat3", "ivec3", "float[4]".
inline std::string to_string(Type type)
{
    const auto in_brackets = [](uint32_t count) { return "[" + std::to_string(count) + "]"; };
    if (type.is_array())
        return to_string(type.cell()) + in_brackets(type.array_size) +
               (type.has_rows() ? in_brackets(type.row_size) : "");
    if (type.is_matrix()) return "mat" + std::to_string(type.size);
    if (type.is_vector()) {
        const Scalar of = type.scalar;
        const char* letter = of == Scalar::int_ ? "i" : of == Scalar::uint_ ? "u" : of == Scalar::bool_ ? "b" : "";
        return letter + ("vec" + std::to_string(type.size));
    }
    switch (type.scalar) {
    case Scalar::error: return "<error>";
    case Scalar::void_: return "void";
    case Scalar::float_: return "float";
    case Scalar::int_: return "int";
    case Scalar::uint_: return "uint";
    case Scalar::bool_: return "bool";
    case Scalar::image_: return "image";
    case Scalar::struct_: return type.structure->name;
    }
    return {};
}

} // namespace haptel::lang
