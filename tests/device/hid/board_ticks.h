// A servo for tests of an OpenFFBoard: it ticks until something comes about.
#pragma once

#include "device/axes/axis_device.h"
#include "device/hid/open_hid.h"
#include "device/hid/pid_axes.h"
#include "tests/device/hid/fake_board.h"
#include "tests/device/usb/fake_transport.h"

#include <chrono>
#include <functional>
#include <thread>

namespace haptel::device {

inline const glm::dvec3 no_force(0), no_torque(0);

// Long enough for any machine; what is waited for comes within moments.
inline bool ticks_until(runtime::HapticDevice& device, const glm::dvec3& force_n,
                        const std::function<bool(runtime::DeviceStatus, const runtime::DevicePose&)>& happens)
{
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(15);
    while (std::chrono::steady_clock::now() < deadline) {
        runtime::DevicePose pose;
        const runtime::DeviceStatus status = device.read(pose);
        device.write(force_n, no_torque);
        if (happens(status, pose)) return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return false;
}

inline bool becomes(runtime::HapticDevice& device, runtime::DeviceStatus status)
{
    return ticks_until(device, no_force, [status](runtime::DeviceStatus now, auto&) { return now == status; });
}

inline constexpr AxisTimes quick_axes{.watchdog_ms = 200, .nudge_ms = 60, .again_ms = 5, .patience_s = 1};
inline constexpr PidTimes quick_pid{.transfer_ms = 20, .load_ms = 50, .poll_ms = 1};
inline OpenAxes open_board(FakeBoard& board)
{
    const OpenInterface open = [&board](int) -> OpenedTransport {
        std::size_t size = 0;
        std::array<uint8_t, 64> bytes{};
        if (board.in(bytes, size) == FakeUsbDevice::Answer::gone)
            return {nullptr, UsbError::not_found, "it is not there"};
        return {std::make_unique<FakeTransport>(board, 1), UsbError::none, {}};
    };
    return [open] { return open_pid_axes(open, openffboard_interface, quick_pid); };
}

inline constexpr AxisSettings board_settings{.travel_m = 0.4, .force_max_n = 20, .axes = 2};

} // namespace haptel::device
