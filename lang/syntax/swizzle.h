// Components picked by name: v.xy, v.bgr. One set of letters at a time: xyzw, rgba or stpq.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <optional>
#include <string_view>

namespace haptel::lang {

struct Swizzle {
    std::array<uint8_t, 4> component{};
    uint8_t size = 0;

    uint8_t highest() const { return *std::max_element(component.begin(), component.begin() + size); }
    // A bit per component.
    uint8_t mask() const
    {
        uint8_t bits = 0;
        for (uint8_t i = 0; i < size; ++i) bits = static_cast<uint8_t>(bits | 1u << component[i]);
        return bits;
    }
    bool has_repeats() const { return std::popcount(mask()) < size; }
};

inline std::optional<Swizzle> parse_swizzle(std::string_view letters)
{
    if (letters.empty() || letters.size() > 4) return std::nullopt;
    for (std::string_view set : {"xyzw", "rgba", "stpq"}) {
        Swizzle made;
        for (char letter : letters) {
            const size_t at = set.find(letter);
            if (at == std::string_view::npos) break;
            made.component[made.size++] = static_cast<uint8_t>(at);
        }
        if (made.size == letters.size()) return made;
    }
    return std::nullopt;
}

} // namespace haptel::lang
