#include "device/hid/hid_interface.h"

namespace haptel::device {

namespace {

constexpr uint8_t interface_type = 4, endpoint_type = 5, hid_type = 0x21, report_type = 0x22;
constexpr uint8_t hid_class = 3, interrupt = 3;

} // namespace

std::vector<HidInterface> hid_interfaces(std::span<const uint8_t> configuration)
{
    std::vector<HidInterface> found;
    bool inside = false;
    for (std::size_t at = 0; configuration.size() - at >= 2;) {
        const std::size_t size = configuration[at];
        if (size < 2 || size > configuration.size() - at) break;
        const auto part = configuration.subspan(at, size);
        at += size;
        if (part[1] == interface_type && size >= 9) {
            inside = part[5] == hid_class && part[3] == 0; // not of another setting
            if (inside) found.push_back({part[2]});
        } else if (inside && part[1] == hid_type && size >= 9 && part[6] == report_type) {
            found.back().descriptor_bytes = static_cast<std::size_t>(part[7] | part[8] << 8);
        } else if (inside && part[1] == endpoint_type && size >= 7 && (part[3] & 3) == interrupt) {
            HidInterface& last = found.back();
            uint8_t& endpoint = part[2] & 0x80 ? last.in_endpoint : last.out_endpoint;
            if (endpoint != 0) continue;
            endpoint = part[2];
            if (part[2] & 0x80) last.packet_bytes = static_cast<std::size_t>((part[4] | part[5] << 8) & 0x7ff);
        }
    }
    return found;
}

} // namespace haptel::device
