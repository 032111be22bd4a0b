// Messages that claim to come from the Inverse3 service.
#include "device/inverse3/inverse3_message.h"
#include "tests/fuzz/target.h"

#include <cmath>

namespace haptel::fuzz {

using namespace haptel::device;

void hear_inverse3(std::string_view bytes)
{
    const Inverse3Inventory inventory = read_inverse3_inventory(bytes);
    for (const Inverse3Listed& device : inventory.devices)
        if (!is_inverse3_id(device.id)) fail("an id that is none");
    if (!inventory.error.empty() && !inventory.devices.empty()) fail("devices beside an error");
    count("devices", inventory.devices.size());
    const Inverse3Reply reply = read_inverse3_state(bytes, "049D");
    if (reply.heard != Inverse3Heard::state) return;
    count("states");
    for (int i = 0; i < 3; ++i)
        if (!std::isfinite(reply.state.position_m[i]) || std::fabs(reply.state.position_m[i]) > 10)
            fail("a place that no device reaches");
}

std::vector<std::string> inverse3_corpus()
{
    return {
        R"({"inverse3":[{"device_id":"049D","config":{"preset":"arm_front_centered"},"state":{"cursor_position":)"
        R"({"x":0.01,"y":-0.12,"z":1.5e-1},"cursor_velocity":{"x":1,"y":2,"z":-3.5}}}]})",
        R"({"inverse3":[{"device_id":"A"},{"device_id":"049D","state":{"cursor_position":{"x":0,"y":0,"z":1e999}}}]})",
        R"({"inverse3":[],"wireless_verse_grip":[],"session_id":12})"};
}

} // namespace haptel::fuzz
