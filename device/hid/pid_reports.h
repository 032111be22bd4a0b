// The reports by which a device of the USB's Physical Interface class (PID 1.0) is read and pushed with one constant
// force along each axis, found by their usages. Bytes alone: nothing is sent here.
#pragma once

#include "device/axes/axis_port.h"
#include "device/hid/hid_descriptor.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace haptel::device {

// One transfer with its report's id in front, where there is one.
struct PidReport {
    HidKind kind = HidKind::output;
    uint8_t id = 0;
    std::size_t size = 0;
    std::array<uint8_t, 64> bytes{};
    std::span<const uint8_t> span() const { return {bytes.data(), size}; }
};

enum class PidControl : uint8_t { enable_actuators, stop_all, reset };

enum class PidLoaded : uint8_t { no, yes, full, failed };
struct PidBlock {
    PidLoaded loaded = PidLoaded::no; // no: not yet
    uint8_t index = 0;
};

class PidReports {
public:
    // What the device lacks to be pushed by a servo, in words; empty: nothing.
    static std::string lacking(const HidDescriptor& descriptor);
    // Of a descriptor that lacks nothing.
    explicit PidReports(const HidDescriptor& descriptor);

    int axes() const { return axes_; } // that are sensed and pushed
    AxisRange range(int axis) const;
    std::optional<int64_t> place(int axis, std::span<const uint8_t> transfer) const noexcept;
    std::size_t input_bytes() const { return input_bytes_; } // of the longest

    PidReport control(PidControl what) const;
    std::optional<PidReport> full_gain() const; // nothing: it has no gain
    PidReport new_constant_force() const;
    PidReport ask_block() const; // to be read: its size and id
    PidBlock block(std::span<const uint8_t> transfer) const noexcept;
    PidReport endless_effect(uint8_t block, int axis) const;
    PidReport start(uint8_t block) const;
    // -1 .. 1; what is no number is 0.
    PidReport constant_force(uint8_t block, double level) const noexcept;
    int64_t level_counts(double level) const noexcept;

private:
    struct Effect { // Set Effect
        HidField block, type;
        std::optional<HidField> duration, gain, direction, direction_enable;
        std::array<std::optional<HidField>, axes_max> axis_enable;
    };

    PidReport begin(const HidField& field) const noexcept;

    HidDescriptor descriptor_;
    int axes_ = 0;
    std::array<HidField, axes_max> place_;
    std::size_t input_bytes_ = 0;
    Effect effect_;
    HidField new_type_, loaded_block_, force_block_, force_, run_block_, run_;
    std::optional<HidField> loaded_, loops_, gain_;
    std::array<HidField, 3> controls_;
    std::size_t force_bytes_ = 0;
};

} // namespace haptel::device
