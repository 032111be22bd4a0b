// The parts of a scene file that say which hands reach into the scene, and how.
#pragma once

#include "runtime/files/table_reader.h"
#include "runtime/hand/hand.h"
#include "runtime/hand/haptic_device.h"

#include <array>
#include <filesystem>
#include <vector>

namespace haptel::runtime {

struct DeviceText {
    DeviceRequest request; // without what the scene's geometry says
    HandSettings hand;     // with a probe: what the device is opened with, whatever scene comes later
    // Where the parts of the request are written, or what they belong to; by DeviceKey.
    std::array<toml::source_region, 6> at;
    const toml::source_region& where(DeviceKey key) const { return at[static_cast<std::size_t>(key)]; }
};

ProbeSettings read_probe(const toml::table& source, const std::string& name, FileMessages& messages);

// `[device]` or each `[[device]]`, with the scene's `[workspace]` and probe where one has none of its own; one device
// by default where there is no table.
std::vector<DeviceText> read_devices(const toml::table& root, const ProbeSettings& probe,
                                     const std::filesystem::path& folder, FileMessages& messages);

} // namespace haptel::runtime
