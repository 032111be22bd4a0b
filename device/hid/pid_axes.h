// The axes of a device of the class PID on the USB: brought up with one endless constant force along each, of which one
// report per change says how strong it is.
#pragma once

#include "device/axes/axis_port.h"
#include "device/hid/hid_interface.h"
#include "device/hid/pid_reports.h"
#include "device/usb/transport.h"

#include <functional>
#include <memory>

namespace haptel::device {

struct PidTimes {
    int transfer_ms = 100; // for each of the bring-up
    int load_ms = 500;     // for the device to make room for an effect
    int poll_ms = 5;       // between two questions whether it has
    int replay_ms = 1000;  // an effect is started again, before a device ends it
};

std::unique_ptr<AxisPort> make_pid_axes(std::unique_ptr<Transport> transport, const HidInterface& at,
                                        const PidReports& reports, const PidTimes& times);

// Of one device, an interface of that number.
using OpenInterface = std::function<OpenedTransport(int number)>;

// Looks for the interface that can be pushed, at the one of the number `first` to begin with. What cannot be used now
// may be there later.
OpenedAxes open_pid_axes(const OpenInterface& open, int first, const PidTimes& times);

} // namespace haptel::device
