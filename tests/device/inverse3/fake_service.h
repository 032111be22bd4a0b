// An Inverse3 service in this process, on a free port, with a device behind it that holds the force it heard last,
// whoever said it, until it hears another.
#pragma once

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace haptel::device {

enum class ServiceFault : uint8_t {
    none,
    // To what connects:
    mute,         // nothing at all
    web_page,     // HTTP, and no WebSocket
    no_inventory, // a WebSocket without a word
    bad_inventory,
    no_device,
    other_device,
    // To messages:
    silent,
    slow,    // answers come late
    unasked, // two states for one message
    gone,    // the device is in no state any more
    bad_json,
    bad_state, // JSON, but no place in it
    infinite,  // 1e999 m
    binary,
    huge,
    endless,      // a message that does not end
    random_bytes, // as text
    bad_frame,    // no WebSocket frame
    goodbye,      // closes as one should
    reset,        // closes as one should not
};
inline constexpr int service_faults = static_cast<int>(ServiceFault::reset) + 1;
const char* name_of(ServiceFault fault);
// It is one to messages, and of those one that a driver cannot live with.
bool ends_connection(ServiceFault fault);

class FakeService {
public:
    FakeService(); // runs
    ~FakeService();
    FakeService(const FakeService&) = delete;
    FakeService& operator=(const FakeService&) = delete;

    void stop(); // as if it was killed
    void start();
    uint16_t port() const;

    // To connections at once; to `count` messages after `after` more.
    void inject(ServiceFault fault, uint64_t after = 0, uint64_t count = uint64_t{1} << 60);
    void place_at(const glm::dvec3& position_m, const glm::dvec3& velocity_m_per_s = glm::dvec3(0));
    void answer_after_ms(int ms); // of ServiceFault::slow
    void set_preset(std::string preset);

    glm::dvec3 force_n() const;               // that the device holds
    std::vector<glm::dvec3> forces_n() const; // all that were heard
    std::vector<std::string> texts() const;   // the first messages, as they came
    uint64_t messages() const, states() const, connections() const, messages_with_force() const;
    // Messages that are none, that begin a connection with a force, and goodbyes with one.
    uint64_t violations() const;
    bool has_met_fault() const; // somebody was answered with it

private:
    struct Service;
    std::unique_ptr<Service> service_;
};

} // namespace haptel::device
