#include "tests/device/vm/uinput_wheel.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <fcntl.h>
#include <filesystem>
#include <linux/uinput.h>
#include <poll.h>
#include <stdexcept>
#include <sys/ioctl.h>
#include <system_error>
#include <unistd.h>

namespace haptel::device {

namespace {

void must(int result, const char* what)
{
    if (result < 0) throw std::system_error(errno, std::generic_category(), what);
}

std::string event_file(int uinput)
{
    std::array<char, 64> name{};
    must(ioctl(uinput, UI_GET_SYSNAME(name.size()), name.data()), "UI_GET_SYSNAME");
    const std::filesystem::path in_sysfs = std::string("/sys/devices/virtual/input/") + name.data();
    for (const auto& entry : std::filesystem::directory_iterator(in_sysfs))
        if (entry.path().filename().string().starts_with("event"))
            return "/dev/input/" + entry.path().filename().string();
    throw std::runtime_error("the kernel made no event file in " + in_sysfs.string());
}

} // namespace

UinputWheel::UinputWheel() : file_(open("/dev/uinput", O_RDWR | O_NONBLOCK | O_CLOEXEC))
{
    must(file_, "/dev/uinput");
    for (const int type : {EV_ABS, EV_KEY, EV_FF}) must(ioctl(file_, UI_SET_EVBIT, type), "UI_SET_EVBIT");
    must(ioctl(file_, UI_SET_KEYBIT, BTN_JOYSTICK), "UI_SET_KEYBIT");
    for (const int effect : {FF_CONSTANT, FF_GAIN}) must(ioctl(file_, UI_SET_FFBIT, effect), "UI_SET_FFBIT");
    uinput_abs_setup axis{};
    axis.code = ABS_X;
    axis.absinfo.minimum = minimum;
    axis.absinfo.maximum = maximum;
    must(ioctl(file_, UI_ABS_SETUP, &axis), "UI_ABS_SETUP");
    uinput_setup setup{};
    setup.id = {BUS_USB, 0x1234, 0x5678, 1};
    setup.ff_effects_max = 16;
    std::string("a wheel of uinput").copy(setup.name, sizeof setup.name - 1);
    must(ioctl(file_, UI_DEV_SETUP, &setup), "UI_DEV_SETUP");
    must(ioctl(file_, UI_DEV_CREATE), "UI_DEV_CREATE");
    path_ = event_file(file_);
    thread_ = std::thread([this] { run(); });
}

UinputWheel::~UinputWheel()
{
    ending_ = true;
    thread_.join();
    ioctl(file_, UI_DEV_DESTROY);
    close(file_);
}

void UinputWheel::run()
{
    while (!ending_) {
        pollfd asked{file_, POLLIN, 0};
        poll(&asked, 1, 5);
        for (input_event event{}; read(file_, &event, sizeof event) == static_cast<ssize_t>(sizeof event);) {
            if (event.type == EV_UINPUT && event.code == UI_FF_UPLOAD) take_upload(event.value);
            if (event.type == EV_UINPUT && event.code == UI_FF_ERASE) take_erase(event.value);
            if (event.type != EV_FF) continue;
            const std::lock_guard lock(mutex_);
            if (event.code == FF_GAIN)
                gain_ = event.value;
            else if (event.code < FF_GAIN) // FF_AUTOCENTER comes though this wheel has none
                plays_.push_back({event.code, event.value});
        }
        int place = 0;
        {
            const std::lock_guard lock(mutex_);
            const bool plays = !plays_.empty() && plays_.back().value != 0 && !uploads_.empty();
            if (!plays || uploads_.back().level == 0) continue;
            place = std::clamp(place_ - uploads_.back().level / 500, minimum, maximum);
        }
        turn_to(place);
    }
}

void UinputWheel::take_upload(int request)
{
    uinput_ff_upload upload{};
    upload.request_id = static_cast<uint32_t>(request);
    if (ioctl(file_, UI_BEGIN_FF_UPLOAD, &upload) < 0) return;
    const ff_effect& effect = upload.effect;
    {
        const std::lock_guard lock(mutex_);
        uploads_.push_back({effect.id, effect.type, effect.direction, effect.u.constant.level, effect.replay.length});
    }
    ioctl(file_, UI_END_FF_UPLOAD, &upload);
}

void UinputWheel::take_erase(int request)
{
    uinput_ff_erase erase{};
    erase.request_id = static_cast<uint32_t>(request);
    if (ioctl(file_, UI_BEGIN_FF_ERASE, &erase) < 0) return;
    {
        const std::lock_guard lock(mutex_);
        erased_.push_back(static_cast<int>(erase.effect_id));
    }
    ioctl(file_, UI_END_FF_ERASE, &erase);
}

void UinputWheel::emit(int type, int code, int value)
{
    input_event event{};
    event.type = static_cast<uint16_t>(type);
    event.code = static_cast<uint16_t>(code);
    event.value = value;
    must(static_cast<int>(write(file_, &event, sizeof event)), "an event");
}

void UinputWheel::turn_to(int value)
{
    {
        const std::lock_guard lock(mutex_);
        place_ = value;
    }
    emit(EV_ABS, ABS_X, value);
    emit(EV_SYN, SYN_REPORT, 0);
}

std::vector<UinputWheel::Upload> UinputWheel::uploads() const
{
    const std::lock_guard lock(mutex_);
    return uploads_;
}

std::vector<UinputWheel::Play> UinputWheel::plays() const
{
    const std::lock_guard lock(mutex_);
    return plays_;
}

std::vector<int> UinputWheel::erased() const
{
    const std::lock_guard lock(mutex_);
    return erased_;
}

int UinputWheel::gain() const
{
    const std::lock_guard lock(mutex_);
    return gain_;
}

} // namespace haptel::device
