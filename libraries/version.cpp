#include "libraries/version.h"

#include <array>

namespace haptel::libraries {

namespace {

constexpr std::size_t digits_max = 6;

// A number as it is written in one way only: without a zero before it.
std::optional<uint32_t> parse_part(std::string_view text)
{
    uint32_t value = 0;
    if (text.empty() || text.size() > digits_max || (text.size() > 1 && text[0] == '0')) return std::nullopt;
    for (const char c : text) {
        if (c < '0' || c > '9') return std::nullopt;
        value = value * 10 + static_cast<uint32_t>(c - '0');
    }
    return value;
}

std::optional<Version> parse_parts(std::string_view text, std::size_t least_parts)
{
    std::array<uint32_t, 3> parts{};
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const std::size_t dot = text.find('.');
        const std::optional<uint32_t> part = parse_part(text.substr(0, dot));
        if (!part) return std::nullopt;
        parts[i] = *part;
        if (dot == text.npos)
            return i + 1 >= least_parts ? std::optional(Version{parts[0], parts[1], parts[2]}) : std::nullopt;
        text.remove_prefix(dot + 1);
    }
    return std::nullopt; // a fourth one
}

} // namespace

std::optional<Version> parse_version(std::string_view text)
{
    return parse_parts(text, 3);
}

std::optional<Version> parse_least_version(std::string_view text)
{
    return parse_parts(text, 1);
}

std::string to_text(const Version& version)
{
    return std::to_string(version.major) + "." + std::to_string(version.minor) + "." + std::to_string(version.patch);
}

} // namespace haptel::libraries
