// The elementary functions as other libraries know them, by the names of ops.def: of an oracle's number what is exact,
// of double and float what the C library says. What ours are held to; where theirs is no function, its definition.
#pragma once

#include <cmath>

namespace haptel::ir::exact {

#define ELEMENTARY(name, ...)                                                                                          \
    template <typename T>                                                                                              \
    T name(const T& a)                                                                                                 \
    {                                                                                                                  \
        using std::name;                                                                                               \
        return T(name(a));                                                                                             \
    }
#define ELEMENTARY2(...)
#include "lang/ir/ops.def"

// 0 at the origin, whatever the signs of zeros.
template <typename T>
T atan2(const T& y, const T& x)
{
    using std::atan2;
    return y == T(0) && x == T(0) ? T(0) : T(atan2(y, x));
}

// In half turns.
template <typename T>
T atan2pi(const T& y, const T& x)
{
    return exact::atan2(y, x) / (T(4) * exact::atan(T(1)));
}

template <typename T>
T pow(const T& a, const T& b)
{
    using std::pow;
    return T(pow(a, b));
}

} // namespace haptel::ir::exact
