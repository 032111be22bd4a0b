// Versions of libraries and of Haptel: three numbers, as https://semver.org says, without labels for tries before them.
#pragma once

#include <compare>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace haptel::libraries {

struct Version {
    uint32_t major = 0, minor = 0, patch = 0;
    auto operator<=>(const Version&) const = default;

    // Whether who was made for `least` can use this: nothing was taken away since. Versions 0.x promise that from patch
    // to patch only, later ones as long as the first number stays.
    bool serves(const Version& least) const
    {
        return *this >= least && major == least.major && (major > 0 || minor == least.minor);
    }
};

// "1.2.0"; nothing where it is none, or a number is above 999999.
std::optional<Version> parse_version(std::string_view text);
// The same of "1", "1.2" too: what is left out is 0.
std::optional<Version> parse_least_version(std::string_view text);
std::string to_text(const Version& version);

} // namespace haptel::libraries
