// Which surfaces meet: those that touch, cross, or leave nothing but a slit between them.
#pragma once

#include "runtime/geometry/placement.h"
#include "runtime/surface/build/build_work.h"
#include "runtime/surface/surface.h"

namespace haptel::runtime {

// Whether a triangle of one, as it is placed, comes within `gap_m` of one of the other. Where the work is over: false.
bool meet(const Surface& one, const Placement& of_one, const Surface& other, const Placement& of_other, double gap_m,
          BuildWork& work);

} // namespace haptel::runtime
