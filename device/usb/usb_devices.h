// Which USB devices of a kind are connected, and whether they can be opened.
#pragma once

#include "device/refusal.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

struct libusb_device;

namespace haptel::device {

struct UsbIds {
    uint16_t vendor = 0, product = 0;
    bool operator==(const UsbIds&) const = default;
};

struct UsbListed {
    std::string serial; // empty: it has none, or cannot be opened
    int bus = 0, address = 0;
    Refusal refused;
};

struct UsbList {
    std::vector<UsbListed> devices;
    std::string error; // the list itself could not be made
};

// `interface`: of each, that a driver would claim. A driver of the kernel keeps it: one can be taken off it.
UsbList list_usb_devices(const UsbIds& ids, int interface);

// What to tell the user when opening or claiming fails with this libusb_error.
Refusal usb_open_failure(int libusb_code, UsbIds ids, int bus, int address);

// The names of other programs that have the device open, as far as this user may see them: "gimp (1234)".
std::string usb_device_users(int bus, int address);

} // namespace haptel::device
