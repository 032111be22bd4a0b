#include "lang/syntax/type.h"

namespace haptel::lang {

std::string to_string(Type type)
{
    if (type.is_array()) return to_string(type.element()) + "[" + std::to_string(type.array_size) + "]";
    if (type.is_matrix()) return "mat" + std::to_string(type.size);
    if (type.is_vector()) return "vec" + std::to_string(type.size);
    switch (type.scalar) {
    case Scalar::error: return "<error>";
    case Scalar::void_: return "void";
    case Scalar::float_: return "float";
    case Scalar::int_: return "int";
    case Scalar::uint_: return "uint";
    case Scalar::bool_: return "bool";
    case Scalar::image_: return "image";
    }
    return {};
}

} // namespace haptel::lang
