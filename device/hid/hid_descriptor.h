// What a HID device says of its reports: which bits of which report mean what (Device Class Definition for HID 1.11,
// section 6.2.2). A device may say anything; what is read here lies within its report and within bounds, or is left
// out.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace haptel::device {

enum class HidKind : uint8_t { input = 1, output = 2, feature = 3 }; // as in GET_REPORT and SET_REPORT

using HidUsage = uint32_t; // page << 16 | number

struct HidField {
    HidKind kind = HidKind::input;
    uint8_t report = 0; // id; 0: the device has one report of each kind, without ids
    uint32_t bit = 0;   // of the transfer, whose first byte is the id where there are ids
    uint8_t bits = 0;   // 1 .. 32
    int64_t minimum = 0, maximum = 0;
    bool selects = false;         // its value is the number of a usage, counted from `minimum`
    std::vector<HidUsage> usages; // one, or those that it selects from
    uint32_t collection = 0;      // the innermost one around it
};

struct HidCollection {
    HidUsage usage = 0;
    uint32_t parent = 0; // itself: there is none
};

struct HidReport {
    HidKind kind = HidKind::input;
    uint8_t id = 0;
    uint32_t bits = 0; // with the id
    std::size_t bytes() const { return (bits + 7) / 8; }
};

struct HidDescriptor {
    std::vector<HidField> fields;
    std::vector<HidCollection> collections; // the first is the whole device, without a usage
    std::vector<HidReport> reports;
    std::string error; // why it cannot be used, in words

    // The first of this usage, or that selects it, anywhere inside a collection of the usage `within` (0: anywhere).
    const HidField* find(HidKind kind, HidUsage within, HidUsage usage) const;
    std::size_t report_bytes(HidKind kind, uint8_t id) const; // with the id; 0: it has none
    std::size_t longest(HidKind kind) const;
};

inline constexpr std::size_t hid_descriptor_bytes_max = 4096;
inline constexpr std::size_t hid_report_bytes_max = 1024;

HidDescriptor read_hid_descriptor(std::span<const uint8_t> bytes);

// Of a whole transfer. Nothing if it is another report or too short, or if a value is none of the field's range.
std::optional<int64_t> hid_value(const HidField& field, std::span<const uint8_t> transfer) noexcept;

// A transfer that is too short stays as it is.
void put_hid_bits(const HidField& field, std::span<uint8_t> transfer, uint64_t bits) noexcept;
// Limited to the field's range.
void put_hid_value(const HidField& field, std::span<uint8_t> transfer, int64_t value) noexcept;

// The value by which a field says this usage: 1 of one of its own, the number of one that it selects.
std::optional<int64_t> hid_choice(const HidField& field, HidUsage usage) noexcept;

} // namespace haptel::device
