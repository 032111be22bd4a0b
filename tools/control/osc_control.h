// What each OSC message does (docs/control.md): from datagrams to an exploration, and its state to whoever subscribed.
//
// Knows no socket: datagrams come in with the port of their sender on this machine, and go out with the port they are
// for. Any bytes are taken; what is wrong is answered with /haptel/error, what was expected and how to mend it. What a
// sender can keep here is bounded: subscribers_max ports, each for a minute.
#pragma once

#include "tools/control/controlled.h"
#include "tools/control/osc_message.h"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace haptel::tools {

// A socket on this machine, as its owner numbers the addresses that it listens on.
struct OscPeer {
    int via = 0;
    uint16_t port = 0;
    bool operator==(const OscPeer&) const = default;
};

struct OscDatagram {
    OscPeer to;
    std::string bytes;
};

class OscControl {
public:
    using Clock = std::chrono::steady_clock;
    static constexpr std::size_t subscribers_max = 16;
    static constexpr double rate_default_hz = 30, rate_max_hz = 60;
    static constexpr auto subscribed_for = std::chrono::seconds(60);

    explicit OscControl(Controlled& controlled) : controlled_(controlled) {}

    // Does what a datagram asks; returns the answers.
    std::vector<OscDatagram> take(std::string_view datagram, OscPeer from, Clock::time_point now);
    // What subscribers are due.
    std::vector<OscDatagram> state(Clock::time_point now);
    // For all subscribers: what is said on the terminal, too.
    std::vector<OscDatagram> tell(const std::string& text) const;
    // The last words.
    std::vector<OscDatagram> end(const std::string& why) const;

    std::size_t subscribers() const { return subscribers_.size(); }

private:
    struct Subscriber {
        OscPeer peer;
        Clock::duration interval;
        Clock::time_point due, until;
        uint64_t version = 0; // of the objects that it was told of; 0: none
    };

    ControlAnswer act(const OscMessage& message, OscPeer from, Clock::time_point now, std::vector<OscMessage>& told);
    ControlAnswer act_on_object(const OscMessage& message, std::vector<OscMessage>& told);
    ControlAnswer subscribe(const OscMessage& message, OscPeer from, Clock::time_point now);
    ControlAnswer unsubscribe(OscPeer from);
    std::vector<OscMessage> list() const;
    std::vector<OscDatagram> to_all(const OscMessage& message) const;

    Controlled& controlled_;
    std::vector<Subscriber> subscribers_;
};

} // namespace haptel::tools
