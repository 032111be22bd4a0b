// How a field changes along lines of the plane: a search for places where height or gradient jump.
#pragma once

#include "tests/stdlib/field.h"

namespace haptel::test {

struct Jumps {
    double value = 0, gradient = 0; // the greatest found
};

// Along `count` lines of length 1 within -size .. size. Each is cut into 64 steps; the one over which most changes is
// halved until it is 2e-11 long. What changes over that is a jump, but for the slope (or curvature) over so short a
// way.
Jumps jumps_along_lines(const Field& field, double size, int count);

} // namespace haptel::test
