// A program that controls Haptel: one socket, on the loopback address.
#pragma once

#include "tests/tools/control/osc_bytes.h"

#include <chrono>
#include <netinet/in.h>
#include <optional>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

namespace haptel::test {

class OscClient {
public:
    explicit OscClient(uint16_t port)
    {
        to.sin_family = AF_INET;
        to.sin_port = htons(port);
        to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    }
    ~OscClient() { close(made); }
    OscClient(const OscClient&) = delete;
    OscClient& operator=(const OscClient&) = delete;

    void send(std::string_view bytes) const
    {
        sendto(made, bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&to), sizeof to);
    }
    // The next datagram, with patience.
    std::optional<OscHeard> hear(std::chrono::milliseconds patience = std::chrono::seconds(10)) const
    {
        pollfd readable{made, POLLIN, 0};
        char bytes[65536];
        if (poll(&readable, 1, static_cast<int>(patience.count())) != 1) return std::nullopt;
        const ssize_t count = recv(made, bytes, sizeof bytes, 0);
        if (count <= 0) return std::nullopt;
        return osc_heard({bytes, static_cast<size_t>(count)});
    }
    // The next one with an address that starts so; those before it are dropped.
    std::optional<OscHeard> hear_of(std::string_view address) const
    {
        const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(20);
        while (std::chrono::steady_clock::now() < until) {
            std::optional<OscHeard> heard = hear(std::chrono::seconds(1));
            if (heard && heard->address.starts_with(address)) return heard;
        }
        return std::nullopt;
    }
    void drop_what_came() const
    {
        while (hear(std::chrono::milliseconds(0))) {
        }
    }

private:
    const int made = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    sockaddr_in to{};
};

} // namespace haptel::test
