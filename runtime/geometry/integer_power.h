// A factor applied so many times. By products alone: the same bits whatever the C library.
#pragma once

#include <cstdint>

namespace haptel::runtime {

inline double integer_power(double factor, uint64_t times)
{
    double product = 1;
    for (; times > 0; times >>= 1, factor *= factor)
        if (times & 1) product *= factor;
    return product;
}

} // namespace haptel::runtime
