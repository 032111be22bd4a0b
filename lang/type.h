// Types of the language: scalars, vectors of 2 to 4, and arrays of them.
#pragma once

#include <cstdint>
#include <string>

namespace haptel::lang {

enum class Scalar : uint8_t { error, void_, float_, int_, uint_, bool_ };

struct Type {
    Scalar scalar = Scalar::error;
    uint8_t size = 1;        // 1: scalar; 2 to 4: vector (of float only)
    uint32_t array_size = 0; // 0: not an array

    static constexpr Type error() { return {}; }
    bool is_error() const { return scalar == Scalar::error; }
    bool is_vector() const { return size > 1; }
    bool is_array() const { return array_size > 0; }
    bool is_numeric() const { return scalar == Scalar::float_ || scalar == Scalar::int_ || scalar == Scalar::uint_; }
    Type element() const { return {scalar, size, 0}; }
    bool operator==(const Type&) const = default;
};

inline constexpr Type float_type{Scalar::float_, 1, 0}, int_type{Scalar::int_, 1, 0}, uint_type{Scalar::uint_, 1, 0},
    bool_type{Scalar::bool_, 1, 0}, void_type{Scalar::void_, 1, 0};
inline constexpr Type vec(uint8_t size)
{
    return {Scalar::float_, size, 0};
}

std::string to_string(Type type); // as written in source: "vec3", "float[4]"

} // namespace haptel::lang
