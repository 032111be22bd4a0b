#include "tests/device/hid/fake_board.h"

#include "tests/device/hid/hid_items.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace haptel::device {

namespace {

constexpr double acceleration_per_s2 = 200; // at full force, of ways from end to end
constexpr double damping_per_s = 20;
constexpr double step_s = 1e-4;

int word(std::span<const uint8_t> bytes, std::size_t at)
{
    return bytes[at] | bytes[at + 1] << 8;
}

} // namespace

FakeBoard::FakeBoard() : report_descriptor_(openffboard_descriptor()) {}

// Two interfaces of a serial port, without endpoints here, and HID with interrupt IN 0x83 and OUT 0x02 each
// millisecond.
std::vector<uint8_t> FakeBoard::descriptors() const
{
    const std::size_t size = report_descriptor_.size();
    return {18,
            1,
            0x00,
            0x02,
            0,
            0,
            0,
            64,
            0x09,
            0x12,
            0xb0,
            0xff,
            0x00,
            0x01,
            0,
            0,
            0,
            1, //
            9,
            2,
            59,
            0,
            3,
            1,
            0,
            0x80,
            50, //
            9,
            4,
            0,
            0,
            0,
            2,
            2,
            1,
            0, //
            9,
            4,
            1,
            0,
            0,
            10,
            0,
            0,
            0, //
            9,
            4,
            2,
            0,
            2,
            3,
            0,
            0,
            0, //
            9,
            0x21,
            0x11,
            0x01,
            0,
            1,
            0x22,
            static_cast<uint8_t>(size),
            static_cast<uint8_t>(size >> 8),
            7,
            5,
            0x83,
            3,
            64,
            0,
            1, //
            7,
            5,
            0x02,
            3,
            64,
            0,
            1};
}

bool FakeBoard::faulty(BoardFault fault) const
{
    return fault_ == fault && operations_ > fault_from_ && operations_ <= fault_until_;
}

FakeBoard::Answer FakeBoard::begin_operation()
{
    ++operations_;
    if (!plugged_) return Answer::gone;
    live();
    return faulty(BoardFault::stall) ? Answer::stall : Answer::fine;
}

void FakeBoard::mistake(const std::string& what)
{
    if (mistakes_.size() < 20) mistakes_.push_back(what);
}

FakeBoard::Answer FakeBoard::control(const UsbSetup& setup, std::span<uint8_t> data, std::size_t& size)
{
    const std::lock_guard lock(mutex_);
    size = 0;
    if (const Answer answer = begin_operation(); answer != Answer::fine) return answer;
    const auto give = [&](std::span<const uint8_t> bytes) {
        size = std::min(bytes.size(), data.size());
        if (faulty(BoardFault::short_reports)) size /= 2;
        std::copy_n(bytes.begin(), size, data.begin());
        if (faulty(BoardFault::garbage))
            for (std::size_t i = 0; i < size; ++i) data[i] = static_cast<uint8_t>(random_());
        return Answer::fine;
    };
    const std::vector<uint8_t> all = descriptors();
    if (setup.type == 0x80 && setup.request == 6 && setup.value == 0x0200) return give(std::span(all).subspan(18));
    if (setup.type == 0x81 && setup.request == 6 && setup.value == 0x2200 && setup.index == 2) {
        if (!faulty(BoardFault::bad_descriptor)) return give(report_descriptor_);
        return give(std::span(report_descriptor_).first(100));
    }
    if (setup.type == 0x21 && setup.request == 9 && setup.value == 0x0311 && setup.index == 2) {
        if (data.size() != 4 || data[0] != 0x11 || data[1] != 1) mistake("Create New Effect");
        const auto unused = std::ranges::find(effects_, false, &Effect::made);
        load_status_ = unused == effects_.end() || faulty(BoardFault::full) ? 2 : 1;
        polls_left_ = faulty(BoardFault::slow_block) ? 3 : 0;
        if (load_status_ == 1) {
            *unused = {};
            unused->made = true;
            loaded_ = static_cast<int>(unused - effects_.begin()) + 1;
        }
        size = data.size();
        return Answer::fine;
    }
    if (setup.type == 0xa1 && setup.request == 1 && setup.value == 0x0312 && setup.index == 2) {
        const int status = polls_left_ > 0 ? 0 : load_status_;
        polls_left_ -= polls_left_ > 0;
        const int block = faulty(BoardFault::wrong_block) ? 0 : loaded_;
        const std::array<uint8_t, 5> answer = {0x12, static_cast<uint8_t>(block), static_cast<uint8_t>(status), 9, 0};
        return give(answer);
    }
    if (setup.type == 0xa1 && setup.request == 1 && setup.value == 0x0313 && setup.index == 2)
        return give(std::array<uint8_t, 5>{0x13, block_count, 0, block_count, 3});
    mistake("an unknown request");
    return Answer::stall;
}

FakeBoard::Answer FakeBoard::out(std::span<const uint8_t> bytes)
{
    const std::lock_guard lock(mutex_);
    if (const Answer answer = begin_operation(); answer != Answer::fine) return answer;
    obey(bytes);
    for (int axis = 0; axis < 2; ++axis) strongest_ = std::max(strongest_, std::fabs(force_now(axis)));
    return Answer::fine;
}

void FakeBoard::obey(std::span<const uint8_t> report)
{
    constexpr std::array<std::size_t, 14> sizes = {0, 22, 14, 0, 0, 4, 0, 0, 0, 0, 4, 2, 2, 2};
    if (report.empty() || report[0] >= sizes.size() || sizes[report[0]] != report.size())
        return mistake("a report of another length");
    if (report[0] == 12) {
        if (report[1] & 1) active_ = true;
        if (report[1] & (2 | 4 | 8)) active_ = false;
        if (report[1] & 8) effects_ = {}, heard_ = {};
        return;
    }
    if (report[0] == 13) {
        gain_ = report[1];
        return;
    }
    if (report[1] == 0 || report[1] > block_count || !effects_[report[1] - 1U].made)
        return mistake("a block that was not made");
    Effect& effect = effects_[report[1] - 1U];
    if (report[0] == 1) {
        if (report[2] != 1) mistake("an effect of another type");
        effect.set = true;
        effect.duration = word(report, 3);
        effect.gain = report[11];
        effect.axes = report[13];
        effect.direction = word(report, 14);
        if (effect.duration != 0xffff) mistake("an effect that ends");
    } else if (report[0] == 5) {
        effect.magnitude = static_cast<int16_t>(word(report, 2));
        ++forces_;
        if (effect.magnitude == -32768) mistake("a magnitude out of range");
        for (std::size_t axis = 0; axis < 2; ++axis)
            if (std::fabs(share(effect, static_cast<int>(axis))) > 0.5) heard_[axis].push_back(effect.magnitude);
    } else if (report[0] == 10) {
        if (!effect.set && report[2] == 1) mistake("an effect is started that was not set");
        effect.runs = report[2] == 1;
    } else if (report[0] == 11) {
        effect = {};
    }
}

// With Direction Enable (bit 2) an effect points along its direction, in hundredths of a degree.
double FakeBoard::share(const Effect& effect, int axis) const
{
    const double angle = 2 * std::numbers::pi * effect.direction / 36000;
    if (!(effect.axes & 4)) return 0;
    return axis == 0 ? std::sin(angle) : -std::cos(angle);
}

double FakeBoard::force_now(int axis) const
{
    double force = 0;
    for (const Effect& effect : effects_)
        if (active_ && effect.runs)
            force += share(effect, axis) * effect.magnitude / 32767 * (effect.gain + 1) / 256 * (gain_ + 1) / 256;
    return force;
}

void FakeBoard::live()
{
    const auto now = std::chrono::steady_clock::now();
    double left_s = std::min(std::chrono::duration<double>(now - lived_until_).count(), 0.05);
    lived_until_ = now;
    for (; left_s > 0; left_s -= step_s)
        for (int i = 0; i < 2; ++i) {
            Axis& axis = axes_[static_cast<std::size_t>(i)];
            axis.speed += step_s * (axis.sign * force_now(i) * acceleration_per_s2 - damping_per_s * axis.speed);
            if (axis.held) axis.speed = 0;
            axis.place = std::clamp(axis.place + step_s * axis.speed, -0.5, 0.5);
        }
}

FakeBoard::Answer FakeBoard::in(std::span<uint8_t> bytes, std::size_t& size)
{
    const std::lock_guard lock(mutex_);
    size = 0;
    if (const Answer answer = begin_operation(); answer != Answer::fine) return answer;
    if (faulty(BoardFault::silence)) return Answer::nothing;
    std::array<uint8_t, 25> report{1};
    for (std::size_t axis = 0; axis < 2; ++axis) {
        const auto value = static_cast<int>(std::lround(axes_[axis].place * 2 * 32767));
        report[9 + 2 * axis] = static_cast<uint8_t>(value);
        report[10 + 2 * axis] = static_cast<uint8_t>(value >> 8);
    }
    if (faulty(BoardFault::garbage))
        for (std::size_t i = 0; i < report.size(); ++i)
            report[i] = static_cast<uint8_t>(random_() | (i == 0 ? 2U : 0U));
    size = std::min(bytes.size(), faulty(BoardFault::short_reports) ? std::size_t{10} : report.size());
    std::copy_n(report.begin(), size, bytes.begin());
    return Answer::fine;
}

void FakeBoard::wire(int axis, double sign)
{
    const std::lock_guard lock(mutex_);
    axes_[static_cast<std::size_t>(axis)].sign = sign;
}

void FakeBoard::hold(int axis, bool held)
{
    const std::lock_guard lock(mutex_);
    axes_[static_cast<std::size_t>(axis)].held = held;
}

void FakeBoard::turn_to(int axis, double place)
{
    const std::lock_guard lock(mutex_);
    axes_[static_cast<std::size_t>(axis)].place = place;
}

void FakeBoard::plug(bool plugged)
{
    const std::lock_guard lock(mutex_);
    plugged_ = plugged;
    if (!plugged) effects_ = {}, active_ = false;
}

void FakeBoard::inject(BoardFault fault, uint64_t after, uint64_t for_operations)
{
    const std::lock_guard lock(mutex_);
    fault_ = fault;
    fault_from_ = operations_ + after;
    fault_until_ = fault_from_ + for_operations;
}

double FakeBoard::place(int axis) const
{
    const std::lock_guard lock(mutex_);
    return axes_[static_cast<std::size_t>(axis)].place;
}

double FakeBoard::force(int axis) const
{
    const std::lock_guard lock(mutex_);
    return force_now(axis);
}

int FakeBoard::magnitude(int axis) const
{
    const std::lock_guard lock(mutex_);
    const auto& heard = heard_[static_cast<std::size_t>(axis)];
    return heard.empty() ? 0 : heard.back();
}

double FakeBoard::strongest() const
{
    const std::lock_guard lock(mutex_);
    return strongest_;
}

bool FakeBoard::active() const
{
    const std::lock_guard lock(mutex_);
    return active_;
}

uint64_t FakeBoard::operations() const
{
    const std::lock_guard lock(mutex_);
    return operations_;
}

uint64_t FakeBoard::forces() const
{
    const std::lock_guard lock(mutex_);
    return forces_;
}

std::vector<std::string> FakeBoard::mistakes() const
{
    const std::lock_guard lock(mutex_);
    return mistakes_;
}

std::vector<int> FakeBoard::heard(int axis) const
{
    const std::lock_guard lock(mutex_);
    return heard_[static_cast<std::size_t>(axis)];
}

} // namespace haptel::device
