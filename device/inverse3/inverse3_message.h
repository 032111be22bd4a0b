// What is said to the Inverse3 service and what it says, as text: one JSON object a message.
//
// Lengths are metres, forces newtons. The axes are the service's own, which are Haptel's: x to the right, y away from
// the user, z up; a service that was told to turn them turns forces and places alike.
#pragma once

#include <glm/glm.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace haptel::device {

inline constexpr std::size_t inverse3_id_bytes_max = 64;

// Letters, digits, '-', '_', '.' and at most so many bytes: what stands in a message as it is.
bool is_inverse3_id(std::string_view id) noexcept;

// A message in a place of its own: to compose one allocates nothing and asks no locale.
struct Inverse3Text {
    std::array<char, 384> bytes{};
    std::size_t size = 0;

    std::string_view view() const noexcept { return {bytes.data(), size}; }
};

// The device holds the force until it hears another. One that is not finite is said as none, and so is an id that
// is none.
Inverse3Text inverse3_force(std::string_view id, const glm::dvec3& force_n) noexcept;
// The first message of a connection: who speaks, and no force.
Inverse3Text inverse3_first_message(std::string_view id) noexcept;

struct Inverse3Listed {
    std::string id;
    bool is_centred = false; // its origin is the middle of the workspace already, by its `preset`; else at its base
};

struct Inverse3Inventory {
    std::vector<Inverse3Listed> devices;
    std::string error; // in words: it is no inventory
};
Inverse3Inventory read_inverse3_inventory(std::string_view text);

struct Inverse3State {
    glm::dvec3 position_m{0};
    glm::dvec3 velocity_m_per_s{0}; // 0 where the service says none
};

enum class Inverse3Heard : uint8_t {
    state,
    no_device, // the message is one, but tells nothing of that device
    malformed,
};
struct Inverse3Reply {
    Inverse3Heard heard = Inverse3Heard::malformed;
    Inverse3State state;
};
// Further from the origin than any device reaches, or not finite: malformed.
Inverse3Reply read_inverse3_state(std::string_view text, std::string_view id);

} // namespace haptel::device
