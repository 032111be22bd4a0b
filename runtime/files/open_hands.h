// The hands of a scene file: their devices, opened where the scene's first object lies.
#pragma once

#include "runtime/files/device_reader.h"
#include "runtime/files/scene_file.h"
#include "runtime/files/table_reader.h"
#include "runtime/scene/scene.h"

#include <memory>
#include <span>
#include <vector>

namespace haptel::runtime {

// One for each device that could be opened, why not for each other; none without a factory. Completes the requests.
// `stiffness_at`: where that of each object is written.
std::vector<LoadedHand> open_hands(std::vector<DeviceText>& texts, const std::shared_ptr<const Scene>& scene,
                                   std::span<const toml::source_region> stiffness_at, const DeviceFactory& devices,
                                   FileMessages& messages);

} // namespace haptel::runtime
