#include "device/evdev/open_evdev.h"

#include "device/servo_silence.h"

#include <algorithm>
#include <charconv>
#include <fmt/format.h>
#include <utility>
#include <vector>

namespace haptel::device {

namespace {

struct EvdevKey {
    std::string_view name;
    double EvdevSettings::* value;
    double minimum, maximum;
};
constexpr EvdevKey evdev_keys[] = {{"travel_m", &EvdevSettings::travel_m, 1e-3, 10},
                                   {"force_max_n", &EvdevSettings::force_max_n, 0.1, 100}};

std::string read_key(std::string_view text, EvdevSettings& settings)
{
    const auto equals = std::min(text.find('='), text.size());
    const std::string_view name = text.substr(0, equals), value = text.substr(std::min(equals + 1, text.size()));
    for (const EvdevKey& key : evdev_keys) {
        if (key.name != name) continue;
        double number = 0;
        const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), number);
        if (error != std::errc() || end != value.data() + value.size() ||
            !(number >= key.minimum && number <= key.maximum))
            return fmt::format("`{}` must be a number from {:g} to {:g}, found '{}'", name, key.minimum, key.maximum,
                               value.substr(0, 32));
        settings.*key.value = number;
        return "";
    }
    return fmt::format("unknown '{}': there are travel_m and force_max_n, as in evdev:FILE,travel_m=0.4",
                       name.substr(0, 64));
}

} // namespace

EvdevText read_evdev_text(std::string_view variant)
{
    EvdevText read;
    const auto comma = std::min(variant.find(','), variant.size());
    read.path = variant.substr(0, comma);
    variant.remove_prefix(comma);
    if (read.path.empty())
        read.error = "evdev needs a file: evdev:/dev/input/by-id/NAME-event-joystick; `haptel devices` lists those "
                     "that are connected";
    while (read.error.empty() && !variant.empty()) {
        variant.remove_prefix(1);
        const auto next = std::min(variant.find(','), variant.size());
        read.error = read_key(variant.substr(0, next), read.settings);
        variant.remove_prefix(next);
    }
    return read;
}

runtime::DeviceResult open_evdev(std::string_view variant, const runtime::DeviceRequest& request)
{
    EvdevText read = read_evdev_text(variant);
    if (!read.error.empty()) return {nullptr, std::move(read.error)};
    OpenedInput tried = open_input_port(read.path);
    if (!tried.port) return {nullptr, std::move(tried.error)};
    read.settings.axes = tried.port->axis(1) ? 2 : 1;
    tried.port.reset(); // the driver opens it anew
    EvdevTimes times;
    times.watchdog_ms = servo_silence_ms(request.rate_hz);
    return {std::make_unique<EvdevDevice>(
                request.name, [path = read.path] { return open_input_port(path); }, read.settings, times),
            {}};
}

} // namespace haptel::device
