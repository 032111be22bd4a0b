#include "device/usb/usb_devices.h"

#include "device/guard/force_guard.h"
#include "device/usb/usb_context.h"
#include "device/usb/usb_handle.h"

#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <libusb.h>
#include <sys/stat.h>
#include <unistd.h>

namespace haptel::device {

namespace {

// To hold an interface, for the kernel, is to have a driver that is none of its own.
bool is_held_by_program(libusb_device_handle* handle, int interface)
{
    const int code = libusb_claim_interface(handle, interface);
    if (code == LIBUSB_SUCCESS) libusb_release_interface(handle, interface);
    return code == LIBUSB_ERROR_BUSY && libusb_kernel_driver_active(handle, interface) == 0;
}

UsbListed listed(libusb_device* device, const UsbIds& ids, int interface)
{
    UsbListed entry;
    entry.bus = libusb_get_bus_number(device);
    entry.address = libusb_get_device_address(device);
    int code = LIBUSB_SUCCESS;
    const UsbHandle handle = open_usb_handle(device, code);
    if (handle) {
        entry.serial = usb_serial(handle.get());
        if (is_held_by_program(handle.get(), interface)) code = LIBUSB_ERROR_BUSY;
    }
    if (code != LIBUSB_SUCCESS) entry.refused = usb_open_failure(code, ids, entry.bus, entry.address);
    return entry;
}

} // namespace

UsbList list_usb_devices(const UsbIds& ids, int interface)
{
    UsbList list;
    const UsbContext context = make_usb_context(UsbDiscovery::on, list.error);
    if (!context) return list;
    for (const UsbDevicePtr& device : usb_devices(context.get()))
        if (usb_ids(device.get()) == ids) list.devices.push_back(listed(device.get(), ids, interface));
    return list;
}

Refusal usb_open_failure(int libusb_code, UsbIds ids, int bus, int address)
{
    const std::string place =
        fmt::format("USB device {:04x}:{:04x} (bus {}, device {})", ids.vendor, ids.product, bus, address);
    switch (usb_error(libusb_code)) {
    case UsbError::denied:
        return {place + ": no permission to open it",
                "Install the udev rule (device/udev/60-haptel.rules into /etc/udev/rules.d), run `udevadm control "
                "--reload` as root and plug the device in again"};
    case UsbError::busy: {
        const std::string users = usb_device_users(bus, address);
        return {fmt::format("{}: in use by {}", place, users.empty() ? "another program" : users), "Close that first"};
    }
    case UsbError::gone: return {place + ": it was unplugged", "Plug it in again"};
    case UsbError::not_found:
        return {place + ": it lacks the interface that this driver talks to", "Does it run its maker's firmware?"};
    default:
        return {fmt::format("{}: cannot be opened ({})", place, libusb_error_name(libusb_code)),
                "Unplug it and plug it in again"};
    }
}

// Who holds a file open is told by the links in /proc/PID/fd, by whatever name they opened it.
std::string usb_device_users(int bus, int address)
{
    namespace fs = std::filesystem;
    struct stat node{}, held{};
    if (stat(fmt::format("/dev/bus/usb/{:03}/{:03}", bus, address).c_str(), &node) != 0) return "";
    std::string users;
    std::error_code none;
    for (fs::directory_iterator process("/proc", none), end; process != end; process.increment(none)) {
        const std::string id = process->path().filename();
        if (id.find_first_not_of("0123456789") != id.npos || id == std::to_string(getpid())) continue;
        for (fs::directory_iterator open(process->path() / "fd", none); !none && open != end; open.increment(none)) {
            if (stat(open->path().c_str(), &held) != 0 || held.st_dev != node.st_dev || held.st_ino != node.st_ino)
                continue;
            std::string name;
            std::getline(std::ifstream(process->path() / "comm"), name);
            if (name == guard_process_name) break; // of somebody who is listed, or of this program
            users += fmt::format("{}{} (process {})", users.empty() ? "" : ", ", name, id);
            break;
        }
        none.clear();
    }
    return users;
}

} // namespace haptel::device
