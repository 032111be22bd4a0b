#include "tools/control/osc_message.h"

#include <cstdlib>
#include <cstring>
#include <fmt/format.h>
#include <lo/lo.h>
#include <lo/lo_lowlevel.h>
#include <memory>

namespace haptel::tools {

namespace {

using LoMessage = std::unique_ptr<std::remove_pointer_t<lo_message>, decltype(&lo_message_free)>;

constexpr std::string_view bundle_mark("#bundle\0", 8);
constexpr std::size_t bundle_head = 16; // the mark and a time
constexpr std::size_t messages_max = 256, bundles_max = 64;

uint32_t big_endian(std::string_view bytes)
{
    uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<unsigned char>(bytes[i]);
    return value;
}

// liblo gives the place of a value, which the protocol aligns to 4 bytes alone.
template <typename Number>
Number number_at(const void* place)
{
    Number number;
    std::memcpy(&number, place, sizeof number);
    return number;
}

// False: of a kind that is not taken.
bool read_value(char type, const void* from, std::vector<OscValue>& to)
{
    switch (type) {
    case LO_INT32: to.emplace_back(number_at<int32_t>(from)); return true;
    case LO_INT64: to.emplace_back(number_at<int64_t>(from)); return true;
    case LO_FLOAT: to.emplace_back(number_at<float>(from)); return true;
    case LO_DOUBLE: to.emplace_back(number_at<double>(from)); return true;
    case LO_STRING:
    case LO_SYMBOL: to.emplace_back(std::string(static_cast<const char*>(from))); return true;
    case LO_TRUE: to.emplace_back(true); return true;
    case LO_FALSE: to.emplace_back(false); return true;
    default: return false;
    }
}

struct AddTo {
    lo_message message;

    void operator()(int32_t value) const { lo_message_add_int32(message, value); }
    void operator()(int64_t value) const { lo_message_add_int64(message, value); }
    void operator()(float value) const { lo_message_add_float(message, value); }
    void operator()(double value) const { lo_message_add_double(message, value); }
    void operator()(bool value) const
    {
        if (value)
            lo_message_add_true(message);
        else
            lo_message_add_false(message);
    }
    void operator()(const std::string& value) const { lo_message_add_string(message, value.c_str()); }
};

} // namespace

std::string text_of(const OscValue& value)
{
    return std::visit(
        [](const auto& held) {
            if constexpr (std::is_same_v<std::decay_t<decltype(held)>, std::string>)
                return held;
            else
                return fmt::format("{}", held);
        },
        value);
}

OscMessage read_osc(std::string_view bytes)
{
    if (bytes.empty() || bytes.size() > osc_bytes_max || bytes.size() % 4 != 0 || bytes[0] != '/')
        return {{}, {}, "a message starts with an address such as /haptel/stop and has a multiple of 4 bytes"};
    std::vector<double> aligned((bytes.size() + sizeof(double) - 1) /
                                sizeof(double)); // it turns numbers round in place
    char* const copy = reinterpret_cast<char*>(aligned.data());
    bytes.copy(copy, bytes.size());
    int failed = 0;
    const LoMessage read(lo_message_deserialise(copy, bytes.size(), &failed), lo_message_free);
    if (!read) return {{}, {}, "its address, its types or its values are cut short or not padded with zeros"};
    OscMessage message{copy, {}};
    const std::string_view types = lo_message_get_types(read.get());
    lo_arg** const values = lo_message_get_argv(read.get());
    for (std::size_t i = 0; i < types.size(); ++i) {
        if (!read_value(types[i], values[i], message.values))
            return {message.address,
                    {},
                    fmt::format("expected numbers, texts, true or false, found the type '{}'",
                                types[i] > ' ' && types[i] <= '~' ? types[i] : '?')};
    }
    return message;
}

OscParts split_osc(std::string_view datagram)
{
    if (datagram.size() > osc_bytes_max)
        return {{}, fmt::format("a datagram has at most {} bytes, found more", osc_bytes_max)};
    OscParts parts;
    std::vector<std::string_view> waiting = {datagram}; // the next one last
    for (std::size_t bundles = 0; !waiting.empty();) {
        const std::string_view next = waiting.back();
        waiting.pop_back();
        if (!next.starts_with(bundle_mark)) {
            parts.messages.push_back(next);
            if (parts.messages.size() > messages_max)
                return {{}, fmt::format("a bundle has at most {} messages, found more", messages_max)};
            continue;
        }
        if (++bundles > bundles_max) return {{}, fmt::format("found more than {} bundles in one", bundles_max)};
        std::vector<std::string_view> elements;
        for (std::size_t at = bundle_head; at != next.size();) {
            if (at > next.size() || next.size() - at < 4) return {{}, "a bundle is cut short"};
            const std::size_t size = big_endian(next.substr(at));
            at += 4;
            if (size == 0 || size % 4 != 0 || size > next.size() - at)
                return {{}, "an element of a bundle is longer than the bundle, or not of a multiple of 4 bytes"};
            elements.push_back(next.substr(at, size));
            at += size;
        }
        waiting.insert(waiting.end(), elements.rbegin(), elements.rend());
    }
    return parts;
}

std::string write_osc(const OscMessage& message)
{
    const LoMessage made(lo_message_new(), lo_message_free);
    for (const OscValue& value : message.values) std::visit(AddTo{made.get()}, value);
    std::size_t size = 0;
    const std::unique_ptr<void, decltype(&std::free)> bytes(
        lo_message_serialise(made.get(), message.address.c_str(), nullptr, &size), std::free);
    return bytes ? std::string(static_cast<const char*>(bytes.get()), size) : std::string();
}

} // namespace haptel::tools
