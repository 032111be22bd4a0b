// Opens a Novint Falcon. That does not wait: the device is not ready until its program runs and its arms are homed.
#pragma once

#include "device/falcon/falcon_device.h"
#include "device/usb/usb_devices.h"
#include "runtime/hand/haptic_device.h"

#include <filesystem>
#include <string_view>

namespace haptel::device {

inline constexpr UsbIds falcon_ids{0x0403, 0xcb48};

// The one of that serial number, or any if it is empty. An error if none can be opened now, or if the firmware's file
// is no firmware. `firmware`: the file; empty: where read_falcon_firmware() looks.
runtime::DeviceResult open_falcon(const runtime::DeviceRequest& request, std::string_view serial,
                                  const std::filesystem::path& firmware = {});

// One that somebody else has opened: the file descriptor stays open, and stays theirs.
runtime::DeviceResult open_falcon(const runtime::DeviceRequest& request, int file_descriptor,
                                  const std::filesystem::path& firmware = {});

// Those connected, with serial numbers, or why they cannot be opened.
UsbList list_falcons();

} // namespace haptel::device
