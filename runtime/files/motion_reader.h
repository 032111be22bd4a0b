// The part of a scene file that says how an object moves.
#pragma once

#include "runtime/files/table_reader.h"
#include "runtime/scene/motion.h"

#include <memory>

namespace haptel::runtime {

struct MotionText {
    std::shared_ptr<const Motion> motion; // steady, from where the object starts; or none
    double swing_m = 0;                   // to either side
    toml::source_region swing_at;
};

// The rate is that of the servo.
MotionText read_motion(TableReader& object, const Placement& start, double rate_hz, FileMessages& messages);

} // namespace haptel::runtime
