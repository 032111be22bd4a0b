// Tells byte strings apart that nobody has made to be mistaken for each other: by chance two have one checksum never.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace haptel::input {

struct Checksum {
    uint64_t low = 0, high = 0;
    bool operator==(const Checksum&) const = default;
};
// Of several strings, one after the other: each with the checksum of those before it.
Checksum checksum(std::string_view bytes, const Checksum& before = {}) noexcept;
std::string to_text(const Checksum& sum); // 32 hexadecimal digits

} // namespace haptel::input
