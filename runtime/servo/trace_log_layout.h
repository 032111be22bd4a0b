// Names and sizes of the binary recording that its writer and its reader share; the layout stands in trace_log.h.
#pragma once

#include "input/checksum.h"
#include "runtime/servo/tick_columns.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <type_traits>
#include <variant>

namespace haptel::runtime {

inline constexpr std::string_view log_magic = "HAPTRACE";
inline constexpr uint32_t log_byte_order = 0x01020304, log_version = 1;
inline constexpr std::size_t log_fixed_bytes = log_magic.size() + 4 * sizeof(uint32_t); // before the text
inline constexpr uint32_t log_text_max = 16 << 20; // bytes: a scene has up to 20 000 objects, with files each

// Of the other columns a record knows what stands there if they are absent.
inline constexpr std::array<std::string_view, 5> log_columns_required = {"tick", "time_s", "x_m", "y_m", "z_m"};

inline std::string_view log_type_of(const TickField& field)
{
    constexpr std::array<std::string_view, std::variant_size_v<TickField>> names = {"u64", "u32", "f64"};
    return names[field.index()];
}

inline std::size_t log_size_of(const TickField& field)
{
    return std::visit([](auto* value) { return sizeof *value; }, field);
}

inline uint64_t log_sum(std::string_view bytes, uint64_t before)
{
    return input::checksum(bytes, {before, 0}).low;
}

} // namespace haptel::runtime
