#include "device/inverse3/inverse3_greeting.h"

#include "runtime/servo/real_time.h"

#include <algorithm>
#include <fmt/format.h>

namespace haptel::device {

Inverse3Greeting greet_inverse3(ServiceSocket& socket, const ServiceAddress& address, int limit_ms,
                                const std::atomic<bool>& quit)
{
    Inverse3Greeting greeting;
    const int64_t until_ns = runtime::monotonic_ns() + int64_t{1'000'000} * limit_ms;
    greeting.is_absent = true;
    greeting.error = socket.connect(address, limit_ms, quit);
    if (!greeting.error.empty()) return greeting;
    SocketEvent event = SocketEvent::woken;
    while (event == SocketEvent::woken && !quit.load(std::memory_order_acquire)) event = socket.wait(until_ns);
    if (event != SocketEvent::message) {
        greeting.error =
            event == SocketEvent::lost
                ? fmt::format("the service at {} does not say which devices it has: {}. Restart it", address.text(),
                              socket.error())
                : fmt::format("the service at {} does not say within {} ms which devices it has: restart it",
                              address.text(), limit_ms);
        return greeting;
    }
    greeting.is_absent = false;
    greeting.error = socket.message_fault();
    if (greeting.error.empty()) {
        greeting.inventory = read_inverse3_inventory(socket.message());
        greeting.error = greeting.inventory.error;
    }
    if (!greeting.error.empty())
        greeting.error = fmt::format(
            "what listens at {} is no Inverse3 service: {}. Name its place by HAPTEL_INVERSE3_SERVICE=HOST:PORT",
            address.text(), greeting.error);
    return greeting;
}

Inverse3Choice choose_inverse3(const Inverse3Inventory& inventory, std::string_view id, const ServiceAddress& address)
{
    if (inventory.devices.empty())
        return {nullptr,
                fmt::format("the service at {} has no Inverse3: is it plugged in and switched on?", address.text())};
    if (id.empty()) return {&inventory.devices.front(), ""};
    std::string known;
    for (const Inverse3Listed& device : inventory.devices) {
        if (device.id == id) return {&device, ""};
        if (known.size() < 200) known += (known.empty() ? "" : ", ") + device.id;
    }
    return {nullptr, fmt::format("the service at {} has no Inverse3 '{}': there are {}", address.text(),
                                 id.substr(0, inverse3_id_bytes_max), known)};
}

} // namespace haptel::device
