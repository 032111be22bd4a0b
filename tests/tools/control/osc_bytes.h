// OSC 1.0 messages as bytes, put together and taken apart by hand: what the product's reader and writer are held to.
#pragma once

#include <arpa/inet.h>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

namespace haptel::test {

inline std::string osc_text(std::string_view text)
{
    std::string padded(text);
    padded.append(4 - padded.size() % 4, '\0');
    return padded;
}

inline std::string osc_word(uint32_t word)
{
    const uint32_t big = htonl(word);
    return {reinterpret_cast<const char*>(&big), sizeof big};
}

inline std::string osc_float(float value)
{
    return osc_word(std::bit_cast<uint32_t>(value));
}

// `values`: the bytes of all arguments, one after the other.
inline std::string osc_bytes(std::string_view address, std::string_view types = "", std::string_view values = "")
{
    return osc_text(address) + osc_text("," + std::string(types)) + std::string(values);
}

inline std::string osc_string_message(std::string_view address, std::string_view text)
{
    return osc_bytes(address, "s", osc_text(text));
}

inline std::string osc_bundle(const std::vector<std::string>& elements)
{
    std::string bytes = osc_text("#bundle") + osc_word(0) + osc_word(1);
    for (const std::string& element : elements) bytes += osc_word(static_cast<uint32_t>(element.size())) + element;
    return bytes;
}

// Of a message of ours; each argument as text.
struct OscHeard {
    std::string address;
    std::vector<std::string> values;
};

inline OscHeard osc_heard(std::string_view bytes)
{
    const auto text_at = [&](size_t& at) {
        const std::string text(bytes.substr(at).data()); // ours end in a zero
        at += text.size() + 4 - text.size() % 4;
        return text;
    };
    const auto word_at = [&](size_t& at) {
        uint32_t big = 0;
        std::memcpy(&big, bytes.data() + at, sizeof big);
        at += sizeof big;
        return ntohl(big);
    };
    size_t at = 0;
    OscHeard heard{text_at(at), {}};
    for (const char type : text_at(at).substr(1))
        if (type == 's')
            heard.values.push_back(text_at(at));
        else if (type == 'i')
            heard.values.push_back(std::to_string(static_cast<int32_t>(word_at(at))));
        else if (type == 'f')
            heard.values.push_back(std::to_string(std::bit_cast<float>(word_at(at))));
        else if (type == 'd') {
            const uint64_t high = word_at(at), low = word_at(at);
            char text[40];
            std::snprintf(text, sizeof text, "%.17g", std::bit_cast<double>(high << 32 | low));
            heard.values.push_back(text);
        } else
            heard.values.push_back(std::string(1, type));
    return heard;
}

} // namespace haptel::test
