// vm_tests does nothing where the kernel offers no devices made of bytes, or not to this user.
#include "tests/device/usb/usbip_port.h"

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <unistd.h>

namespace haptel::device {

namespace {

constexpr int skipped = 77; // as the property SKIP_RETURN_CODE of the test tells CTest

// Before main(), for Catch2's knows no such end.
[[maybe_unused]] const bool kernel_is_there = [] {
    std::string missing = UsbipPort::missing();
    if (missing.empty() && access("/dev/uinput", W_OK) != 0)
        missing = std::string("expected to write /dev/uinput, found: ") + std::strerror(errno) + ". `modprobe uinput`";
    if (missing.empty()) return true;
    std::fprintf(stderr, "vm_tests: skipped. %s\n", missing.c_str());
    std::_Exit(skipped);
}();

} // namespace

} // namespace haptel::device
