// The facts that a library function states, and what is found of them.
#pragma once

#include "tests/stdlib/field.h"

#include <functional>
#include <string>

namespace haptel::test {

// As the compiler knows them: of "noise(vec3,int)", which `call` calls.
ir::Facts facts_of(const std::string& function, const std::string& call);

// Value, slope, and change of the gradient over short steps, at many points within `size` of 0. A gradient that is as
// long as the fact may come out longer by `rounding` of it.
void check_never_exceeded(const std::string& call, const ir::Facts& facts, double size, int count = 20'000,
                          double rounding = 0);

// The largest value over places x with coordinates within the given ones and directions e of length 1, by search:
// random starts, random steps that shrink while nothing gets better.
using DirectedFunction = std::function<double(const Vec3& x, const Vec3& e)>;
double supremum(size_t dimensions, double minimum, double maximum, const DirectedFunction& function);

} // namespace haptel::test
