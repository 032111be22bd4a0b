#include "device/evdev/input_port.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <climits>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <string_view>
#include <system_error>

#include <fcntl.h>
#include <linux/input.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/utsname.h>
#include <unistd.h>

namespace haptel::device {

namespace {

constexpr double level_max = 0x7fff;
// Of an effect: pushes along x, and along y. Which way is found by trying (evdev_driver.h).
constexpr std::array<uint16_t, axes_max> directions = {0x4000, 0x0000};

// 0 means without end, and hid-pidff took it for nothing before Linux 6.15; then the longest time is played again and
// again, which others that time out need as well.
uint16_t endless_ms()
{
    utsname system = {};
    int major = 0, minor = 0;
    const bool known = uname(&system) == 0 && std::sscanf(system.release, "%d.%d", &major, &minor) == 2;
    return known && (major > 6 || (major == 6 && minor >= 15)) ? 0 : 0xffff;
}

template <std::size_t bits>
class Bits { // as EVIOCGBIT fills them
public:
    bool read(int file, unsigned type)
    {
        return ioctl(file, static_cast<int>(EVIOCGBIT(type, sizeof(words_))), words_.data()) >= 0;
    }
    bool has(std::size_t bit) const { return words_[bit / word_bits] >> (bit % word_bits) & 1; }

private:
    static constexpr std::size_t word_bits = sizeof(unsigned long) * CHAR_BIT;
    std::array<unsigned long, bits / word_bits + 1> words_{};
};

class LinuxInput final : public InputPort {
public:
    explicit LinuxInput(int file) : file_(file) { ids_.fill(-1); }
    LinuxInput(const LinuxInput&) = delete;
    LinuxInput& operator=(const LinuxInput&) = delete;
    ~LinuxInput() override { close(file_); }

    bool has_constant_force() const override
    {
        Bits<FF_MAX> effects;
        return effects.read(file_, EV_FF) && effects.has(FF_CONSTANT);
    }

    std::optional<AxisRange> axis(int axis) const override
    {
        Bits<ABS_MAX> axes;
        input_absinfo range = {};
        if (axis >= static_cast<int>(axes_max) || !axes.read(file_, EV_ABS) ||
            !axes.has(static_cast<std::size_t>(ABS_X + axis)) || ioctl(file_, EVIOCGABS(ABS_X + axis), &range) < 0 ||
            range.maximum <= range.minimum)
            return std::nullopt;
        return AxisRange{range.minimum, range.maximum, range.value};
    }

    int set_level(int axis, double level) override
    {
        int16_t& id = ids_[static_cast<std::size_t>(axis)];
        ff_effect effect = {};
        effect.type = FF_CONSTANT;
        effect.id = id;
        effect.direction = directions[static_cast<std::size_t>(axis)];
        effect.replay.length = endless_ms_;
        effect.u.constant.level = static_cast<int16_t>(std::lround(std::clamp(level, -1.0, 1.0) * level_max));
        if (ioctl(file_, EVIOCSFF, &effect) < 0) return errno;
        id = effect.id;
        return 0;
    }

    int play(int axis) override { return write_event(static_cast<uint16_t>(ids_[static_cast<std::size_t>(axis)]), 1); }

    int prepare() override
    {
        const int gain = write_event(FF_GAIN, 0xffff);
        write_event(FF_AUTOCENTER, 0); // not all have a spring
        return gain == EINVAL || gain == ENOSYS ? 0 : gain;
    }

    int read(std::vector<AxisEvent>& events, int timeout_ms) override
    {
        pollfd ready = {file_, POLLIN, 0};
        const int polled = poll(&ready, 1, timeout_ms);
        if (polled < 0) return errno == EINTR ? 0 : errno;
        if (polled == 0) return 0;
        std::array<input_event, 64> heard;
        const ssize_t bytes = ::read(file_, heard.data(), sizeof(heard));
        if (bytes < 0) return errno == EAGAIN || errno == EINTR ? 0 : errno;
        if (bytes == 0) return ENODEV;
        for (std::size_t i = 0; i < static_cast<std::size_t>(bytes) / sizeof(input_event); ++i)
            if (heard[i].type == EV_ABS && heard[i].code < ABS_X + static_cast<int>(axes_max))
                events.push_back({heard[i].code - ABS_X, heard[i].value});
        return 0;
    }

    int file_descriptor() const override { return file_; }
    std::vector<uint8_t> last_word() const override
    {
        std::vector<uint8_t> word;
        for (const int16_t id : ids_) {
            if (id < 0) continue;
            const input_event event = event_of(static_cast<uint16_t>(id), 0);
            const auto* bytes = reinterpret_cast<const uint8_t*>(&event);
            word.insert(word.end(), bytes, bytes + sizeof event);
        }
        return word;
    }

private:
    static input_event event_of(uint16_t code, int value)
    {
        input_event event = {};
        event.type = EV_FF;
        event.code = code;
        event.value = value;
        return event;
    }
    int write_event(uint16_t code, int value)
    {
        const input_event event = event_of(code, value);
        return ::write(file_, &event, sizeof(event)) == static_cast<ssize_t>(sizeof(event)) ? 0 : errno;
    }

    int file_;
    uint16_t endless_ms_ = endless_ms();
    std::array<int16_t, axes_max> ids_;
};

std::string name_of_input(int file)
{
    std::array<char, 256> name{};
    return ioctl(file, static_cast<int>(EVIOCGNAME(name.size() - 1)), name.data()) < 0 ? "" : name.data();
}

Refusal open_failure(const std::string& path, int error)
{
    if (error == EACCES || error == EPERM)
        return {path + " may not be opened for writing",
                "Be in the group `input` (usermod -aG input USER, then log in again), or run as its owner"};
    if (error == ENOENT || error == ENODEV)
        return {path + " is not there", "Plug the device in; `haptel devices` lists what is"};
    return {path + " cannot be opened: " + std::strerror(error), ""};
}

} // namespace

OpenedInput open_input_port(const std::string& path)
{
    const int file = open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
    if (file < 0) return {nullptr, open_failure(path, errno).text(), errno == ENOENT || errno == ENODEV};
    int version = 0;
    if (ioctl(file, EVIOCGVERSION, &version) < 0) {
        close(file);
        return {nullptr, path + " is no input device: expected one of /dev/input/by-id/*-event-joystick", false};
    }
    auto port = std::make_unique<LinuxInput>(file);
    if (!port->has_constant_force())
        return {nullptr,
                path + " has no constant force (FF_CONSTANT): its driver in the kernel cannot push it as a servo needs",
                false};
    if (!port->axis(0)) return {nullptr, path + " has no axis x to feel along", false};
    return {std::move(port), "", false};
}

std::vector<ListedInput> list_input_ports()
{
    namespace fs = std::filesystem;
    std::vector<ListedInput> found;
    std::error_code ignored;
    for (const fs::directory_entry& entry : fs::directory_iterator("/dev/input", ignored)) {
        const std::string path = entry.path().string();
        if (!std::string_view(entry.path().filename().c_str()).starts_with("event")) continue;
        const int file = open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
        if (file < 0) continue;
        const std::string name = name_of_input(file);
        close(file);
        const OpenedInput opened = open_input_port(path); // what has no force feedback is no haptic device
        if (opened.port) found.push_back({path, name, opened.port->axis(1) ? 2 : 1, {}});
    }
    // What may not even be read is known by its link.
    for (const fs::directory_entry& entry : fs::directory_iterator("/dev/input/by-id", ignored)) {
        const std::string path = entry.path().string();
        if (!path.ends_with("-event-joystick") || access(path.c_str(), R_OK | W_OK) == 0) continue;
        found.push_back({path, entry.path().filename().string(), 0, open_failure(path, errno)});
    }
    std::ranges::sort(found, {}, &ListedInput::path);
    return found;
}

} // namespace haptel::device
