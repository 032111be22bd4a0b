#include "runtime/servo/trace_origin.h"

#include "runtime/scene/scene_fields.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>

namespace haptel::runtime {

namespace {

constexpr std::array<std::string_view, 4> kinds = {"scene", "mesh", "texture", "picture"};
constexpr std::size_t sum_digits = 32;

std::string in_one_line(std::string_view text)
{
    constexpr std::string_view digits = "0123456789abcdef";
    std::string line;
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        if (byte >= 0x20 && c != '%')
            line += c;
        else
            line += {'%', digits[byte >> 4], digits[byte & 15]};
    }
    return line;
}

std::string from_one_line(std::string_view line)
{
    std::string text;
    while (!line.empty()) {
        uint8_t byte = 0;
        const bool is_coded =
            line.size() >= 3 && line[0] == '%' && std::from_chars(&line[1], &line[1] + 2, byte, 16).ptr == &line[1] + 2;
        text += is_coded ? static_cast<char>(byte) : line[0];
        line.remove_prefix(is_coded ? 3 : 1);
    }
    return text;
}

template <typename Number>
void read_number(std::string_view text, Number& into)
{
    Number value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error == std::errc() && end == text.data() + text.size()) into = value;
}

bool read_sum(std::string_view text, input::Checksum& sum)
{
    const auto half = [&](std::size_t at, uint64_t& into) {
        const char* const end = text.data() + at + sum_digits / 2;
        const auto [stopped, error] = std::from_chars(text.data() + at, end, into, 16);
        return error == std::errc() && stopped == end;
    };
    return text.size() == sum_digits && half(0, sum.high) && half(sum_digits / 2, sum.low);
}

} // namespace

const TracedFile* TraceOrigin::scene() const
{
    const auto found = std::find_if(files.begin(), files.end(), [](const TracedFile& f) { return f.kind == "scene"; });
    return found == files.end() ? nullptr : &*found;
}

std::string to_text(const TraceOrigin& origin)
{
    std::string text;
    const auto say = [&](std::string_view word, const std::string& value) {
        text.append(word).append(" ").append(value).append("\n");
    };
    say("haptel", in_one_line(origin.haptel));
    say("device", in_one_line(origin.device.name));
    say("force_max_n", shortest(origin.device.force_max_n));
    say("stiffness_max_n_per_m", shortest(origin.device.stiffness_max_n_per_m));
    say("workspace_radius_m", shortest(origin.device.workspace_radius_m));
    say("position_resolution_m", shortest(origin.device.position_resolution_m));
    if (origin.device.slopes_only) say("slopes_only", "1");
    say("hand", std::to_string(origin.hand));
    say("rate_hz", shortest(origin.rate_hz));
    say("clock", in_one_line(origin.clock));
    for (const TracedFile& file : origin.files)
        say(in_one_line(file.kind), input::to_text(file.sum) + " " + in_one_line(file.path));
    return text;
}

void read_line(std::string_view line, TraceOrigin& origin)
{
    const std::size_t space = line.find(' ');
    if (space == line.npos) return;
    const std::string_view word = line.substr(0, space), value = line.substr(space + 1);
    if (word == "haptel") origin.haptel = from_one_line(value);
    if (word == "device") origin.device.name = from_one_line(value);
    if (word == "force_max_n") read_number(value, origin.device.force_max_n);
    if (word == "stiffness_max_n_per_m") read_number(value, origin.device.stiffness_max_n_per_m);
    if (word == "workspace_radius_m") read_number(value, origin.device.workspace_radius_m);
    if (word == "position_resolution_m") read_number(value, origin.device.position_resolution_m);
    if (word == "slopes_only") origin.device.slopes_only = value == "1";
    if (word == "hand") read_number(value, origin.hand);
    if (word == "rate_hz") read_number(value, origin.rate_hz);
    if (word == "clock") origin.clock = from_one_line(value);
    if (std::find(kinds.begin(), kinds.end(), word) == kinds.end()) return;
    TracedFile file{std::string(word), {}, {}};
    if (value.size() <= sum_digits || value[sum_digits] != ' ' || !read_sum(value.substr(0, sum_digits), file.sum))
        return;
    file.path = from_one_line(value.substr(sum_digits + 1));
    origin.files.push_back(std::move(file));
}

} // namespace haptel::runtime
