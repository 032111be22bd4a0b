// A program for the boot loader that is no program: two blocks of numbers.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <vector>

namespace haptel::device {

inline std::vector<uint8_t> synthetic_firmware(uint16_t words = 700)
{
    std::vector<uint8_t> image;
    const auto add = [&](std::initializer_list<uint16_t> list) {
        for (const uint16_t word : list) {
            image.push_back(static_cast<uint8_t>(word % 256));
            image.push_back(static_cast<uint8_t>(word / 256));
        }
    };
    add({0x08aa, 0, 0, 0, 0, 0, 0, 0, 0, 0x003f, 0x8002, words, 0x003f, 0x8000});
    for (uint16_t i = 0; i < words; ++i) add({static_cast<uint16_t>(i * 40503u)});
    add({3, 0x0000, 0x0400, 0x1234, 0x5678, 0x9abc, 0});
    return image;
}

} // namespace haptel::device
