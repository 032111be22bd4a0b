// Messages of Open Sound Control 1.0 (opensoundcontrol.org), as bytes of a datagram and as values.
//
// The bytes come from anywhere. liblo reads them, Debian's maintained library for this protocol: it checks each string
// and number of a message against the size of the datagram before it looks at it. Its servers are not used: they would
// open sockets for other machines, too. It does not take bundles apart that way, so split_osc does.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace haptel::tools {

inline constexpr std::size_t osc_bytes_max = 8192; // of a datagram; what is longer is refused

// What an argument may be; blobs, times and other kinds are refused.
using OscValue = std::variant<int32_t, int64_t, float, double, bool, std::string>;

struct OscMessage {
    std::string address;
    std::vector<OscValue> values;
    std::string error = {}; // why the bytes are no such message; empty: they are one
};

// As a scene file has it: "0.0005", "true", "60um".
std::string text_of(const OscValue& value);

// One message, no bundle.
OscMessage read_osc(std::string_view bytes);

// The messages of a datagram: itself, or those of a bundle, and of bundles in it, in their order. Times are not waited
// for.
struct OscParts {
    std::vector<std::string_view> messages;
    std::string error; // the bundle is damaged; then there are none
};
OscParts split_osc(std::string_view datagram);

// For a datagram.
std::string write_osc(const OscMessage& message);

} // namespace haptel::tools
