// A Falcon made of bytes: the serial converter, the boot loader and the program behind it, as their protocol is known,
// with faults to order. It shares no code with the driver. Any thread.
#pragma once

#include "tests/device/usb/fake_usb_device.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <random>
#include <span>
#include <string>
#include <vector>

namespace haptel::device {

enum class FakeFault {
    none,
    silence,       // nothing is answered
    wrong_bytes,   // one bit of each answered byte is wrong
    garbage,       // something else is answered
    split,         // three bytes come at a time: not wrong, only inconvenient
    short_packets, // two bytes of each answer are lost
    late,          // answers come twenty transfers later
    stall,         // every request is refused
    unplug,        // gone until plugged in again
    lost_homing,   // the program forgets where its arms are
};
inline constexpr std::array<FakeFault, 9> all_fake_faults = {
    FakeFault::silence, FakeFault::wrong_bytes, FakeFault::garbage, FakeFault::split,      FakeFault::short_packets,
    FakeFault::late,    FakeFault::stall,       FakeFault::unplug,  FakeFault::lost_homing};
const char* name_of(FakeFault fault);

class FakeFalcon final : public FakeUsbDevice {
public:
    using Motors = std::array<int, 3>;

    explicit FakeFalcon(bool runs_program, int packets_to_home = 5);

    // What the host does. `in` gives at most 64 bytes, the first two about the converter.
    Answer control(const UsbSetup& setup, std::span<uint8_t> data, std::size_t& size) override;
    Answer out(std::span<const uint8_t> bytes) override;
    Answer in(std::span<uint8_t> bytes, std::size_t& size) override;
    std::vector<uint8_t> descriptors() const override;

    // What the world does. A fault begins after so many operations of the host and lasts for so many.
    void inject(FakeFault fault, uint64_t after, uint64_t for_operations);
    void plug_in(); // with the power off in between: the program is lost
    void set_encoders(const std::array<int, 3>& encoders);
    void set_buttons(int buttons);

    // What it saw.
    uint64_t operations() const;
    bool runs_program() const;
    std::vector<uint8_t> image() const;        // of the last loading
    std::vector<std::string> requests() const; // control requests and writes, "1 0101" or "write 3"
    Motors motors() const;                     // that it holds now
    int flags() const;                         // of the last packet
    uint64_t packets() const;                  // that it answered
    uint64_t packets_with_force() const;
    uint64_t violations() const; // forces on arms that are not homed, motors out of range, packets broken by the host
    std::vector<Motors> commands() const; // all since the start

private:
    bool faulty(FakeFault fault) const;
    Answer begin_operation();
    void hear(uint8_t byte);
    void hear_loader(uint8_t byte);
    void hear_packet(uint8_t byte);
    void obey(const std::string& packet);
    void answer(std::string bytes);

    mutable std::mutex mutex_;
    enum class State { waiting, called, bit_rate, loading, running } state_;
    int packets_to_home_, homing_packets_ = 0, packets_since_it_knows_ = 0;
    bool told_homed_ = false;                               // by the last reply
    bool homed_ = false, gone_ = false, host_knows_ = true; // that the arms are not homed
    uint16_t divisor_ = 0;
    int modem_ = 0;
    std::string heard_;
    std::vector<uint8_t> image_;
    std::deque<std::pair<uint8_t, uint64_t>> to_host_; // byte, and the operation from which on it may be read
    std::array<int, 3> encoders_{};
    int buttons_ = 0, flags_ = 0;
    Motors motors_{};
    std::vector<Motors> commands_;
    std::vector<std::string> requests_;
    uint64_t operations_ = 0, packets_ = 0, packets_with_force_ = 0, violations_ = 0;
    FakeFault fault_ = FakeFault::none;
    uint64_t fault_from_ = 0, fault_until_ = 0;
    std::mt19937 random_{1};
};

} // namespace haptel::device
