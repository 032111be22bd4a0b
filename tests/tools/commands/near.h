// Figures in reports that are right but for rounding.
#pragma once

#include "tools/output/json.h"

#include <cmath>

namespace haptel::test {

inline bool near(const tools::Json& number, double value)
{
    return std::fabs(number.get<double>() - value) <= 1e-12 * std::fabs(value);
}

} // namespace haptel::test
