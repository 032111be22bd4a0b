#include "device/inverse3/inverse3_message.h"

#include "runtime/geometry/finite.h"

#include <algorithm>
#include <charconv>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

namespace haptel::device {

namespace {

using Json = nlohmann::json;

constexpr double reach_max_m = 10; // of a device, wherever its mount puts the origin

// Appends what fits: the longest message does, by the lengths above.
void append(Inverse3Text& text, std::string_view more) noexcept
{
    const std::size_t count = std::min(more.size(), text.bytes.size() - text.size);
    std::copy_n(more.begin(), count, text.bytes.begin() + static_cast<std::ptrdiff_t>(text.size));
    text.size += count;
}

void append(Inverse3Text& text, double number) noexcept
{
    const auto [end, error] =
        std::to_chars(text.bytes.data() + text.size, text.bytes.data() + text.bytes.size(), number);
    if (error == std::errc()) text.size = static_cast<std::size_t>(end - text.bytes.data());
}

void append_force(Inverse3Text& text, std::string_view id, const glm::dvec3& force_n) noexcept
{
    append(text, R"("inverse3":[{"device_id":")");
    append(text, is_inverse3_id(id) ? id : std::string_view());
    append(text, R"(","commands":{"set_cursor_force":{"values":{"x":)");
    append(text, force_n.x);
    append(text, R"(,"y":)");
    append(text, force_n.y);
    append(text, R"(,"z":)");
    append(text, force_n.z);
    append(text, "}}}}]}");
}

// Null where there is no such member, or nothing that has members.
const Json* member(const Json* object, const char* name)
{
    if (!object || !object->is_object()) return nullptr;
    const auto found = object->find(name);
    return found == object->end() ? nullptr : &*found;
}

const Json* devices_of(const Json& message)
{
    const Json* devices = member(&message, "inverse3");
    return devices && devices->is_array() ? devices : nullptr;
}

// Empty: it has none that a message can name.
std::string id_of(const Json& device)
{
    const Json* id = member(&device, "device_id");
    if (!id || !id->is_string()) return "";
    const std::string& text = id->get_ref<const std::string&>();
    return is_inverse3_id(text) ? text : "";
}

std::optional<glm::dvec3> vector_of(const Json* object)
{
    glm::dvec3 vector(0);
    constexpr std::array<const char*, 3> names = {"x", "y", "z"};
    for (int i = 0; i < 3; ++i) {
        const Json* number = member(object, names[static_cast<std::size_t>(i)]);
        if (!number || !number->is_number()) return std::nullopt;
        vector[i] = number->get<double>();
    }
    if (!runtime::finite(vector)) return std::nullopt;
    return vector;
}

// Discarded where it is no JSON: nothing is thrown.
Json parsed(std::string_view text)
{
    return Json::parse(text.begin(), text.end(), nullptr, false);
}

} // namespace

bool is_inverse3_id(std::string_view id) noexcept
{
    const auto plain = [](char c) {
        return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '-' || c == '_' ||
               c == '.';
    };
    return !id.empty() && id.size() <= inverse3_id_bytes_max && std::all_of(id.begin(), id.end(), plain);
}

Inverse3Text inverse3_force(std::string_view id, const glm::dvec3& force_n) noexcept
{
    Inverse3Text text;
    append(text, "{");
    append_force(text, id, runtime::finite(force_n) ? force_n : glm::dvec3(0));
    return text;
}

Inverse3Text inverse3_first_message(std::string_view id) noexcept
{
    Inverse3Text text;
    append(text, R"({"session":{"configure":{"profile":{"name":"haptel"}}},)");
    append_force(text, id, glm::dvec3(0));
    return text;
}

Inverse3Inventory read_inverse3_inventory(std::string_view text)
{
    const Json message = parsed(text);
    if (!message.is_object()) return {{}, "its first message is no JSON object"};
    if (!message.contains("inverse3")) return {}; // a service with other devices
    const Json* devices = devices_of(message);
    if (!devices) return {{}, "its `inverse3` is no list of devices"};
    Inverse3Inventory inventory;
    for (const Json& device : *devices) {
        std::string id = id_of(device);
        if (id.empty()) return {{}, "it lists a device without a `device_id` of letters and digits"};
        const Json* preset = member(member(&device, "config"), "preset");
        const bool is_centred = preset && preset->is_string() &&
                                std::string_view(preset->get_ref<const std::string&>()).ends_with("_centered");
        inventory.devices.push_back({std::move(id), is_centred});
    }
    return inventory;
}

Inverse3Reply read_inverse3_state(std::string_view text, std::string_view id)
{
    const Json message = parsed(text);
    if (!message.is_object()) return {};
    const Json* devices = devices_of(message);
    if (!devices) return {message.contains("inverse3") ? Inverse3Heard::malformed : Inverse3Heard::no_device, {}};
    const auto device =
        std::find_if(devices->begin(), devices->end(), [&](const Json& one) { return id_of(one) == id; });
    if (device == devices->end()) return {Inverse3Heard::no_device, {}};
    const Json* state = member(&*device, "state");
    const auto position_m = vector_of(member(state, "cursor_position"));
    if (!position_m || glm::length(*position_m) > reach_max_m) return {};
    const Json* velocity = member(state, "cursor_velocity");
    const auto velocity_m_per_s = velocity ? vector_of(velocity) : glm::dvec3(0);
    if (!velocity_m_per_s) return {};
    return {Inverse3Heard::state, {*position_m, *velocity_m_per_s}};
}

} // namespace haptel::device
