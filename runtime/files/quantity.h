// Numbers with units, as people write them in scenes: "15cm", "60 um", "1kHz", "0.8 N/mm". Bare numbers are SI.
#pragma once

#include "runtime/scene/scene_fields.h"

#include <optional>
#include <string>
#include <string_view>

namespace haptel::runtime {

// "a length", and how one is written: `a length in metres, such as 0.15 or "15cm"`.
std::string_view description_of(Quantity quantity);

// The value in SI (angles in degrees), or nothing if the text is no number or its unit does not fit.
std::optional<double> parse_quantity(std::string_view text, Quantity quantity);

// The units that fit, for messages: "m, cm, mm, um, nm". Empty for plain numbers.
std::string units_of(Quantity quantity);

} // namespace haptel::runtime
