// A WebSocket to a service, for one thread that may wait, but never longer than it says.
#pragma once

#include "device/usb/wake_event.h"

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

namespace haptel::device {

// No other names than localhost: to look one up may take as long as it likes.
struct ServiceAddress {
    std::string host = "localhost"; // or an IP address
    uint16_t port = 10001;

    std::string text() const; // "localhost:10001"
};

struct ServiceAddressText {
    ServiceAddress address;
    std::string error; // in words
};
// "HOST", "HOST:PORT", "[IPv6]:PORT"; empty: the default.
ServiceAddressText read_service_address(std::string_view text);

enum class SocketEvent : uint8_t {
    message, // one has come: see message()
    woken,   // by the WakeEvent
    time,    // it is over
    lost,    // nothing comes any more and nothing can be sent: see error()
};

class ServiceSocket {
public:
    static constexpr std::size_t message_bytes_max = 256 * 1024;

    explicit ServiceSocket(WakeEvent& wake); // outlives it
    ~ServiceSocket();                        // without another word
    ServiceSocket(const ServiceSocket&) = delete;
    ServiceSocket& operator=(const ServiceSocket&) = delete;

    // Once. In words why not; empty: it is connected. Ends early with `quit`.
    std::string connect(const ServiceAddress& address, int limit_ms, const std::atomic<bool>& quit);
    // Copied, and on its way where the system has room. False, and nothing is sent, while the one before is not written
    // yet or the connection is lost.
    bool send(std::string_view text);
    bool is_writing() const;
    // For who sends in our place: a text of at most 65 535 bytes as it goes over the wire, and where.
    static std::string frame_of(std::string_view text);
    int file_descriptor() const;
    SocketEvent wait(int64_t until_ns);
    // Until all is written. False: it is not, by then.
    bool flush(int64_t until_ns);
    // After SocketEvent::message, until the next wait.
    std::string_view message() const;
    // Why the message cannot be used, in words: it is binary or larger than message_bytes_max. Empty: it can.
    std::string_view message_fault() const;
    const std::string& error() const;
    // Says goodbye and waits for the answer, but not for long. True: it was answered, so all that was sent was heard.
    bool close(int limit_ms);

private:
    struct Link;
    std::unique_ptr<Link> link_;
};

} // namespace haptel::device
