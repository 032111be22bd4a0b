#include "device/hid/pid_reports.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace haptel::device {

namespace {

constexpr HidUsage pid(uint16_t number)
{
    return 0x000f0000U | number;
}
constexpr std::array<HidUsage, axes_max> axis_usages = {0x00010030, 0x00010031}; // Generic Desktop: X, Y
constexpr HidUsage first_ordinal = 0x000a0001;                                   // Ordinals: Instance 1

constexpr HidUsage set_effect = pid(0x21), block_index = pid(0x22), constant_type = pid(0x26);
constexpr HidUsage duration = pid(0x50), effect_gain = pid(0x52);
constexpr HidUsage axes_enable = pid(0x55), direction_enable = pid(0x56), direction = pid(0x57);
constexpr HidUsage set_constant_force = pid(0x73), magnitude = pid(0x70);
constexpr HidUsage effect_operation = pid(0x77), operation_start = pid(0x79), loop_count = pid(0x7c);
constexpr HidUsage device_gain_report = pid(0x7d), device_gain = pid(0x7e);
constexpr HidUsage block_load = pid(0x89), load_success = pid(0x8c), load_full = pid(0x8d);
constexpr HidUsage create_new_effect = pid(0xab);
// As in PidControl.
constexpr std::array<HidUsage, 3> controls = {pid(0x97), pid(0x99), pid(0x9a)};

struct Needed {
    HidKind kind;
    HidUsage within, usage;
    const char* name;
};
constexpr Needed needed[] = {
    {HidKind::input, 0, axis_usages[0], "an axis X to feel along"},
    {HidKind::output, set_effect, block_index, "Set Effect"},
    {HidKind::output, set_effect, constant_type, "an effect of the type Constant Force"},
    {HidKind::output, set_constant_force, block_index, "Set Constant Force"},
    {HidKind::output, set_constant_force, magnitude, "a magnitude of Set Constant Force"},
    {HidKind::output, effect_operation, block_index, "Effect Operation"},
    {HidKind::output, effect_operation, operation_start, "Effect Start"},
    {HidKind::output, 0, controls[0], "Enable Actuators"},
    {HidKind::output, 0, controls[1], "Stop All Effects"},
    {HidKind::output, 0, controls[2], "Device Reset"},
    {HidKind::feature, create_new_effect, constant_type, "Create New Effect"},
    {HidKind::feature, block_load, block_index, "Block Load"},
};

std::optional<HidField> copy(const HidField* field)
{
    return field ? std::optional(*field) : std::nullopt;
}

// A quarter of a circle that is one step longer than the greatest angle: 64 of 0 .. 255, 9000 of 0 .. 35999.
int64_t quarter(const HidField& angle)
{
    return angle.minimum + (angle.maximum - angle.minimum + 1) / 4;
}

void choose(const HidField& field, PidReport& report, HidUsage usage)
{
    if (const auto value = hid_choice(field, usage)) put_hid_value(field, {report.bytes.data(), report.size}, *value);
}

} // namespace

std::string PidReports::lacking(const HidDescriptor& descriptor)
{
    if (!descriptor.error.empty()) return descriptor.error;
    for (const Needed& each : needed) {
        const HidField* field = descriptor.find(each.kind, each.within, each.usage);
        if (!field) return fmt::format("its reports lack {}: it is no device of the class PID", each.name);
        if (each.kind != HidKind::input && descriptor.report_bytes(each.kind, field->report) > sizeof(PidReport::bytes))
            return fmt::format("its report with {} is longer than one packet", each.name);
    }
    const HidField& place = *descriptor.find(HidKind::input, 0, axis_usages[0]);
    if (place.maximum <= place.minimum) return "its axis X has no range";
    const HidField& force = *descriptor.find(HidKind::output, set_constant_force, magnitude);
    if (force.minimum >= 0 || force.maximum <= 0) return "its constant force pushes one way only";
    return "";
}

PidReports::PidReports(const HidDescriptor& descriptor) : descriptor_(descriptor)
{
    const auto find = [&](HidKind kind, HidUsage within, HidUsage usage) {
        return copy(descriptor_.find(kind, within, usage)).value_or(HidField{});
    };
    const auto optional = [&](HidUsage within, HidUsage usage) {
        return copy(descriptor_.find(HidKind::output, within, usage));
    };
    effect_ = {find(HidKind::output, set_effect, block_index),
               find(HidKind::output, set_effect, constant_type),
               optional(set_effect, duration),
               optional(set_effect, effect_gain),
               {},
               optional(set_effect, direction_enable),
               {}};
    // Type Specific Block Offset has ordinals as well.
    for (const HidField& field : descriptor_.fields)
        if (!effect_.direction && field.kind == HidKind::output && field.report == effect_.block.report &&
            field.usages.front() == first_ordinal && descriptor_.collections[field.collection].usage == direction)
            effect_.direction = field;
    if (!effect_.direction) effect_.direction = optional(set_effect, direction);
    for (std::size_t i = 0; i < axes_max; ++i) {
        place_[i] = find(HidKind::input, 0, axis_usages[i]);
        effect_.axis_enable[i] = optional(axes_enable, axis_usages[i]);
    }
    // Many sense a second axis, the pedals of a wheel, that has no motor.
    const bool two = place_[1].maximum > place_[1].minimum && effect_.axis_enable[1] &&
                     (effect_.direction || !effect_.direction_enable);
    axes_ = two ? 2 : 1;
    input_bytes_ = descriptor_.longest(HidKind::input);

    new_type_ = find(HidKind::feature, create_new_effect, constant_type);
    loaded_block_ = find(HidKind::feature, block_load, block_index);
    loaded_ = copy(descriptor_.find(HidKind::feature, block_load, load_success));
    force_block_ = find(HidKind::output, set_constant_force, block_index);
    force_ = find(HidKind::output, set_constant_force, magnitude);
    run_block_ = find(HidKind::output, effect_operation, block_index);
    run_ = find(HidKind::output, effect_operation, operation_start);
    loops_ = optional(effect_operation, loop_count);
    gain_ = optional(device_gain_report, device_gain);
    for (std::size_t i = 0; i < controls_.size(); ++i) controls_[i] = find(HidKind::output, 0, controls[i]);
    force_bytes_ = descriptor_.report_bytes(HidKind::output, force_.report);
}

AxisRange PidReports::range(int axis) const
{
    const HidField& field = place_[static_cast<std::size_t>(axis)];
    return {field.minimum, field.maximum, std::nullopt};
}

std::optional<int64_t> PidReports::place(int axis, std::span<const uint8_t> transfer) const noexcept
{
    return hid_value(place_[static_cast<std::size_t>(axis)], transfer);
}

PidReport PidReports::begin(const HidField& field) const noexcept
{
    PidReport report{field.kind, field.report, 0, {}};
    report.size = std::min(descriptor_.report_bytes(field.kind, field.report), report.bytes.size());
    report.bytes[0] = field.report; // 0 where there are no ids: overwritten
    return report;
}

PidReport PidReports::control(PidControl what) const
{
    const auto at = static_cast<std::size_t>(what);
    PidReport report = begin(controls_[at]);
    choose(controls_[at], report, controls[at]);
    return report;
}

std::optional<PidReport> PidReports::full_gain() const
{
    if (!gain_) return std::nullopt;
    PidReport report = begin(*gain_);
    put_hid_value(*gain_, {report.bytes.data(), report.size}, gain_->maximum);
    return report;
}

PidReport PidReports::new_constant_force() const
{
    PidReport report = begin(new_type_);
    choose(new_type_, report, constant_type);
    return report;
}

PidReport PidReports::ask_block() const
{
    return begin(loaded_block_);
}

PidBlock PidReports::block(std::span<const uint8_t> transfer) const noexcept
{
    if (loaded_) {
        const auto status = hid_value(*loaded_, transfer);
        if (!status) return {};
        if (status == hid_choice(*loaded_, load_full)) return {PidLoaded::full, 0};
        if (status != hid_choice(*loaded_, load_success)) return {PidLoaded::failed, 0};
    }
    // An index that the device does not know of is no block.
    const auto index = hid_value(loaded_block_, transfer);
    if (!index || *index < 1 || *index > 255) return {PidLoaded::failed, 0};
    return {PidLoaded::yes, static_cast<uint8_t>(*index)};
}

// Along x is towards the east of a compass, along y towards its north; the nudge finds out what is meant by it.
PidReport PidReports::endless_effect(uint8_t block, int axis) const
{
    const auto at = static_cast<std::size_t>(axis);
    PidReport report = begin(effect_.block);
    const std::span<uint8_t> bytes(report.bytes.data(), report.size);
    put_hid_value(effect_.block, bytes, block);
    choose(effect_.type, report, constant_type);
    if (effect_.duration) put_hid_bits(*effect_.duration, bytes, ~uint64_t{0}); // all ones: without end
    if (effect_.gain) put_hid_value(*effect_.gain, bytes, effect_.gain->maximum);
    if (effect_.axis_enable[at]) put_hid_value(*effect_.axis_enable[at], bytes, 1);
    if (effect_.direction_enable) put_hid_value(*effect_.direction_enable, bytes, 1);
    if (effect_.direction)
        put_hid_value(*effect_.direction, bytes, axis == 0 ? quarter(*effect_.direction) : effect_.direction->minimum);
    return report;
}

PidReport PidReports::start(uint8_t block) const
{
    PidReport report = begin(run_block_);
    const std::span<uint8_t> bytes(report.bytes.data(), report.size);
    put_hid_value(run_block_, bytes, block);
    choose(run_, report, operation_start);
    if (loops_) put_hid_value(*loops_, bytes, 1);
    return report;
}

int64_t PidReports::level_counts(double level) const noexcept
{
    if (!(std::fabs(level) <= 1)) level = level > 1 ? 1 : level < -1 ? -1 : 0;
    // as far one way as the other
    return std::llround(level * static_cast<double>(std::min(force_.maximum, -force_.minimum)));
}

PidReport PidReports::constant_force(uint8_t block, double level) const noexcept
{
    PidReport report{HidKind::output, force_.report, std::min(force_bytes_, sizeof(report.bytes)), {}};
    report.bytes[0] = force_.report;
    const std::span<uint8_t> bytes(report.bytes.data(), report.size);
    put_hid_value(force_block_, bytes, block);
    put_hid_value(force_, bytes, level_counts(level));
    return report;
}

} // namespace haptel::device
