// Where on a USB device a HID interface is: what its configuration descriptor says (USB 2.0, section 9.6; HID 1.11,
// section 6.2.1).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace haptel::device {

struct HidInterface {
    int number = 0;
    uint8_t in_endpoint = 0, out_endpoint = 0; // interrupt; 0: it has none
    std::size_t packet_bytes = 64;             // of the IN endpoint
    std::size_t descriptor_bytes = 0;          // of its reports
};

std::vector<HidInterface> hid_interfaces(std::span<const uint8_t> configuration);

} // namespace haptel::device
