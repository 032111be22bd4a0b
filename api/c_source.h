// What stands behind haptel_source: the compiler's library makes one, too.
#pragma once

#include <haptel/c.h>
#include <haptel/texture.h>

struct haptel_source {
    haptel::TextureSource textures;
};

namespace haptel {

inline Parameters parameters_of(const haptel_value* values, size_t count)
{
    Parameters parameters;
    for (size_t i = 0; i < count; ++i)
        if (values[i].name && values[i].value) parameters.emplace_back(values[i].name, values[i].value);
    return parameters;
}

} // namespace haptel
