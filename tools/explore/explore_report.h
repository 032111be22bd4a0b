// What an exploration was like, for scripts and for people.
#pragma once

#include "runtime/hand/haptic_device.h"
#include "runtime/servo/servo_report.h"
#include "runtime/servo/telemetry.h"
#include "tools/output/json.h"

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace haptel::tools {

// Least and greatest height of textures below a hand while it touched, metres of the hand's own space.
struct HeightRange {
    double minimum_m = std::numeric_limits<double>::infinity(), maximum_m = -minimum_m;

    void add(const runtime::TickRecord& tick, double scale); // of its workspace
    double width_m() const { return maximum_m > minimum_m ? maximum_m - minimum_m : 0; }
};

// The longest time for which a hand was below a surface and felt nothing.
struct UnfeltContact {
    uint64_t ticks = 0;
    double depth_m = 0; // the most below the surface in that time, metres of the hand's own space

    void add(const runtime::TickRecord& tick, double scale); // of its workspace

private:
    uint64_t run_ticks_ = 0;
    double run_depth_m_ = 0;
};

// One hand of the exploration.
struct HandOutcome {
    runtime::DeviceInfo device; // named as on the command line or in the scene
    runtime::ServoReport servo;
    HeightRange heights;
    UnfeltContact unfelt;

    // The texture is less than two of the device's position steps high: the force jumps by a step as much as by the
    // texture.
    bool hides_texture() const;
    double unfelt_s() const { return servo.rate_hz > 0 ? static_cast<double>(unfelt.ticks) / servo.rate_hz : 0; }
    // Longer than a tap: whoever touches for so long waits for a force.
    bool feels_nothing() const { return unfelt_s() >= 0.2; }
};

struct ExploreOutcome {
    std::string scene;
    std::string clock;              // "wall" | "virtual"
    std::vector<HandOutcome> hands; // at least one, in the order of the scene
    uint64_t textures_compiled = 0; // at the start and on reloads
};

// The fields that the command promises to scripts, those of the first device, and a few more; `devices` has all.
Json to_json(const ExploreOutcome& outcome);

// A dozen lines for a person, the important first.
std::string to_lines(const ExploreOutcome& outcome);

} // namespace haptel::tools
