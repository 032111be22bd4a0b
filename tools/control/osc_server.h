// OscControl on UDP ports of this machine alone: 127.0.0.1 and ::1, which no other machine can send to.
//
// Nothing here waits but wait(), and nothing is kept for a peer that does not read.
#pragma once

#include "tools/control/osc_control.h"

#include <array>
#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

namespace haptel::tools {

class OscServer {
public:
    // Port 0: any that is free. See error().
    OscServer(uint16_t port, Controlled& controlled);
    ~OscServer();
    OscServer(const OscServer&) = delete;
    OscServer& operator=(const OscServer&) = delete;

    const std::string& error() const { return error_; } // why it does not listen; empty: it does
    uint16_t port() const { return port_; }
    // "127.0.0.1:9000", as the system says; of each socket.
    std::vector<std::string> bound_addresses() const;

    // Until a message arrives, or the time is over.
    void wait(std::chrono::milliseconds at_most) const;
    // Takes some messages, answers them, and sends subscribers what they are due. To be called often.
    void serve();
    void tell(const std::string& text);
    void end(const std::string& why);

private:
    bool listen_on(int family, std::string& failed);
    void send(const std::vector<OscDatagram>& datagrams) const;

    OscControl control_;
    uint16_t port_;
    std::array<int, 2> sockets_ = {-1, -1}; // of IPv4 and of IPv6, where the machine has it
    std::string error_;
};

} // namespace haptel::tools
