// What no device says of itself: how far the hand goes, and how hard it is pushed. Written behind its name, as in
// "evdev:FILE,travel_m=0.4,force_max_n=15".
#pragma once

#include <string>
#include <string_view>

namespace haptel::device {

struct AxisSettings {
    double travel_m = 0.2;   // of the hand, from end to end of each axis
    double force_max_n = 10; // on the hand, at full level
    int axes = 1;
};

struct AxisText {
    std::string what; // before the first comma
    AxisSettings settings;
    std::string error;
};

// `example`: of the driver that the text is of, for its messages.
AxisText read_axis_text(std::string_view text, std::string_view example);

} // namespace haptel::device
