// A USB made of fake devices, as libusb finds it in /sys and /dev and as the kernel answers for it there: umockdev
// shows it to this process and to those that it starts. For what is there, who may open it and who holds it; slow, so
// not for times, nor for programs that are killed within a transfer. Programs run with libumockdev-preload.so.0
// preloaded, or skip themselves.
#pragma once

#include "tests/device/usb/fake_usb_device.h"

#include <memory>
#include <string>
#include <vector>

namespace haptel::device {

class UsbBus {
public:
    UsbBus();
    ~UsbBus();
    UsbBus(const UsbBus&) = delete;
    UsbBus& operator=(const UsbBus&) = delete;

    // On bus 1, with that address: from 2 on, each only once. `kernel_driver` has its interfaces until somebody takes
    // them off it.
    void plug(FakeUsbDevice& device, int address, std::string serial, std::string kernel_driver = "");
    void unplug(int address);
    void forbid(int address); // nobody may open it, but for those who may all
    bool is_held(int address) const;
    bool kernel_has(int address) const; // its interfaces

private:
    struct Port;
    Port& port(int address) const;
    std::string folder_of(int address) const; // in /sys
    std::string node_of(int address) const;

    struct Testbed;
    std::unique_ptr<Testbed> testbed_;
    std::vector<std::unique_ptr<Port>> ports_;
};

} // namespace haptel::device
