#include "runtime/files/quantity.h"

#include <charconv>

namespace haptel::runtime {

namespace {

struct Unit {
    Quantity quantity;
    std::string_view name;
    double per_unit; // SI units (degrees for angles) in one of these, where that is exact ...
    double divisor;  // ... and otherwise the power of ten to divide by, so that "60um" is 60e-6 to the last bit
};

constexpr Unit units[] = {
    {Quantity::length, "m", 1, 1},
    {Quantity::length, "cm", 1, 1e2},
    {Quantity::length, "mm", 1, 1e3},
    {Quantity::length, "um", 1, 1e6},
    {Quantity::length, "nm", 1, 1e9},
    {Quantity::speed, "m/s", 1, 1},
    {Quantity::speed, "cm/s", 1, 1e2},
    {Quantity::speed, "mm/s", 1, 1e3},
    {Quantity::angle_deg, "deg", 1, 1},
    {Quantity::angle_deg, "rad", 180, 3.14159265358979323846},
    {Quantity::turning_deg_per_s, "deg/s", 1, 1},
    {Quantity::turning_deg_per_s, "rad/s", 180, 3.14159265358979323846},
    {Quantity::turning_deg_per_s, "rpm", 6, 1},
    {Quantity::force, "N", 1, 1},
    {Quantity::force, "mN", 1, 1e3},
    {Quantity::stiffness, "N/m", 1, 1},
    {Quantity::stiffness, "N/mm", 1e3, 1},
    {Quantity::stiffness, "kN/m", 1e3, 1},
    {Quantity::damping, "N s/m", 1, 1},
    {Quantity::damping, "Ns/m", 1, 1},
    {Quantity::frequency, "Hz", 1, 1},
    {Quantity::frequency, "kHz", 1e3, 1},
    {Quantity::time, "s", 1, 1},
    {Quantity::time, "ms", 1, 1e3},
};

std::string_view without_blanks(std::string_view text)
{
    while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
    while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
    return text;
}

} // namespace

std::string_view description_of(Quantity quantity)
{
    switch (quantity) {
    case Quantity::number: return "a number";
    case Quantity::length: return "a length in metres, such as 0.15 or \"15cm\"";
    case Quantity::speed: return "a speed in metres per second, such as 0.1 or \"100mm/s\"";
    case Quantity::angle_deg: return "an angle in degrees, such as 45 or \"0.5rad\"";
    case Quantity::turning_deg_per_s: return "a rate of turning in degrees per second, such as 90 or \"15rpm\"";
    case Quantity::force: return "a force in newtons, such as 7 or \"500mN\"";
    case Quantity::stiffness: return "a stiffness in newtons per metre, such as 800 or \"0.8N/mm\"";
    case Quantity::damping: return "a damping in newton seconds per metre, such as 1.0";
    case Quantity::frequency: return "a rate in hertz, such as 1000 or \"1kHz\"";
    case Quantity::time: return "a time in seconds, such as 0.1 or \"100ms\"";
    }
    return {};
}

std::string units_of(Quantity quantity)
{
    std::string names;
    for (const Unit& unit : units)
        if (unit.quantity == quantity) names += (names.empty() ? "" : ", ") + std::string(unit.name);
    return names;
}

std::optional<double> parse_quantity(std::string_view text, Quantity quantity)
{
    text = without_blanks(text);
    if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1); // from_chars knows no plus
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc()) return std::nullopt;
    const std::string_view name = without_blanks(text.substr(static_cast<std::size_t>(end - text.data())));
    if (name.empty()) return value;
    for (const Unit& unit : units)
        if (unit.quantity == quantity && unit.name == name) return value * unit.per_unit / unit.divisor;
    return std::nullopt;
}

} // namespace haptel::runtime
