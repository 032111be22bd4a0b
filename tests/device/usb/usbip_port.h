// A FakeUsbDevice plugged into the real kernel: its virtual host controller (vhci_hcd) takes a socket for a cable, and
// USB/IP is spoken over it (Linux: Documentation/usb/usbip_protocol.rst). All that the kernel does about a device on
// the USB it does about this one. Needs root, and a kernel with vhci_hcd.
#pragma once

#include "tests/device/usb/fake_usb_device.h"

#include <array>
#include <deque>
#include <filesystem>
#include <string>
#include <thread>

namespace haptel::device {

// As UsbfsShim: an IN transfer completes when the bus has a frame for it, each millisecond, with the bytes that are
// there by then. So does an OUT transfer of an interrupt endpoint; others are done at once.
class UsbipPort {
public:
    // Why this machine cannot do so, and how to mend it; empty: it can.
    static std::string missing();

    // Comes back when the kernel has configured the device and made its file, or throws what it waited for in vain.
    UsbipPort(FakeUsbDevice& device, std::string serial);
    ~UsbipPort(); // unplugged; the kernel has forgotten the device
    UsbipPort(const UsbipPort&) = delete;
    UsbipPort& operator=(const UsbipPort&) = delete;

    const std::filesystem::path& in_sysfs() const { return in_sysfs_; } // /sys/bus/usb/devices/3-1
    std::string kernel_driver(int interface) const;                     // "usbhid"; empty: none has the interface

private:
    struct Header { // 48 bytes: numbers with the highest byte first, and a control request
        std::array<uint8_t, 48> bytes{};
        uint32_t number(std::size_t at) const;
        void put(std::size_t at, uint32_t number);
    };
    struct Transfer {
        Header asked;
        std::vector<uint8_t> data;
    };
    using Answer = FakeUsbDevice::Answer;

    void run();
    bool hear(); // false: the cable is out
    bool unlink(const Header& asked);
    bool next_frame();
    bool complete(Transfer& transfer, Answer answer, std::size_t size);
    bool send(const Header& header, std::span<const uint8_t> data);
    bool receive(std::span<uint8_t> bytes);
    Answer control(const Header& asked, std::span<uint8_t> data, std::size_t& size);
    std::vector<uint8_t> descriptor(unsigned kind, unsigned index) const; // empty: it has none
    void plug_in();
    void unplug();

    FakeUsbDevice& device_;
    std::string serial_;
    int socket_ = -1;
    std::filesystem::path in_sysfs_;
    std::deque<Transfer> waiting_in_, waiting_out_; // of the thread alone
    std::thread thread_;
};

} // namespace haptel::device
