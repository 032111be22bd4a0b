// Elementary functions: how far from the truth they are, and what one value takes, beside the C library's.
#pragma once

#include "bench/timing.h"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace haptel::bench {

// In f64 or in f32. Errors are the largest in units in the last place over all kinds of arguments: every exponent, near
// multiples of a quarter turn and near 1, and where results overflow or become subnormal.
struct MathFormat {
    double error = 0, library_error = 0;
    Times alone_ns, lanes_ns, library_ns; // per value; of ordinary arguments
};

struct MathRow {
    std::string function;
    uint32_t lanes = 1;
    double promised = 0; // what the errors are held to
    MathFormat f64, f32;
};

// Interleaved: each round takes every function in every form once. `progress` is called now and then with what has been
// done of the whole, 0 .. 1.
std::vector<MathRow> bench_math(bool quick, const std::function<void(double)>& progress);

} // namespace haptel::bench
