// A USB device that exists in this process only, under the real libusb: the calls that libusb makes to the kernel about
// one file descriptor are answered here by a FakeUsbDevice. For test programs whose executable holds ioctl() and read()
// of usbfs_shim.cpp, which the dynamic linker then binds libusb's calls to.
#pragma once

#include "tests/device/usb/fake_usb_device.h"

#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>

struct usbdevfs_urb;

namespace haptel::device {

// An IN transfer completes when the bus has a frame for it, each millisecond, with the bytes that are there by then. So
// does an OUT transfer of an interrupt endpoint; others are done at once.
class UsbfsShim {
public:
    explicit UsbfsShim(FakeUsbDevice& device);
    ~UsbfsShim();
    UsbfsShim(const UsbfsShim&) = delete;
    UsbfsShim& operator=(const UsbfsShim&) = delete;

    int file_descriptor() const { return file_descriptor_; }
    void hold_out(bool held); // OUT transfers do not complete: the device takes nothing

    // As the kernel: -1 and errno, or what it returns.
    int serve(unsigned long request, void* argument);
    long read_descriptors(void* into, std::size_t size) const;

private:
    int submit(usbdevfs_urb& urb);
    int discard(usbdevfs_urb& urb);
    int reap(usbdevfs_urb*& urb);
    void finish(usbdevfs_urb& urb, int status);
    void take_out(usbdevfs_urb& urb, FakeUsbDevice::Answer answer);
    void give_all_back(); // of a device that is gone
    void signal();        // libusb polls the descriptor for POLLOUT: something is finished
    void run_bus();

    FakeUsbDevice& device_;
    int file_descriptor_;
    std::mutex mutex_;
    std::deque<usbdevfs_urb*> waiting_in_, waiting_out_, held_out_, finished_;
    bool hold_out_ = false, signalled_ = false, ending_ = false, gone_ = false;
    std::thread bus_;
};

} // namespace haptel::device
