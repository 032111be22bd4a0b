// An OpenFFBoard made of bytes, with motors that push masses with friction, either way round. It shares no code with
// the driver. Any thread.
#pragma once

#include "tests/device/usb/fake_usb_device.h"

#include <array>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <random>
#include <string>
#include <vector>

namespace haptel::device {

enum class BoardFault { none, stall, garbage, short_reports, silence, full, wrong_block, slow_block, bad_descriptor };

class FakeBoard final : public FakeUsbDevice {
public:
    static constexpr int block_count = 40;

    FakeBoard();

    // What the host does.
    Answer control(const UsbSetup& setup, std::span<uint8_t> data, std::size_t& size) override;
    Answer out(std::span<const uint8_t> bytes) override;
    Answer in(std::span<uint8_t> bytes, std::size_t& size) override;
    std::vector<uint8_t> descriptors() const override;

    // What the world does.
    void wire(int axis, double sign); // which way its motor is wired: 1 or -1
    void hold(int axis, bool held);
    void turn_to(int axis, double place); // -0.5 .. 0.5
    void plug(bool plugged);              // without power it forgets its effects
    void inject(BoardFault fault, uint64_t after, uint64_t for_operations);

    // What it saw.
    double place(int axis) const;
    double force(int axis) const;  // of its motors, -1 .. 1, before the wiring
    int magnitude(int axis) const; // of the effect along it
    double strongest() const;      // so far
    bool active() const;
    uint64_t operations() const;
    uint64_t forces() const;                   // Set Constant Force reports
    std::vector<std::string> mistakes() const; // of the host
    std::vector<int> heard(int axis) const;    // magnitudes of its effect, in order

private:
    struct Effect {
        bool made = false, set = false, runs = false;
        int magnitude = 0, gain = 0, axes = 0, direction = 0, duration = 0;
    };
    struct Axis {
        double sign = 1, place = 0, speed = 0;
        bool held = false;
    };

    Answer begin_operation();
    bool faulty(BoardFault fault) const;
    void mistake(const std::string& what);
    void obey(std::span<const uint8_t> report);
    double share(const Effect& effect, int axis) const;
    double force_now(int axis) const;
    void live();

    mutable std::mutex mutex_;
    std::vector<uint8_t> report_descriptor_;
    std::array<Effect, block_count> effects_;
    std::array<Axis, 2> axes_;
    std::array<std::vector<int>, 2> heard_;
    int loaded_ = 0, load_status_ = 0, gain_ = 255, polls_left_ = 0;
    bool active_ = false, plugged_ = true;
    double strongest_ = 0;
    uint64_t operations_ = 0, forces_ = 0, fault_from_ = 0, fault_until_ = 0;
    BoardFault fault_ = BoardFault::none;
    std::vector<std::string> mistakes_;
    std::mt19937 random_{1};
    std::chrono::steady_clock::time_point lived_until_ = std::chrono::steady_clock::now();
};

} // namespace haptel::device
