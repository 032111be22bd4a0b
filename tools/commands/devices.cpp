// haptel devices: what is connected, what is supported, and whether a device senses the hand.
#include "device/device_factory.h"
#include "lang/text/diagnostic.h"
#include "runtime/geometry/finite.h"
#include "runtime/servo/real_time.h"
#include "tools/commands/command.h"
#include "tools/explore/axes_json.h"
#include "tools/output/interrupt.h"
#include "tools/output/json.h"
#include "tools/output/terminal.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <memory>

namespace haptel::tools {

namespace {

using device::DeviceState;
using device::ListedDevice;

struct DevicesOptions {
    std::string open;
    double seconds = 10;
    bool json = false;
};

// What a device said while no force was sent to it.
struct Readings {
    uint64_t reads = 0, poses = 0, changes = 0; // the latter: poses that differ from the one before
    glm::dvec3 least_m{0}, most_m{0};
    runtime::DeviceStatus status = runtime::DeviceStatus::not_ready;

    bool moved() const { return changes > 0; }
};

constexpr double look_rate_hz = 1000;

Readings look_at(runtime::HapticDevice& device, double seconds)
{
    Readings seen;
    glm::dvec3 before(0);
    const auto periods = static_cast<uint64_t>(std::lround(seconds * look_rate_hz));
    int64_t deadline_ns = runtime::monotonic_ns();
    for (uint64_t period = 0; period < periods && !interrupted(); ++period) {
        runtime::DevicePose pose;
        seen.status = device.read(pose);
        ++seen.reads;
        const bool has_pose = seen.status == runtime::DeviceStatus::ok && runtime::finite(pose.tip_m);
        if (has_pose) {
            seen.least_m = seen.poses == 0 ? pose.tip_m : glm::min(seen.least_m, pose.tip_m);
            seen.most_m = seen.poses == 0 ? pose.tip_m : glm::max(seen.most_m, pose.tip_m);
            seen.changes += seen.poses > 0 && pose.tip_m != before;
            before = pose.tip_m;
            ++seen.poses;
        } else if (seen.status != runtime::DeviceStatus::not_ready) {
            break;
        }
        device.write(glm::dvec3(0), glm::dvec3(0));
        deadline_ns += static_cast<int64_t>(1e9 / look_rate_hz);
        runtime::wait_until(deadline_ns, 0);
    }
    device.stop();
    return seen;
}

std::string axes_of(const glm::bvec3& axes)
{
    std::string names;
    for (int i = 0; i < 3; ++i)
        if (axes[i]) names += "xyz"[i];
    return names.empty() ? "none" : names;
}

// A flat table of 0.2 m for simulated hands: what is looked at is the device.
runtime::DeviceRequest request_for(const std::string& name)
{
    runtime::DeviceRequest request;
    request.name = name;
    request.stroke = "circles";
    request.rate_hz = look_rate_hz;
    request.box_minimum_m = {-0.1, -0.1, 0};
    request.box_maximum_m = {0.1, 0.1, 0};
    request.surface_below = [](double x, double y) { return runtime::SurfaceHit{{x, y, 0}, {0, 0, 1}}; };
    return request;
}

ExitCode open_and_look(const DevicesOptions& options)
{
    listen_for_interrupts(); // a device that is nudged keeps the force if nobody takes it away
    const runtime::DeviceResult opened = device::open_device(request_for(options.open));
    if (!opened.device) {
        say_error(fmt::format("device '{}': {}", lang::printable(options.open), lang::printable(opened.error)));
        return ExitCode::findings;
    }
    if (!opened.warning.empty()) say_warning(lang::printable(opened.warning));
    const runtime::DeviceInfo& info = opened.device->info();
    const Readings seen = look_at(*opened.device, options.seconds);
    const double share = seen.reads == 0 ? 0 : static_cast<double>(seen.poses) / static_cast<double>(seen.reads);
    const glm::dvec3 range_m = seen.most_m - seen.least_m;
    if (options.json) {
        print_json({{"device", info.name},
                    {"axes", axes_json(info.axes)},
                    {"force_max_n", info.force_max_n},
                    {"reads", seen.reads},
                    {"poses", seen.poses},
                    {"changes", seen.changes},
                    {"range_m", {range_m.x, range_m.y, range_m.z}},
                    {"opened", seen.moved()}});
    } else {
        fmt::print("{}: senses {}, pushes {}", info.name, axes_of(info.axes.senses), axes_of(info.axes.pushes));
        if (info.force_max_n > 0) fmt::print(", at most {:g} N", info.force_max_n);
        fmt::print("\n  readings  {} of {} had a pose ({:.1f} %), {} of them another one than before\n", seen.poses,
                   seen.reads, 100 * share, seen.changes);
        if (seen.poses > 0)
            fmt::print("  range     {:.2f}, {:.2f}, {:.2f} mm along x, y, z\n", 1e3 * range_m.x, 1e3 * range_m.y,
                       1e3 * range_m.z);
    }
    if (seen.moved()) return ExitCode::fine;
    const std::string state = opened.device->state();
    say_error(seen.poses == 0
                  ? fmt::format("'{}' gave no pose within {:g} s: {}", info.name,
                                static_cast<double>(seen.reads) / look_rate_hz,
                                state.empty() ? "is it homed, and switched on?" : lang::printable(state))
                  : fmt::format("'{}' never said another place than its first: move it while this looks. If it was "
                                "moved, it speaks another protocol, or another program drives it",
                                info.name));
    return ExitCode::findings;
}

std::string_view name_of(DeviceState state)
{
    constexpr std::array<std::string_view, 4> names = {"ready", "absent", "refused", "faulty"};
    return names[static_cast<size_t>(state)];
}

Json json_of(const ListedDevice& one)
{
    const auto known = [](double value) { return value > 0 ? Json(value) : Json(nullptr); };
    const auto said = [](const std::string& text) { return text.empty() ? Json(nullptr) : Json(text); };
    return {{"name", one.name},
            {"kind", one.kind},
            {"transport", one.transport},
            {"what", one.what},
            {"at", said(one.at)},
            {"state", name_of(one.state)},
            {"reason", said(one.refused.reason)},
            {"cure", said(one.refused.cure)},
            {"axes", one.axes ? axes_json(*one.axes) : Json(nullptr)},
            {"rate_hz", known(one.rate_hz)},
            {"force_max_n", known(one.force_max_n)}};
}

ExitCode run(const DevicesOptions& options)
{
    if (!options.open.empty()) return open_and_look(options);
    std::vector<ListedDevice> listed = device::listed_devices();
    const auto supported = device::supported_devices();
    if (options.json) {
        Json list = Json::array(), kinds = Json::array();
        for (const ListedDevice& one : listed) list.push_back(json_of(one));
        for (const device::SupportedDevice& one : supported) kinds.push_back({{"name", one.name}, {"what", one.what}});
        print_json({{"devices", list}, {"supported", kinds}});
        return ExitCode::fine;
    }
    std::erase_if(listed,
                  [](const ListedDevice& one) { return one.transport == "none" || one.state == DeviceState::absent; });
    fmt::print("connected\n");
    if (std::ranges::all_of(listed, [](const ListedDevice& one) { return one.state == DeviceState::faulty; }))
        fmt::print("  nothing that haptel knows\n");
    for (const ListedDevice& one : listed) {
        if (one.state == DeviceState::faulty)
            fmt::print("  not looked for: {}: {}\n", lang::printable(one.what), lang::printable(one.refused.text()));
        else
            fmt::print("  {:<26} {}, {}{}\n", lang::printable(one.name), lang::printable(one.what),
                       lang::printable(one.at),
                       one.refused.empty() ? "" : "\n" + std::string(29, ' ') + lang::printable(one.refused.text()));
    }
    fmt::print("supported, by the name for --device and [device]\n");
    for (const device::SupportedDevice& one : supported) fmt::print("  {:<26} {}\n", one.name, one.what);
    return ExitCode::fine;
}

} // namespace

Command devices_command(CLI::App& app)
{
    const auto options = std::make_shared<DevicesOptions>();
    CLI::App* command = app.add_subcommand("devices", "List haptic devices: what is connected, what is supported");
    command
        ->add_option("--open", options->open,
                     "Open this one, send no force, and say whether it senses the hand that moves it")
        ->type_name("NAME");
    command->add_option("--seconds", options->seconds, "How long --open looks")
        ->check(CLI::Range(0.01, 3600.0))
        ->type_name("N")
        ->capture_default_str();
    command->add_flag("--json", options->json, "JSON on standard output");
    set_examples(*command, "  haptel devices\n"
                           "  haptel devices --open falcon\n"
                           "  haptel devices --open simulated:wheel --seconds 1 --json");
    return {command, [options] { return run(*options); }};
}

} // namespace haptel::tools
