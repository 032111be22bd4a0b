#include "tests/device/usb/usbfs_shim.h"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdarg>
#include <cstdint>
#include <cstring>
#include <ctime>
#include <linux/usbdevice_fs.h>
#include <sys/eventfd.h>
#include <sys/ioctl.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace haptel::device {

namespace {

// The one device of the process, while it exists.
std::atomic<UsbfsShim*> the_shim{nullptr};

// An eventfd at its limit cannot be written: it is not ready for POLLOUT. Emptied, it is.
constexpr uint64_t not_writable = 0xfffffffffffffffe;

int fail(int error)
{
    errno = error;
    return -1;
}

int status_of(FakeUsbDevice::Answer answer)
{
    return answer == FakeUsbDevice::Answer::gone ? -ENODEV : answer == FakeUsbDevice::Answer::stall ? -EPIPE : 0;
}

} // namespace

UsbfsShim::UsbfsShim(FakeUsbDevice& device) : device_(device), file_descriptor_(eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC))
{
    signalled_ = true;
    signal();
    the_shim = this;
    bus_ = std::thread([this] { run_bus(); });
}

UsbfsShim::~UsbfsShim()
{
    {
        const std::lock_guard lock(mutex_);
        ending_ = true;
    }
    bus_.join();
    the_shim = nullptr;
    close(file_descriptor_);
}

void UsbfsShim::hold_out(bool held)
{
    const std::lock_guard lock(mutex_);
    hold_out_ = held;
}

void UsbfsShim::signal()
{
    const bool wanted = !finished_.empty();
    if (wanted == signalled_) return;
    signalled_ = wanted;
    uint64_t count = not_writable;
    [[maybe_unused]] const long done = syscall(wanted ? SYS_read : SYS_write, file_descriptor_, &count, sizeof count);
}

void UsbfsShim::finish(usbdevfs_urb& urb, int status)
{
    urb.status = status;
    finished_.push_back(&urb);
    signal();
}

// One millisecond is one frame. If this thread was late, the frames that went by are made up for.
void UsbfsShim::run_bus()
{
    timespec next{};
    clock_gettime(CLOCK_MONOTONIC, &next);
    for (;;) {
        next.tv_nsec += 1'000'000;
        if (next.tv_nsec >= 1'000'000'000) next.tv_nsec -= 1'000'000'000, ++next.tv_sec;
        clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &next, nullptr);
        const std::lock_guard lock(mutex_);
        if (ending_) return;
        if (!waiting_out_.empty()) {
            usbdevfs_urb& urb = *waiting_out_.front();
            waiting_out_.pop_front();
            take_out(urb, device_.out(
                              {static_cast<const uint8_t*>(urb.buffer), static_cast<std::size_t>(urb.buffer_length)}));
        }
        if (!waiting_in_.empty()) {
            usbdevfs_urb& urb = *waiting_in_.front();
            std::size_t size = 0;
            const FakeUsbDevice::Answer answer =
                device_.in({static_cast<uint8_t*>(urb.buffer), static_cast<std::size_t>(urb.buffer_length)}, size);
            gone_ = answer == FakeUsbDevice::Answer::gone;
            if (!gone_ && answer != FakeUsbDevice::Answer::nothing) {
                waiting_in_.pop_front();
                urb.actual_length = static_cast<int>(size);
                finish(urb, status_of(answer));
            }
        }
        if (gone_) give_all_back();
    }
}

void UsbfsShim::give_all_back()
{
    for (auto* queue : {&waiting_in_, &waiting_out_})
        for (; !queue->empty(); queue->pop_front()) finish(*queue->front(), -ENODEV);
}

void UsbfsShim::take_out(usbdevfs_urb& urb, FakeUsbDevice::Answer answer)
{
    gone_ = answer == FakeUsbDevice::Answer::gone;
    if (answer == FakeUsbDevice::Answer::fine) urb.actual_length = urb.buffer_length;
    finish(urb, status_of(answer));
}

int UsbfsShim::submit(usbdevfs_urb& urb)
{
    urb.actual_length = 0;
    urb.status = 0;
    if (urb.type == USBDEVFS_URB_TYPE_CONTROL) {
        auto* bytes = static_cast<uint8_t*>(urb.buffer);
        const auto word = [&](int at) { return static_cast<uint16_t>(bytes[at] | bytes[at + 1] << 8); };
        std::size_t size = word(6);
        const auto answer = device_.control({bytes[0], bytes[1], word(2), word(4)}, {bytes + 8, size}, size);
        if (answer == FakeUsbDevice::Answer::gone) return fail(ENODEV);
        if (answer == FakeUsbDevice::Answer::fine) urb.actual_length = static_cast<int>(size);
        finish(urb, status_of(answer));
        return 0;
    }
    if (urb.endpoint & 0x80) {
        waiting_in_.push_back(&urb);
        return 0;
    }
    if (hold_out_) {
        held_out_.push_back(&urb);
        return 0;
    }
    if (urb.type == USBDEVFS_URB_TYPE_INTERRUPT) {
        waiting_out_.push_back(&urb);
        return 0;
    }
    const auto answer =
        device_.out({static_cast<const uint8_t*>(urb.buffer), static_cast<std::size_t>(urb.buffer_length)});
    if (answer == FakeUsbDevice::Answer::gone) return fail(ENODEV);
    take_out(urb, answer);
    return 0;
}

int UsbfsShim::discard(usbdevfs_urb& urb)
{
    for (auto* queue : {&waiting_in_, &waiting_out_, &held_out_}) {
        const auto found = std::find(queue->begin(), queue->end(), &urb);
        if (found == queue->end()) continue;
        queue->erase(found);
        finish(urb, -ENOENT);
        return 0;
    }
    return fail(EINVAL);
}

int UsbfsShim::reap(usbdevfs_urb*& urb)
{
    if (finished_.empty()) return fail(gone_ ? ENODEV : EAGAIN);
    urb = finished_.front();
    finished_.pop_front();
    signal();
    return 0;
}

int UsbfsShim::serve(unsigned long request, void* argument)
{
    const std::lock_guard lock(mutex_);
    switch (request) {
    case USBDEVFS_CONNECTINFO: *static_cast<usbdevfs_connectinfo*>(argument) = {7, 0}; return 0;
    case USBDEVFS_GET_SPEED: return 2; // full
    case USBDEVFS_GET_CAPABILITIES:
        *static_cast<uint32_t*>(argument) =
            USBDEVFS_CAP_ZERO_PACKET | USBDEVFS_CAP_NO_PACKET_SIZE_LIM | USBDEVFS_CAP_REAP_AFTER_DISCONNECT;
        return 0;
    case USBDEVFS_CONTROL: { // libusb itself asks for the configuration in use
        const auto& transfer = *static_cast<usbdevfs_ctrltransfer*>(argument);
        if (transfer.bRequestType != 0x80 || transfer.bRequest != 8) return fail(EPIPE);
        *static_cast<uint8_t*>(transfer.data) = 1;
        return 1;
    }
    case USBDEVFS_GETDRIVER: return fail(ENODATA); // no kernel driver has it
    case USBDEVFS_IOCTL: return fail(ENODATA);
    case USBDEVFS_CLAIMINTERFACE:
    case USBDEVFS_RELEASEINTERFACE: return 0;
    case USBDEVFS_SUBMITURB: return submit(*static_cast<usbdevfs_urb*>(argument));
    case USBDEVFS_DISCARDURB: return discard(*static_cast<usbdevfs_urb*>(argument));
    case USBDEVFS_REAPURBNDELAY: return reap(*static_cast<usbdevfs_urb**>(argument));
    default: return fail(ENOTTY);
    }
}

long UsbfsShim::read_descriptors(void* into, std::size_t size) const
{
    const std::vector<uint8_t> descriptors = device_.descriptors();
    const std::size_t given = std::min(size, descriptors.size());
    std::memcpy(into, descriptors.data(), given);
    return static_cast<long>(given);
}

} // namespace haptel::device

extern "C" __attribute__((visibility("default"))) int ioctl(int fd, unsigned long request, ...) noexcept
{
    va_list arguments;
    va_start(arguments, request);
    void* argument = va_arg(arguments, void*);
    va_end(arguments);
    haptel::device::UsbfsShim* shim = haptel::device::the_shim.load();
    if (shim && shim->file_descriptor() == fd) return shim->serve(request, argument);
    return static_cast<int>(syscall(SYS_ioctl, fd, request, argument));
}

extern "C" __attribute__((visibility("default"))) ssize_t read(int fd, void* into, size_t size)
{
    haptel::device::UsbfsShim* shim = haptel::device::the_shim.load();
    if (shim && shim->file_descriptor() == fd) return shim->read_descriptors(into, size);
    return syscall(SYS_read, fd, into, size);
}
