#include "device/falcon/falcon_firmware.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <optional>

namespace haptel::device {

namespace {

constexpr uint16_t boot_key = 0x08aa;
constexpr int reserved_words = 8;
constexpr uint32_t address_limit = 1u << 22;        // of the processor's memory, in words
constexpr std::uintmax_t file_bytes_max = 1u << 18; // far more than the processor has memory for

class ImageWords {
public:
    explicit ImageWords(std::span<const uint8_t> bytes) : bytes_(bytes) {}
    std::optional<uint16_t> next()
    {
        if (bytes_.size() - at_ < 2) return std::nullopt;
        at_ += 2;
        return static_cast<uint16_t>(bytes_[at_ - 2] | bytes_[at_ - 1] << 8);
    }
    std::optional<uint32_t> next_address()
    {
        const auto high = next(), low = next();
        if (!high || !low) return std::nullopt;
        return uint32_t(*high) << 16 | *low;
    }
    bool skip(std::size_t words)
    {
        if ((bytes_.size() - at_) / 2 < words) return false;
        at_ += 2 * words;
        return true;
    }
    std::size_t at() const { return at_; }

private:
    std::span<const uint8_t> bytes_;
    std::size_t at_ = 0;
};

std::string environment(const char* name)
{
    const char* value = std::getenv(name);
    return value ? value : "";
}

std::filesystem::path default_firmware_path()
{
    const std::string config = environment("XDG_CONFIG_HOME"), home = environment("HOME");
    if (config.empty() && home.empty()) return {};
    const std::filesystem::path folder =
        config.empty() ? std::filesystem::path(home) / ".config" : std::filesystem::path(config);
    return folder / "haptel" / "falcon_firmware.bin";
}

} // namespace

std::string firmware_fault(std::span<const uint8_t> image)
{
    ImageWords words(image);
    const std::string cut_off = "the image ends in the middle";
    const auto key = words.next();
    if (!key) return "the image is empty";
    if (*key != boot_key) return fmt::format("it begins with {:#06x}, not with the boot loader's key 0x08aa", *key);
    for (int i = 0; i < reserved_words; ++i) {
        const auto reserved = words.next();
        if (!reserved) return cut_off;
        if (*reserved != 0) return fmt::format("reserved word {} is {:#06x}, not 0", i + 1, *reserved);
    }
    const auto entry = words.next_address();
    if (!entry) return cut_off;
    if (*entry >= address_limit) return fmt::format("it starts at {:#x}, which no memory has", *entry);
    for (int block = 0;; ++block) {
        const auto size = words.next();
        if (!size) return cut_off;
        if (*size == 0) {
            if (block == 0) return "it holds no program";
            break;
        }
        const auto destination = words.next_address();
        if (!destination || !words.skip(*size)) return cut_off;
        if (*destination + *size > address_limit)
            return fmt::format("block {} goes to {:#x}, which no memory has", block + 1, *destination);
    }
    if (words.at() != image.size()) return fmt::format("{} bytes follow its end", image.size() - words.at());
    return {};
}

FirmwareFile read_falcon_firmware(const std::filesystem::path& chosen)
{
    FirmwareFile file;
    file.path = chosen.empty() ? std::filesystem::path(environment("HAPTEL_FALCON_FIRMWARE")) : chosen;
    const bool asked_for = !file.path.empty();
    if (!asked_for) file.path = default_firmware_path();
    std::error_code none;
    if (!asked_for && !std::filesystem::exists(file.path, none)) return {};
    const auto size = std::filesystem::file_size(file.path, none);
    std::ifstream stream(file.path, std::ios::binary);
    if (none || !stream) {
        file.error = fmt::format("the Falcon's firmware cannot be read from '{}' ({}): expected a file that you may "
                                 "read; HAPTEL_FALCON_FIRMWARE names another",
                                 file.path.string(), none ? none.message() : std::strerror(errno));
        return file;
    }
    if (size <= file_bytes_max) file.image.assign(std::istreambuf_iterator<char>(stream), {});
    const std::string fault = size > file_bytes_max
                                  ? fmt::format("it has {} bytes, more than the Falcon has memory for", size)
                                  : firmware_fault(file.image);
    if (!fault.empty()) {
        file.error =
            fmt::format("'{}' is no firmware of a Falcon: {}. Copy nvent_firmware.bin of Novint's driver there",
                        file.path.string(), fault);
        file.image.clear();
    }
    return file;
}

} // namespace haptel::device
