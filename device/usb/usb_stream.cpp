#include "device/usb/usb_stream.h"

#include "device/usb/usb_context.h"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <libusb.h>
#include <poll.h>
#include <thread>

namespace haptel::device {

namespace {

constexpr int wait_ms = 1;                                  // the client is asked at least this often
constexpr unsigned out_timeout_ms = 100;                    // a device that takes nothing for so long has failed
constexpr int failures_max = 16;                            // in a row, before the stream ends
constexpr auto ending_max = std::chrono::milliseconds(250); // to get cancelled transfers back
constexpr auto ending_step = std::chrono::milliseconds(1);

UsbError error_of_transfer(libusb_transfer_status status) noexcept
{
    switch (status) {
    case LIBUSB_TRANSFER_COMPLETED: return UsbError::none;
    case LIBUSB_TRANSFER_TIMED_OUT: return UsbError::timeout;
    case LIBUSB_TRANSFER_STALL: return UsbError::stall;
    case LIBUSB_TRANSFER_NO_DEVICE: return UsbError::gone;
    case LIBUSB_TRANSFER_OVERFLOW: return UsbError::overflow;
    case LIBUSB_TRANSFER_CANCELLED: return UsbError::cancelled;
    case LIBUSB_TRANSFER_ERROR: return UsbError::failed;
    }
    return UsbError::failed;
}

// What libusb wants to be polled, and the event that the driver wakes us with.
std::vector<pollfd> polled(libusb_context* context, const WakeEvent& wake)
{
    std::vector<pollfd> all = {{wake.file_descriptor(), POLLIN, 0}};
    const libusb_pollfd** theirs = libusb_get_pollfds(context);
    for (auto each = theirs; each && *each; ++each) all.push_back({(*each)->fd, (*each)->events, 0});
    libusb_free_pollfds(theirs);
    return all;
}

// Linux says so some time before it gives back what is in flight, and before libusb takes notice. Until then a poll
// does not wait, and a thread of real-time priority that goes on polling keeps the kernel from it.
bool tells_of_unplugging(const std::vector<pollfd>& fds)
{
    return std::ranges::any_of(fds, [](const pollfd& each) { return (each.revents & (POLLHUP | POLLERR)) != 0; });
}

} // namespace

struct UsbStream::Slot {
    Slot(UsbStream& owner, libusb_device_handle* handle, uint8_t endpoint, std::size_t size, bool interrupt,
         unsigned timeout_ms, libusb_transfer_cb_fn done)
        : stream(owner), bytes(size), transfer(libusb_alloc_transfer(0))
    {
        if (!transfer) return;
        const auto fill = interrupt ? libusb_fill_interrupt_transfer : libusb_fill_bulk_transfer;
        fill(transfer, handle, endpoint, bytes.data(), static_cast<int>(size), done, this, timeout_ms);
    }
    ~Slot() { libusb_free_transfer(transfer); }
    Slot(const Slot&) = delete;
    Slot& operator=(const Slot&) = delete;

    int submit() noexcept
    {
        const int code = transfer ? libusb_submit_transfer(transfer) : LIBUSB_ERROR_NO_MEM;
        in_flight = code == LIBUSB_SUCCESS;
        return code;
    }
    std::span<const uint8_t> received() const noexcept
    {
        return {bytes.data(), static_cast<std::size_t>(std::max(transfer->actual_length, 0))};
    }

    UsbStream& stream;
    std::vector<uint8_t> bytes;
    libusb_transfer* transfer;
    bool in_flight = false;
};

UsbStream::UsbStream(libusb_context* context, libusb_device_handle* handle, bool interrupt_endpoints,
                     const StreamSettings& settings, StreamClient& client)
    : context_(context), settings_(settings), client_(client)
{
    const auto in_done = [](libusb_transfer* transfer) {
        Slot& slot = *static_cast<Slot*>(transfer->user_data);
        slot.stream.finished_in(slot);
    };
    const auto out_done = [](libusb_transfer* transfer) {
        Slot& slot = *static_cast<Slot*>(transfer->user_data);
        slot.stream.finished_out(slot);
    };
    for (std::size_t i = 0; i < settings.in_posted; ++i)
        in_.push_back(std::make_unique<Slot>(*this, handle, settings.in_endpoint, settings.in_bytes,
                                             interrupt_endpoints, 0, in_done));
    out_ = std::make_unique<Slot>(*this, handle, settings.out_endpoint, settings.out_bytes, interrupt_endpoints,
                                  out_timeout_ms, out_done);
}

// The system may still write into a transfer that it has not given back: that memory stays, and is told of by no one.
UsbStream::~UsbStream()
{
    const auto leave = [](std::unique_ptr<Slot>& slot) {
        if (slot->in_flight) [[maybe_unused]]
            Slot* left = slot.release();
    };
    for (auto& slot : in_) leave(slot);
    leave(out_);
}

UsbError UsbStream::run(WakeEvent& wake, ForceGuard& guard)
{
    for (auto& slot : in_) post_in(*slot);
    std::vector<pollfd> fds = polled(context_, wake);
    while (ended_ == UsbError::none && client_.wants_more()) {
        if (guard.hear()) client_.was_silenced();
        offer_out();
        poll(fds.data(), fds.size(), wait_ms);
        if (fds.front().revents & POLLIN) wake.clear();
        timeval at_once{0, 0};
        const int code = libusb_handle_events_timeout_completed(context_, &at_once, nullptr);
        if (code != LIBUSB_SUCCESS && code != LIBUSB_ERROR_INTERRUPTED) failed(usb_error(code));
        if (tells_of_unplugging(fds)) failed(UsbError::gone);
    }
    cancel_all();
    return ended_ == UsbError::none ? UsbError::cancelled : ended_;
}

void UsbStream::post_in(Slot& slot) noexcept
{
    if (const int code = slot.submit(); code != LIBUSB_SUCCESS) {
        failed(usb_error(code));
        // A stream that listens with fewer transfers than it should is slower without telling: it ends.
        if (ended_ == UsbError::none) ended_ = usb_error(code);
    }
}

void UsbStream::offer_out() noexcept
{
    if (out_->in_flight || ended_ != UsbError::none) return;
    const std::size_t size = std::min(client_.next_out(out_->bytes), out_->bytes.size());
    if (size == 0) return;
    if (out_->transfer) out_->transfer->length = static_cast<int>(size);
    if (const int code = out_->submit(); code != LIBUSB_SUCCESS) {
        client_.out_failed();
        failed(usb_error(code));
    }
}

void UsbStream::finished_in(Slot& slot) noexcept
{
    slot.in_flight = false;
    if (ending_) return;
    const UsbError error = error_of_transfer(slot.transfer->status);
    if (error == UsbError::none) {
        failures_in_a_row_ = 0;
        client_.received(slot.received());
    } else {
        failed(error);
    }
    if (ended_ == UsbError::none) post_in(slot);
}

void UsbStream::finished_out(Slot& slot) noexcept
{
    slot.in_flight = false;
    if (ending_) return;
    const UsbError error = error_of_transfer(slot.transfer->status);
    if (error != UsbError::none || slot.transfer->actual_length != slot.transfer->length) client_.out_failed();
    if (error != UsbError::none) failed(error);
    offer_out();
}

void UsbStream::failed(UsbError error) noexcept
{
    if (error == UsbError::gone || ++failures_in_a_row_ >= failures_max) ended_ = error;
}

bool UsbStream::any_in_flight() const noexcept
{
    return out_->in_flight || std::any_of(in_.begin(), in_.end(), [](const auto& slot) { return slot->in_flight; });
}

void UsbStream::cancel_all() noexcept
{
    ending_ = true;
    for (auto& slot : in_)
        if (slot->in_flight) libusb_cancel_transfer(slot->transfer);
    if (out_->in_flight) libusb_cancel_transfer(out_->transfer);
    const auto deadline = std::chrono::steady_clock::now() + ending_max;
    while (any_in_flight() && std::chrono::steady_clock::now() < deadline) {
        timeval at_once{0, 0};
        libusb_handle_events_timeout_completed(context_, &at_once, nullptr);
        if (any_in_flight()) std::this_thread::sleep_for(ending_step); // the kernel's turn
    }
}

} // namespace haptel::device
