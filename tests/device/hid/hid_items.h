// Report descriptors for tests, item by item as in HID 1.11, section 6.2.2.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <vector>

namespace haptel::device {

class HidItems {
public:
    std::vector<uint8_t> bytes;

    HidItems& page(uint32_t value) { return item(0x04, value); }
    HidItems& logical(int64_t minimum, int64_t maximum) { return item(0x14, minimum).item(0x24, maximum); }
    HidItems& size(int bits, int count) { return item(0x74, bits).item(0x94, count); }
    HidItems& report(uint8_t id) { return item(0x84, id); }
    HidItems& usages(std::initializer_list<uint32_t> all)
    {
        for (const uint32_t usage : all) usage > 0xffff ? wide(0x08, usage) : item(0x08, usage);
        return *this;
    }
    HidItems& usage_range(uint32_t first, uint32_t last) { return item(0x18, first).item(0x28, last); }
    HidItems& begin(uint32_t usage, uint32_t kind = 2) { return item(0x08, usage).item(0xa0, kind); }
    HidItems& end()
    {
        bytes.push_back(0xc0);
        return *this;
    }
    HidItems& input(uint32_t flags) { return item(0x80, flags); }
    HidItems& output(uint32_t flags) { return item(0x90, flags); }
    HidItems& feature(uint32_t flags) { return item(0xb0, flags); }

    // As few bytes as hold it with its sign.
    HidItems& item(uint8_t prefix, int64_t value)
    {
        if (value >= -128 && value < 128) return put(prefix | 1, value, 1);
        if (value >= -32768 && value < 32768) return put(prefix | 2, value, 2);
        return put(prefix | 3, value, 4);
    }
    HidItems& wide(uint8_t prefix, int64_t value) { return put(prefix | 3, value, 4); }

private:
    HidItems& put(int prefix, int64_t value, int size)
    {
        bytes.push_back(static_cast<uint8_t>(prefix));
        for (int i = 0; i < size; ++i) bytes.push_back(static_cast<uint8_t>(value >> (8 * i)));
        return *this;
    }
};

inline constexpr uint32_t hid_data = 2, hid_padding = 3, hid_array = 0; // flags of main items

// OpenFFBoard with two axes: 64 buttons and eight axes of 16 bits, a vendor's report with numbers of 64 bits, and the
// reports of PID. Its Device Control has a bit for each thing that it does.
inline std::vector<uint8_t> openffboard_descriptor()
{
    HidItems d;
    const auto block = [&] { d.usages({0x22}).logical(1, 40).size(8, 1).output(hid_data); };
    const auto types = [&] {
        d.begin(0x25).usages({0x26, 0x27, 0x30, 0x31, 0x32, 0x33, 0x34, 0x40, 0x41, 0x42, 0x43});
        d.item(0x24, 11).item(0x14, 1).size(8, 1); // the maximum first
    };
    d.page(1).begin(4, 1).item(0xa0, 0).report(1);
    d.page(9).usage_range(1, 64).logical(0, 1).size(1, 64).input(hid_data);
    d.page(1).usages({0x30, 0x31, 0x32, 0x33, 0x34, 0x35, 0x37, 0x36}).logical(-32767, 32767).size(16, 8);
    d.input(hid_data).end();
    d.page(0xff00).begin(0, 1).report(0xa1).usages({1}).logical(0, 4).size(8, 1).output(hid_data);
    d.usages({2}).size(16, 1).output(hid_data).usages({3}).size(8, 1).output(hid_data);
    d.usages({4}).size(32, 1).output(hid_data).usages({5}).size(64, 1).output(hid_data).usages({6}).output(hid_data);
    d.usages({1}).size(8, 1).input(hid_data).usages({5}).size(64, 2).input(hid_data).end();

    d.page(0x0f).begin(0x92).report(2).usages({0x9f, 0xa0, 0xa4, 0xa6, 0x94}).logical(0, 1).size(1, 5);
    d.input(hid_data).size(1, 3).input(hid_padding).end();
    d.begin(0x21).report(1); // Set Effect
    block();
    types();
    d.output(hid_array).end();
    d.usages({0x50, 0x54, 0x51, 0xa7}).logical(0, 0x7fff).size(16, 4).output(hid_data);
    d.usages({0x52}).logical(0, 255).size(8, 1).output(hid_data);
    d.usages({0x53}).logical(1, 8).size(8, 1).output(hid_data);
    d.begin(0x55).page(1).usages({0x30, 0x31}).logical(0, 1).size(1, 2).output(hid_data).end();
    d.page(0x0f).usages({0x56}).size(1, 1).output(hid_data).size(1, 5).output(hid_padding);
    d.begin(0x57).usages({0x000a0001, 0x000a0002}).logical(0, 36000).size(16, 2).output(hid_data).end();
    d.page(0x0f).begin(0x58).usages({0x000a0001, 0x000a0002}).item(0x24, 32765).size(16, 2).output(hid_data).end();
    d.end();
    d.begin(0x5a).report(2); // Set Envelope
    block();
    d.usages({0x5b, 0x5d}).logical(0, 0x7fff).size(16, 2).output(hid_data);
    d.usages({0x5c, 0x5e}).size(32, 2).output(hid_data).end();
    d.begin(0x6e).report(4); // Set Periodic: a magnitude that is not meant
    block();
    d.usages({0x70}).logical(0, 0x7fff).size(16, 1).output(hid_data);
    d.usages({0x6f}).logical(-32768, 32767).output(hid_data).end();
    d.begin(0x73).report(5); // Set Constant Force
    block();
    d.usages({0x70}).logical(-32768, 32767).size(16, 1).output(hid_data).end();
    d.begin(0x77).report(10); // Effect Operation
    block();
    d.begin(0x78).usages({0x79, 0x7a, 0x7b}).logical(1, 3).size(8, 1).output(hid_array).end();
    d.usages({0x7c}).logical(0, 255).output(hid_data).end();
    d.begin(0x90).report(11); // Block Free
    block();
    d.end();
    d.begin(0x95).report(12).begin(0x96).usages({0x97, 0x98, 0x99, 0x9a, 0x9b, 0x9c}).logical(1, 6).size(1, 8);
    d.output(hid_data).end().end();
    d.begin(0x7d).report(13).usages({0x7e}).logical(0, 255).size(8, 1).output(hid_data).end();
    d.begin(0xab).report(17); // Create New Effect
    types();
    d.feature(hid_array).end();
    d.page(1).usages({0x3b}).logical(0, 511).size(10, 1).feature(hid_data).item(0x74, 6).feature(1).end();
    d.page(0x0f).begin(0x89).report(18).usages({0x22}).logical(1, 40).size(8, 1).feature(hid_data);
    d.begin(0x8b).usages({0x8c, 0x8d, 0x8e}).logical(1, 3).size(8, 1).feature(hid_array).end();
    d.usages({0xac}).logical(0, 0xffff).size(16, 1).feature(hid_array).end();
    d.begin(0x7f).report(19).usages({0x80}).size(16, 1).feature(hid_data); // the pool of effects
    d.usages({0x83}).logical(0, 255).size(8, 1).feature(hid_data);
    d.usages({0xa9, 0xaa}).logical(0, 1).size(1, 2).feature(hid_data).size(1, 6).feature(hid_padding).end();
    return d.end().bytes;
}

// A stick in the manner of the examples of PID 1.0: axes of eight bits, ids in another order, a Device Control that
// chooses, angles of 8 bits, a constant force of -255 .. 255, and both axes enabled beside the direction.
inline std::vector<uint8_t> pid_example_descriptor()
{
    HidItems d;
    const auto block = [&] { d.usages({0x22}).logical(1, 40).size(8, 1).output(hid_data); };
    d.page(1).begin(4, 1).begin(1, 0).report(1).usages({0x30, 0x31}).logical(-127, 127).size(8, 2).input(hid_data);
    d.end().page(0x0f);
    d.begin(0x21).report(3);
    block();
    d.begin(0x25).usages({0x31, 0x26, 0x40}).logical(1, 3).size(8, 1).output(hid_array).end();
    d.usages({0x50, 0x54}).logical(0, 10000).size(16, 2).output(hid_data);
    d.usages({0x52}).item(0x14, 0).wide(0x24, 255).size(8, 1).output(hid_data);
    d.begin(0x55).page(1).usages({0x30, 0x31}).logical(0, 1).size(1, 2).output(hid_data).end();
    d.page(0x0f).usages({0x56}).size(1, 1).output(hid_data).size(5, 1).output(hid_padding);
    d.begin(0x57).usages({0x000a0001, 0x000a0002}).logical(0, 255).size(8, 2).output(hid_data).end().end();
    d.begin(0x73).report(7);
    block();
    d.usages({0x70}).logical(-255, 255).size(16, 1).output(hid_data).end();
    d.begin(0x77).report(8);
    block();
    d.begin(0x78).usages({0x7b, 0x79}).logical(0, 1).size(8, 1).output(hid_array).end();
    d.usages({0x7c}).logical(0, 255).output(hid_data).end();
    d.begin(0x96).report(9).usages({0x97, 0x98, 0x99, 0x9a}).logical(1, 4).size(8, 1).output(hid_array).end();
    d.begin(0xab).report(1).begin(0x25).usages({0x31, 0x26, 0x40}).logical(1, 3).size(8, 1);
    d.feature(hid_array).end().end();
    d.begin(0x89).report(2).usages({0x22}).logical(1, 40).size(8, 1).feature(hid_data);
    d.begin(0x8b).usages({0x8c, 0x8d, 0x8e}).logical(1, 3).size(8, 1).feature(hid_array).end().end();
    return d.end().bytes;
}

} // namespace haptel::device
