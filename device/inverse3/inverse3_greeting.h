// The beginning of each connection to the Inverse3 service: it says first which devices it has.
#pragma once

#include "device/inverse3/inverse3_message.h"
#include "device/inverse3/service_socket.h"

#include <string>
#include <string_view>

namespace haptel::device {

struct Inverse3Greeting {
    Inverse3Inventory inventory;
    std::string error;      // in words, with what to do about it; empty: there is an inventory
    bool is_absent = false; // no service or none that answers: it may come back
};

// Connects and hears the inventory, within the limit.
Inverse3Greeting greet_inverse3(ServiceSocket& socket, const ServiceAddress& address, int limit_ms,
                                const std::atomic<bool>& quit);

struct Inverse3Choice {
    const Inverse3Listed* device = nullptr; // of the inventory; null: see error
    std::string error;
};
// The one of that id, or the first if it is empty.
Inverse3Choice choose_inverse3(const Inverse3Inventory& inventory, std::string_view id, const ServiceAddress& address);

} // namespace haptel::device
