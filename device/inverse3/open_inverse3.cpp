#include "device/inverse3/open_inverse3.h"

#include "device/servo_silence.h"

#include <cstdlib>
#include <fmt/format.h>
#include <memory>
#include <utility>

namespace haptel::device {

namespace {

constexpr const char* service_variable = "HAPTEL_INVERSE3_SERVICE";
constexpr int open_ms = 1000, list_ms = 300, goodbye_ms = 50;

ServiceAddressText address_of_environment()
{
    const char* place = std::getenv(service_variable);
    return read_service_address(place ? place : "");
}

// What the service says first, and no more: no device hears of it.
Inverse3Greeting ask_once(const ServiceAddress& address, int limit_ms)
{
    static constexpr std::atomic<bool> never{false};
    WakeEvent nobody;
    ServiceSocket socket(nobody);
    Inverse3Greeting greeting = greet_inverse3(socket, address, limit_ms, never);
    socket.close(goodbye_ms);
    return greeting;
}

runtime::DeviceResult no_inverse3(std::string why)
{
    return {nullptr, "inverse3: " + std::move(why), {}, runtime::DeviceKey::name};
}

} // namespace

runtime::DeviceResult open_inverse3(std::string_view id, const runtime::DeviceRequest& request)
{
    if (!id.empty() && !is_inverse3_id(id))
        return no_inverse3(fmt::format("an id has letters and digits, as in inverse3:049D, found '{}'",
                                       id.substr(0, inverse3_id_bytes_max)));
    ServiceAddressText place = address_of_environment();
    if (!place.error.empty()) return no_inverse3(std::move(place.error));
    Inverse3Greeting greeting = ask_once(place.address, open_ms);
    if (!greeting.error.empty()) return no_inverse3(std::move(greeting.error));
    Inverse3Choice choice = choose_inverse3(greeting.inventory, id, place.address);
    if (!choice.device) return no_inverse3(std::move(choice.error));

    Inverse3Times times;
    times.watchdog_ms = servo_silence_ms(request.rate_hz);
    return {std::make_unique<Inverse3Device>(request.name, std::move(place.address), std::string(id), times),
            {},
            {},
            runtime::DeviceKey::name};
}

Inverse3List list_inverse3s()
{
    const ServiceAddressText place = address_of_environment();
    Inverse3List list{{}, place.address.text(), place.error};
    if (!list.error.empty()) return list;
    Inverse3Greeting greeting = ask_once(place.address, list_ms);
    if (!greeting.is_absent || std::getenv(service_variable)) list.error = std::move(greeting.error);
    for (Inverse3Listed& device : greeting.inventory.devices) list.ids.push_back(std::move(device.id));
    return list;
}

} // namespace haptel::device
