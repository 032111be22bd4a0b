#include "device/usb/wake_event.h"

#include <cstdint>
#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

namespace haptel::device {

WakeEvent::WakeEvent() : file_descriptor_(eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {}

WakeEvent::~WakeEvent()
{
    if (file_descriptor_ >= 0) close(file_descriptor_);
}

// Neither call can fail in a way that matters: a full counter is a wake-up as well, an empty one is cleared.
void WakeEvent::wake() noexcept
{
    const uint64_t one = 1;
    [[maybe_unused]] const auto written = write(file_descriptor_, &one, sizeof one);
}

void WakeEvent::clear() noexcept
{
    uint64_t count = 0;
    [[maybe_unused]] const auto taken = read(file_descriptor_, &count, sizeof count);
}

void WakeEvent::wait(int timeout_ms) noexcept
{
    pollfd waiting{file_descriptor_, POLLIN, 0};
    poll(&waiting, 1, timeout_ms);
    clear();
}

} // namespace haptel::device
