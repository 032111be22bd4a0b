#include "lang/type.h"

namespace haptel::lang {

std::string to_string(Type type)
{
    std::string text;
    if (type.is_vector()) {
        text = "vec" + std::to_string(type.size);
    } else {
        switch (type.scalar) {
        case Scalar::error: text = "<error>"; break;
        case Scalar::void_: text = "void"; break;
        case Scalar::float_: text = "float"; break;
        case Scalar::int_: text = "int"; break;
        case Scalar::uint_: text = "uint"; break;
        case Scalar::bool_: text = "bool"; break;
        }
    }
    if (type.is_array()) text += "[" + std::to_string(type.array_size) + "]";
    return text;
}

} // namespace haptel::lang
