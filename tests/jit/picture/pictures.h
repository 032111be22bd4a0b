// Picture files made byte by byte, by their formats' specifications: what the readers are held to.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace haptel::test {

// The value of a texel, the lowest row first.
using Texels = std::function<double(int column, int row)>;

class FileBytes {
public:
    explicit FileBytes(bool little = true) : little_(little) {}

    template <class Number>
    void put(Number value)
    {
        char raw[sizeof value];
        std::memcpy(raw, &value, sizeof value);
        if (little_ != (std::endian::native == std::endian::little)) std::reverse(raw, raw + sizeof value);
        bytes.append(raw, sizeof value);
    }
    void text(std::string_view text) { bytes.append(text); }

    std::string bytes;

private:
    bool little_;
};

enum class Numbers { unsigned_whole, signed_whole, real };

struct TiffKind {
    int bits = 8;
    Numbers numbers = Numbers::unsigned_whole;
    bool little = true, colour = false, white_is_zero = false, planes_apart = false;
    int tile = 0; // side of the tiles, a multiple of 16; 0: strips of one row
};

// A texel of a colour picture is its value times these: what a reader of brightness must weigh.
inline constexpr double tiff_tint[3] = {1, 0.5, 0.25};

// An f32 of few bits as IEEE half.
inline uint16_t half_of(double value)
{
    const auto bits = std::bit_cast<uint32_t>(static_cast<float>(value));
    const uint32_t sign = bits >> 16 & 0x8000, fraction = bits >> 13 & 0x3ff;
    const int exponent = static_cast<int>(bits >> 23 & 0xff) - 127 + 15;
    return static_cast<uint16_t>(exponent <= 0 ? sign : sign | static_cast<uint32_t>(exponent) << 10 | fraction);
}

inline void put_sample(FileBytes& file, const TiffKind& kind, double value)
{
    if (kind.numbers == Numbers::real) {
        if (kind.bits == 16)
            file.put(half_of(value));
        else if (kind.bits == 32)
            file.put(static_cast<float>(value));
        else
            file.put(value);
        return;
    }
    const bool is_signed = kind.numbers == Numbers::signed_whole;
    const double unit = static_cast<double>((int64_t{1} << (kind.bits - is_signed)) - 1);
    const auto whole = static_cast<int64_t>(std::llround(value * unit));
    switch (kind.bits) {
    case 8: file.put(static_cast<uint8_t>(whole)); break;
    case 16: file.put(static_cast<uint16_t>(whole)); break;
    default: file.put(static_cast<uint32_t>(whole));
    }
}

// TIFF 6.0, uncompressed.
inline std::string tiff(int columns, int rows, const TiffKind& kind, const Texels& value)
{
    const int samples = kind.colour ? 3 : 1, passes = kind.planes_apart ? samples : 1;
    std::vector<std::string> blocks;
    for (int pass = 0; pass < passes; ++pass) {
        const int across = kind.tile > 0 ? kind.tile : columns, down = kind.tile > 0 ? kind.tile : 1;
        for (int top = 0; top < rows; top += down)
            for (int left = 0; left < columns; left += across) {
                FileBytes block(kind.little);
                for (int y = top; y < top + down; ++y)
                    for (int x = left; x < left + across; ++x)
                        for (int s = kind.planes_apart ? pass : 0; s < (kind.planes_apart ? pass + 1 : samples); ++s) {
                            double v = x < columns && y < rows ? value(x, rows - 1 - y) : 0;
                            if (kind.white_is_zero) v = 1 - v;
                            put_sample(block, kind, kind.colour ? v * tiff_tint[s] : v);
                        }
                blocks.push_back(block.bytes);
            }
    }
    struct Entry {
        uint16_t tag, type; // 3: 16 bits, 4: 32 bits
        std::vector<uint32_t> values;
    };
    const auto u = [](auto v) { return static_cast<uint32_t>(v); };
    const uint32_t format = kind.numbers == Numbers::real ? 3 : kind.numbers == Numbers::signed_whole ? 2 : 1;
    std::vector<uint32_t> offsets, sizes;
    uint32_t at = 8;
    for (const std::string& block : blocks) {
        offsets.push_back(at);
        sizes.push_back(u(block.size()));
        at += u(block.size());
    }
    at += at % 2;
    std::vector<Entry> entries = {{256, 4, {u(columns)}},
                                  {257, 4, {u(rows)}},
                                  {258, 3, std::vector<uint32_t>(static_cast<size_t>(samples), u(kind.bits))},
                                  {259, 3, {1}},
                                  {262,
                                   3,
                                   {kind.colour          ? 2u
                                    : kind.white_is_zero ? 0u
                                                         : 1u}}};
    if (kind.tile == 0) entries.push_back({273, 4, offsets});
    entries.push_back({277, 3, {u(samples)}});
    if (kind.tile == 0) {
        entries.push_back({278, 4, {1}});
        entries.push_back({279, 4, sizes});
    }
    entries.push_back({284, 3, {kind.planes_apart ? 2u : 1u}});
    if (kind.tile > 0) {
        entries.push_back({322, 4, {u(kind.tile)}});
        entries.push_back({323, 4, {u(kind.tile)}});
        entries.push_back({324, 4, offsets});
        entries.push_back({325, 4, sizes});
    }
    entries.push_back({339, 3, std::vector<uint32_t>(static_cast<size_t>(samples), format)});

    FileBytes file(kind.little), beyond(kind.little); // long values stand behind the directory
    file.text(kind.little ? "II" : "MM");
    file.put(uint16_t{42});
    file.put(at);
    for (const std::string& block : blocks) file.text(block);
    if (file.bytes.size() % 2) file.put(uint8_t{0});
    const uint32_t behind = at + 2 + 12 * u(entries.size()) + 4;
    file.put(static_cast<uint16_t>(entries.size()));
    for (const Entry& entry : entries) {
        const auto put_values = [&](FileBytes& to) {
            for (const uint32_t v : entry.values)
                if (entry.type == 3)
                    to.put(static_cast<uint16_t>(v));
                else
                    to.put(v);
        };
        file.put(entry.tag);
        file.put(entry.type);
        file.put(u(entry.values.size()));
        const size_t size = entry.values.size() * (entry.type == 3 ? 2 : 4);
        if (size > 4) {
            file.put(behind + u(beyond.bytes.size()));
            put_values(beyond);
            if (beyond.bytes.size() % 2) beyond.put(uint8_t{0});
        } else {
            put_values(file);
            for (size_t i = size; i < 4; ++i) file.put(uint8_t{0});
        }
    }
    file.put(uint32_t{0});
    return file.bytes + beyond.bytes;
}

// OpenEXR 2, scan lines, uncompressed. Channels by the alphabet, all with the same texels times their weight.
struct ExrChannel {
    std::string name;
    double weight = 1;
};
inline std::string exr(int columns, int rows, bool halves, const std::vector<ExrChannel>& channels, const Texels& value)
{
    FileBytes file;
    file.put(uint32_t{20000630});
    file.put(uint32_t{2});
    const auto attribute = [&](std::string_view name, std::string_view type, const FileBytes& content) {
        for (const std::string_view text : {name, type}) {
            file.text(text);
            file.put('\0');
        }
        file.put(static_cast<uint32_t>(content.bytes.size()));
        file.text(content.bytes);
    };
    FileBytes list, window, centre;
    for (const ExrChannel& channel : channels) {
        list.text(channel.name);
        list.put('\0');
        list.put(uint32_t{halves ? 1u : 2u});
        list.put(uint32_t{0}); // linear or not, reserved
        list.put(uint32_t{1});
        list.put(uint32_t{1});
    }
    list.put('\0');
    for (const int32_t corner : {3, -2, 3 + columns - 1, -2 + rows - 1}) window.put(corner); // anywhere
    centre.put(0.0f);
    centre.put(0.0f);
    FileBytes zero, one;
    zero.put('\0');
    one.put(1.0f);
    attribute("channels", "chlist", list);
    attribute("compression", "compression", zero);
    attribute("dataWindow", "box2i", window);
    attribute("displayWindow", "box2i", window);
    attribute("lineOrder", "lineOrder", zero);
    attribute("pixelAspectRatio", "float", one);
    attribute("screenWindowCenter", "v2f", centre);
    attribute("screenWindowWidth", "float", one);
    file.put('\0');
    const size_t line = channels.size() * static_cast<size_t>(columns) * (halves ? 2 : 4), first = file.bytes.size();
    for (int row = 0; row < rows; ++row)
        file.put(static_cast<uint64_t>(first + 8 * static_cast<size_t>(rows) + static_cast<size_t>(row) * (line + 8)));
    for (int row = 0; row < rows; ++row) {
        file.put(int32_t{row - 2});
        file.put(static_cast<uint32_t>(line));
        for (const ExrChannel& channel : channels)
            for (int column = 0; column < columns; ++column) {
                const double v = channel.weight * value(column, rows - 1 - row);
                if (halves)
                    file.put(half_of(v));
                else
                    file.put(static_cast<float>(v));
            }
    }
    return file.bytes;
}

// PNG, gray, of data that is packed already. bits: 8 or 16.
inline std::string packed_png(int columns, int rows, int bits, const std::string& packed)
{
    FileBytes file(false);
    file.text("\x89PNG\r\n\x1a\n");
    const auto chunk = [&](const std::string& type, const std::string& content) {
        file.put(static_cast<uint32_t>(content.size()));
        uint32_t crc = ~0u;
        for (const char c : type + content) {
            crc ^= static_cast<uint8_t>(c);
            for (int k = 0; k < 8; ++k) crc = crc & 1 ? 0xedb88320u ^ crc >> 1 : crc >> 1;
        }
        file.text(type + content);
        file.put(~crc);
    };
    FileBytes head(false);
    head.put(static_cast<uint32_t>(columns));
    head.put(static_cast<uint32_t>(rows));
    head.put(static_cast<uint8_t>(bits));
    for (int i = 0; i < 4; ++i) head.put(uint8_t{0}); // gray, deflate, filters, no interlace
    chunk("IHDR", head.bytes);
    chunk("IDAT", packed);
    chunk("IEND", "");
    return file.bytes;
}

// PNG, gray, its data stored and not compressed. bits: 8 or 16.
inline std::string png(int columns, int rows, int bits, const Texels& value)
{
    FileBytes data(false);
    for (int row = 0; row < rows; ++row) {
        data.put(uint8_t{0}); // no filter
        for (int column = 0; column < columns; ++column)
            put_sample(data, {bits, Numbers::unsigned_whole}, value(column, rows - 1 - row));
    }
    uint32_t a = 1, b = 0; // Adler-32
    for (const char c : data.bytes) {
        a = (a + static_cast<uint8_t>(c)) % 65521;
        b = (b + a) % 65521;
    }
    FileBytes packed(false);
    packed.text("\x78\x01");
    for (size_t at = 0; at < data.bytes.size(); at += 65535) {
        const std::string part = data.bytes.substr(at, 65535);
        const auto size = static_cast<uint16_t>(part.size());
        packed.put(static_cast<uint8_t>(at + part.size() == data.bytes.size()));
        for (const uint16_t n : {size, static_cast<uint16_t>(~size)}) {
            packed.put(static_cast<uint8_t>(n & 255));
            packed.put(static_cast<uint8_t>(n >> 8));
        }
        packed.text(part);
    }
    packed.put(b << 16 | a);
    return packed_png(columns, rows, bits, packed.bytes);
}

} // namespace haptel::test
