// The program that a Falcon runs, loaded into it after each power-up. It is not free to ship: the user has the file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace haptel::device {

// What is wrong with an image for the boot loader of a TI C2000; empty if it is in order. So a wrong file is refused
// before the device sees any of it. Little-endian words of 16 bits:
//
//   0x08AA, eight reserved, entry (high, low), blocks of {words, destination (high, low), data...}, 0
std::string firmware_fault(std::span<const uint8_t> image);

struct FirmwareFile {
    std::vector<uint8_t> image; // empty: see error
    std::filesystem::path path; // empty: there is none
    std::string error;
};

// `chosen` if it is not empty, else $HAPTEL_FALCON_FIRMWARE, else falcon_firmware.bin in ~/.config/haptel
// ($XDG_CONFIG_HOME). It is no error that the last is absent: a Falcon that runs already needs none.
FirmwareFile read_falcon_firmware(const std::filesystem::path& chosen);

} // namespace haptel::device
