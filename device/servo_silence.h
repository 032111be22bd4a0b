// When a driver takes the force away because its servo was stopped, killed or is stuck: nobody knows then where the
// hand goes.
#pragma once

#include <algorithm>
#include <cmath>

namespace haptel::device {

// Milliseconds without a command: 3, so that no force stands 5 ms after the servo's last tick: the driver looks every
// millisecond, and its last word waits for a frame of the bus, another one. Two and a half periods where that is more,
// so that a slow servo is not silent between two of its ticks.
inline int servo_silence_ms(double rate_hz)
{
    return std::max(3, static_cast<int>(std::ceil(2500 / rate_hz)));
}

} // namespace haptel::device
