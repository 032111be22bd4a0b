// A real number of at least 113 bits with elementary functions: libquadmath's where the compiler has it, Boost's own
// else. Include only where an oracle is evaluated: it is heavy.
#pragma once

#if defined(__GNUC__) && !defined(__clang__) && defined(__SIZEOF_FLOAT128__) && __has_include(<quadmath.h>)
#include <boost/multiprecision/float128.hpp>
namespace haptel::ir {
using Quad = boost::multiprecision::float128;
}
#define HAPTEL_QUAD_IS_FLOAT128 1
#else
#include <boost/multiprecision/cpp_bin_float.hpp>
namespace haptel::ir {
using Quad = boost::multiprecision::cpp_bin_float_quad;
}
#endif
