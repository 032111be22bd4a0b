// A smooth step.
#pragma once

#include <algorithm>

namespace haptel::runtime {

// Rises from 0 to 1 over 0 .. 1, and its derivative.
struct Rise {
    double value, slope;
    explicit Rise(double x) : value(0), slope(0)
    {
        x = std::clamp(x, 0.0, 1.0);
        value = x * x * (3 - 2 * x);
        slope = 6 * x * (1 - x);
    }
};

} // namespace haptel::runtime
