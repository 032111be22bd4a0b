// One wheel or stick as Linux shows it: /dev/input/event*, read for its axes, written for force feedback. The kernel
// stands behind it, or a wheel in memory in tests.
#pragma once

#include "device/axes/axis_port.h"
#include "device/refusal.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace haptel::device {

struct AxisEvent {
    int axis = 0; // 0: x, 1: y
    int value = 0;
};

// Functions that may fail return an errno, 0 if they did not. One thread uses it.
class InputPort {
public:
    virtual ~InputPort() = default; // the kernel takes all forces away with it
    virtual bool has_constant_force() const = 0;
    virtual std::optional<AxisRange> axis(int axis) const = 0; // nothing: it has no such axis
    // A constant force along an axis, of -1 .. 1 of what the device can do. The first makes the effect, later ones
    // change its level alone.
    virtual int set_level(int axis, double level) = 0;
    virtual int play(int axis) = 0; // makes the level felt; again before it is over
    virtual int prepare() = 0;      // full gain, no spring of its own
    // What a guard needs: the open file, and the bytes that end the effects made so far. -1: there is no file.
    virtual int file_descriptor() const { return -1; }
    virtual std::vector<uint8_t> last_word() const { return {}; }
    // Until something is to be read or the time limit.
    virtual int read(std::vector<AxisEvent>& events, int timeout_ms) = 0;
};

struct OpenedInput {
    std::unique_ptr<InputPort> port; // null: see error
    std::string error;               // in words, with what to do about it
    bool absent = false;             // there is no such file: it may come back
};

OpenedInput open_input_port(const std::string& path);

struct ListedInput {
    std::string path, name;
    int axes = 0; // that can be pushed along; 0: not known
    Refusal refused;
};

// Of /dev/input: those with force feedback, and those that cannot be looked at but have a stick or a wheel by their
// link in by-id.
std::vector<ListedInput> list_input_ports();

} // namespace haptel::device
