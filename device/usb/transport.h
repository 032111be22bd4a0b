// What a driver needs of a USB device, and no more: control requests, transfers with a time limit for bringing it up,
// and a stream for the servo. libusb stands behind it (usb_transport.h), or bytes in memory in tests.
#pragma once

#include "device/usb/wake_event.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

namespace haptel::device {

enum class UsbError : uint8_t {
    none,
    timeout,
    stall,     // the device refuses the request
    overflow,  // it sent more than was asked for
    gone,      // unplugged
    busy,      // somebody else holds it
    denied,    // no permission
    not_found, // no such device, or no such interface on it
    cancelled, // the driver asked for the end
    failed,    // anything else
};

const char* words_of(UsbError error) noexcept;

struct Transferred {
    UsbError error = UsbError::none;
    std::size_t bytes = 0; // also beside an error: what was transferred before it
};

struct ControlRequest {
    uint8_t type = 0; // bmRequestType; bit 7 set: the device answers with data
    uint8_t request = 0;
    uint16_t value = 0, index = 0;
};

struct StreamSettings {
    uint8_t in_endpoint = 0x81, out_endpoint = 0x02;
    std::size_t in_bytes = 64;  // of each IN transfer; whole packets, or the device overflows it
    std::size_t in_posted = 2;  // IN transfers that always wait for data
    std::size_t out_bytes = 64; // room for one OUT transfer
};

// The driver's side of a stream. All calls come from the thread that runs the stream.
class StreamClient {
public:
    virtual ~StreamClient() = default;
    // One IN transfer; it may be empty.
    virtual void received(std::span<const uint8_t> bytes) noexcept = 0;
    // Asked while no OUT transfer is in flight: after each wake(), each transfer and at least every few milliseconds.
    // Fills `room` and returns how much of it is to be sent now; 0: nothing.
    virtual std::size_t next_out(std::span<uint8_t> room) noexcept = 0;
    // The last OUT transfer was late, failed or was cut off.
    virtual void out_failed() noexcept = 0;
    // False ends the stream.
    virtual bool wants_more() noexcept = 0;

    // What the OUT endpoint is sent where this process can send nothing any more, so that no force stays: fills `room`
    // and returns how much of it. 0: the device holds no force by itself.
    virtual std::size_t last_word(std::span<uint8_t> /*room*/) noexcept { return 0; }
    // The last word may have been said, for this thread stood still; it may go on.
    virtual void was_silenced() noexcept {}
};

// One claimed interface of a device. Each function comes back within its time limit. One thread at a time uses it.
class Transport {
public:
    virtual ~Transport() = default; // gives the interface back
    virtual Transferred control(const ControlRequest& request, std::span<uint8_t> data, int timeout_ms) = 0;
    virtual Transferred out(uint8_t endpoint, std::span<const uint8_t> bytes, int timeout_ms) = 0;
    virtual Transferred in(uint8_t endpoint, std::span<uint8_t> bytes, int timeout_ms) = 0;
    // Runs on the calling thread until the client wants no more (cancelled) or the device fails. At most one OUT
    // transfer is in flight. `wake` makes it ask for the next OUT transfer at once.
    virtual UsbError stream(const StreamSettings& settings, WakeEvent& wake, StreamClient& client) = 0;
};

struct OpenedTransport {
    std::unique_ptr<Transport> transport; // null: see error
    UsbError code = UsbError::none;
    std::string error; // in words, with what to do about it
};

} // namespace haptel::device
