// The part of a scene file that says how an object moves.
#pragma once

#include "runtime/files/table_reader.h"
#include "runtime/motion.h"

#include <memory>

namespace haptel::runtime {

// Steady motion from where the object starts, or none. The rate is that of the servo.
std::shared_ptr<const Motion> read_motion(TableReader& object, const Placement& start, double rate_hz,
                                          FileMessages& messages);

} // namespace haptel::runtime
