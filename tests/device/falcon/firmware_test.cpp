#include "device/falcon/falcon_firmware.h"
#include "tests/device/falcon/firmware_image.h"
#include "tests/support/catch.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>

using namespace haptel::device;

namespace {

void write_image(const std::filesystem::path& path, const std::vector<uint8_t>& image)
{
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(image.data()), static_cast<std::streamsize>(image.size()));
}

} // namespace

TEST_CASE("an image of blocks is in order, and nothing that was cut off from it is")
{
    const auto image = synthetic_firmware(20);
    CHECK(firmware_fault(image) == "");
    for (std::size_t size = 0; size < image.size(); ++size) {
        INFO("cut at byte " << size);
        REQUIRE(firmware_fault(std::span(image).first(size)) != "");
    }
}

TEST_CASE("what is wrong with an image is said")
{
    const auto fault_with = [](std::size_t byte, uint8_t value) {
        auto image = synthetic_firmware(20);
        image[byte] = value;
        return firmware_fault(image);
    };
    CHECK(fault_with(1, 0x09) == "it begins with 0x09aa, not with the boot loader's key 0x08aa");
    CHECK(fault_with(4, 1) == "reserved word 2 is 0x0001, not 0");
    CHECK(fault_with(18, 0xff) == "it starts at 0xff8002, which no memory has");
    CHECK(fault_with(24, 0xff) == "block 1 goes to 0xff8000, which no memory has");
    CHECK(fault_with(22, 21) != ""); // a block that is a word longer
    auto longer = synthetic_firmware(20);
    longer.push_back(0);
    CHECK(firmware_fault(longer) == "1 bytes follow its end");
    CHECK(firmware_fault(std::vector<uint8_t>{0xaa, 0x08, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0,
                                              0,    0,    0, 0, 0, 0, 0, 0, 0, 0, 0, 0}) == "it holds no program");
}

TEST_CASE("the firmware's file is the chosen one, else the environment's, else that of the user's folder, else none")
{
    const auto folder = std::filesystem::temp_directory_path() / "haptel_firmware_test";
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder / "haptel");
    setenv("XDG_CONFIG_HOME", folder.c_str(), 1);
    unsetenv("HAPTEL_FALCON_FIRMWARE");
    CHECK(read_falcon_firmware({}).error == "");
    CHECK(read_falcon_firmware({}).image.empty());

    write_image(folder / "haptel" / "falcon_firmware.bin", synthetic_firmware(1));
    write_image(folder / "environment.bin", synthetic_firmware(2));
    write_image(folder / "chosen.bin", synthetic_firmware(3));
    write_image(folder / "wrong.bin", {1, 2, 3, 4});
    CHECK(read_falcon_firmware({}).image == synthetic_firmware(1));
    setenv("HAPTEL_FALCON_FIRMWARE", (folder / "environment.bin").c_str(), 1);
    CHECK(read_falcon_firmware({}).image == synthetic_firmware(2));
    CHECK(read_falcon_firmware(folder / "chosen.bin").image == synthetic_firmware(3));
    CHECK(read_falcon_firmware(folder / "absent.bin").error ==
          "the Falcon's firmware cannot be read from '" + (folder / "absent.bin").string() +
              "' (No such file or directory): expected a file that you may read; HAPTEL_FALCON_FIRMWARE names another");
    CHECK(read_falcon_firmware(folder).error.find("(Is a directory)") != std::string::npos);
    const FirmwareFile wrong = read_falcon_firmware(folder / "wrong.bin");
    CHECK(wrong.image.empty());
    CHECK(wrong.error.find("is no firmware of a Falcon: it begins with 0x0201") != std::string::npos);
    CHECK(wrong.error.find("Copy nvent_firmware.bin of Novint's driver there") != std::string::npos);
    write_image(folder / "long.bin", std::vector<uint8_t>((1u << 18) + 1));
    CHECK(read_falcon_firmware(folder / "long.bin").error.find("it has 262145 bytes") != std::string::npos);
    unsetenv("HAPTEL_FALCON_FIRMWARE");
    unsetenv("XDG_CONFIG_HOME");
    std::filesystem::remove_all(folder);
}
