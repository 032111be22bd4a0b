#include "device/axes/axis_settings.h"

#include <algorithm>
#include <charconv>
#include <fmt/format.h>
#include <system_error>

namespace haptel::device {

namespace {

struct AxisKey {
    std::string_view name;
    double AxisSettings::* value;
    double minimum, maximum;
};
constexpr AxisKey axis_keys[] = {{"travel_m", &AxisSettings::travel_m, 1e-3, 10},
                                 {"force_max_n", &AxisSettings::force_max_n, 0.1, 100}};

std::string read_key(std::string_view text, std::string_view example, AxisSettings& settings)
{
    const auto equals = std::min(text.find('='), text.size());
    const std::string_view name = text.substr(0, equals), value = text.substr(std::min(equals + 1, text.size()));
    for (const AxisKey& key : axis_keys) {
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
    return fmt::format("unknown '{}': there are travel_m and force_max_n, as in {},travel_m=0.4", name.substr(0, 64),
                       example);
}

} // namespace

AxisText read_axis_text(std::string_view text, std::string_view example)
{
    AxisText read;
    const auto comma = std::min(text.find(','), text.size());
    read.what = text.substr(0, comma);
    text.remove_prefix(comma);
    while (read.error.empty() && !text.empty()) {
        text.remove_prefix(1);
        const auto next = std::min(text.find(','), text.size());
        read.error = read_key(text.substr(0, next), example, read.settings);
        text.remove_prefix(next);
    }
    return read;
}

} // namespace haptel::device
