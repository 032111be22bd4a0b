#include "device/device_factory.h"

#include "device/evdev/input_port.h"
#include "device/evdev/open_evdev.h"
#include "device/falcon/open_falcon.h"
#include "device/hid/open_hid.h"
#include "device/inverse3/open_inverse3.h"
#include "device/replay_device.h"
#include "device/simulated_device.h"
#include "lang/text/near_name.h"
#include "runtime/process/fork_server.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <memory>
#include <string_view>
#include <utility>

namespace haptel::device {

namespace {

using runtime::DeviceRequest;
using runtime::DeviceResult;

using runtime::DeviceKey;

DeviceResult refused(std::string why, DeviceKey about = DeviceKey::name)
{
    return {nullptr, std::move(why), {}, about};
}

std::string unknown(std::string_view what, std::string_view name, const std::vector<std::string_view>& known)
{
    std::string message = fmt::format("unknown {} '{}'", what, name.substr(0, 64));
    const std::string_view nearest = near_name(name, known).name;
    if (!nearest.empty()) return message + fmt::format(": did you mean '{}'?", nearest);
    return message + fmt::format(": there are {}", fmt::join(known, ", "));
}

template <typename Named>
std::vector<std::string_view> names_of(const Named& entries)
{
    std::vector<std::string_view> names;
    for (const auto& entry : entries) names.push_back(entry.name);
    return names;
}

// The preset of that name, the first if no name is given, null if there is none.
template <typename Presets>
auto find_preset(const Presets& presets, std::string_view name)
{
    if (name.empty()) return &presets.front();
    const auto preset = std::find_if(presets.begin(), presets.end(), [&](auto& p) { return p.name == name; });
    return preset == presets.end() ? nullptr : &*preset;
}

// What stands before and after the first colon.
std::pair<std::string_view, std::string_view> split(std::string_view text)
{
    const auto colon = text.find(':');
    return {text.substr(0, colon), colon == text.npos ? std::string_view() : text.substr(colon + 1)};
}

bool within(double value, double low, double high)
{
    return value >= low && value <= high;
}

DeviceResult open_simulated(std::string_view variant, const DeviceRequest& request)
{
    const auto [preset_name, hand_name] = split(variant);
    const DevicePreset* preset = find_preset(device_presets(), preset_name);
    if (!preset) return refused(unknown("simulated device", preset_name, names_of(device_presets())));
    const HandPreset* holding = find_preset(hand_presets(), hand_name);
    if (!holding) return refused(unknown("simulated hand", hand_name, names_of(hand_presets())));

    if (!within(request.rate_hz, 1, 1e6)) return refused("a simulated device runs at 1 Hz to 1 MHz");
    if (!within(request.speed_m_per_s, 0, 10)) return refused("the speed of a stroke is 0 to 10 m/s", DeviceKey::speed);
    if (!within(request.press_n, 0, 100)) return refused("a simulated hand presses with 0 to 100 N", DeviceKey::press);
    if (!within(request.stylus_length_m, 0, 10))
        return refused(fmt::format("a stylus is 0 to 10 m long in the hand's space, found {:g} m: its length over the "
                                   "scale of the workspace",
                                   request.stylus_length_m),
                       DeviceKey::stylus_length);
    if (!request.surface_below) return refused("a simulated hand needs a surface to explore", DeviceKey::device);

    const glm::dvec2 low(request.box_minimum_m), high(request.box_maximum_m);
    const auto start = nearest_hit(request.surface_below, low, high);
    if (!start)
        return refused("the simulated hand finds no surface when it looks down on the object from +z",
                       DeviceKey::device);
    Curve curve =
        make_curve(request.stroke, {low, high, glm::dvec2(start->point_m), request.speed_m_per_s, request.seed});
    if (!curve)
        return refused(unknown("stroke", request.stroke, {stroke_names().begin(), stroke_names().end()}),
                       DeviceKey::stroke);

    std::string warning;
    const double around_m = start->point_m.z + approach_m - request.box_minimum_m.z;
    if (request.gripper && request.stylus_length_m <= around_m)
        warning = fmt::format("its fingers, {:g} m apart, do not reach round the object, which takes more than {:g} m: "
                              "`length_m` over the scale of the workspace",
                              request.stylus_length_m, around_m);

    Hand hand(holding->impedance, Stroke(std::move(curve), request.surface_below, *start), request.press_n,
              1 / request.rate_hz);
    DeviceModel model = preset->model;
    if (request.exact_positions) model.encoder_m = 0;
    runtime::DeviceInfo info{.name = request.name,
                             .force_max_n = model.force_max_n,
                             .stiffness_max_n_per_m = model.stiffness_max_n_per_m,
                             .press_n = request.press_n,
                             .position_resolution_m = model.encoder_m,
                             .axes = model.axes};
    SimulatedDevice::Options options{
        .rate_hz = request.rate_hz, .stylus_length_m = request.stylus_length_m, .gripper = request.gripper};
    options.delay_periods = std::max(1, static_cast<int>(std::lround(model.delay_s * request.rate_hz)));
    if (model.update_hz > 0)
        options.hold_periods = std::max(1, static_cast<int>(std::lround(request.rate_hz / model.update_hz)));
    return {std::make_unique<SimulatedDevice>(std::move(info), model, std::move(hand), options),
            {},
            std::move(warning),
            DeviceKey::stylus_length};
}

DeviceResult open_recording(std::string_view file, const DeviceRequest& request)
{
    if (file.empty()) return refused("replay needs a file: replay:run.haptrace or replay:trace.csv");
    return open_replay(request.name, file, request.rate_hz);
}

DeviceResult open_connected_falcon(std::string_view serial, const DeviceRequest& request)
{
    return open_falcon(request, serial);
}

using Listed = std::vector<ListedDevice>;

// What is wrong with the search for a kind of device, not with one of them.
ListedDevice not_looked_for(std::string what, const std::string& why)
{
    ListedDevice one;
    one.what = std::move(what);
    one.state = DeviceState::faulty;
    one.refused.reason = why;
    return one;
}

ListedDevice listed(std::string name, std::string what, std::string at, Refusal refused)
{
    ListedDevice one;
    one.name = std::move(name);
    one.what = std::move(what);
    one.at = std::move(at);
    one.state = refused.empty() ? DeviceState::ready : DeviceState::refused;
    one.refused = std::move(refused);
    return one;
}

Listed list_usb(const UsbList& list, std::string_view name, const std::string& what)
{
    Listed found;
    if (!list.error.empty()) found.push_back(not_looked_for(what, list.error));
    for (const UsbListed& one : list.devices)
        found.push_back(listed(one.serial.empty() ? std::string(name) : fmt::format("{}:{}", name, one.serial), what,
                               fmt::format("USB bus {} device {}", one.bus, one.address), one.refused));
    return found;
}

Listed list_simulated()
{
    Listed found;
    for (const DevicePreset& preset : device_presets()) {
        found.push_back(
            listed(fmt::format("simulated:{}", preset.name), "a hand and a device in the computer", "", {}));
        found.back().axes = preset.model.axes;
        found.back().force_max_n = preset.model.force_max_n;
        found.back().rate_hz = preset.model.update_hz;
    }
    return found;
}

Listed list_connected_falcons()
{
    Listed found = list_usb(list_falcons(), "falcon", "Novint Falcon");
    for (ListedDevice& one : found) {
        one.axes.emplace();
        one.force_max_n = falcon_force_max_n;
        one.rate_hz = 1000; // the timer of its USB chip
    }
    return found;
}

Listed list_connected_openffboards()
{
    Listed found = list_usb(list_openffboards(), "openffboard", "OpenFFBoard");
    for (ListedDevice& one : found) one.rate_hz = 1000; // a report a frame of the bus
    return found;
}

Listed list_connected_inputs()
{
    Listed found;
    for (ListedInput& input : list_input_ports()) {
        found.push_back(listed("evdev:" + input.path, input.name, input.path, std::move(input.refused)));
        const glm::bvec3 along(true, input.axes > 1, false);
        if (input.axes > 0) found.back().axes = {along, along};
    }
    return found;
}

Listed list_served_inverse3s()
{
    Listed found;
    const Inverse3List list = list_inverse3s();
    if (!list.error.empty()) found.push_back(not_looked_for("Haply Inverse3", list.error));
    for (const std::string& id : list.ids) {
        found.push_back(listed("inverse3:" + id, "Haply Inverse3", "service at " + list.at, {}));
        found.back().axes.emplace();
        found.back().force_max_n = inverse3_force_max_n;
    }
    return found;
}

// One entry per driver.
struct Driver {
    std::string_view name, transport, syntax, what;
    DeviceResult (*open)(std::string_view variant, const DeviceRequest& request);
    Listed (*list)(); // null: it cannot be looked for
};
constexpr std::array<Driver, 7> drivers = {
    {{"simulated", "none", "simulated[:PRESET[:HAND]]", "a hand and a device in the computer", open_simulated,
      list_simulated},
     {"replay", "none", "replay:FILE", "the hand of an earlier run", open_recording, nullptr},
     {"falcon", "usb", "falcon[:SERIAL]", "Novint Falcon, three axes, USB", open_connected_falcon,
      list_connected_falcons},
     {"inverse3", "service", "inverse3[:DEVICE_ID]", "Haply Inverse3, three axes, through Haply's Inverse service",
      open_inverse3, list_served_inverse3s},
     {"openffboard", "usb", "openffboard[:SERIAL]", "OpenFFBoard, one axis or two, USB", open_openffboard,
      list_connected_openffboards},
     {"hid", "usb", "hid:VID:PID[:SERIAL]",
      "other wheel or stick of the USB's Physical Interface class, one axis or two", open_hid, nullptr},
     {"evdev", "kernel", "evdev:FILE", "wheel or stick with force feedback, one axis or two, by its file in /dev/input",
      open_evdev, list_connected_inputs}}};

} // namespace

DeviceResult open_device(const DeviceRequest& request)
{
    runtime::start_fork_server(); // guards come from there: before a device is open, so that it never holds its file
    const auto [name, variant] = split(request.name);
    for (const Driver& driver : drivers)
        if (driver.name == name) return driver.open(variant, request);
    if (name == "audio")
        return refused("a sound card senses no hand: `haptel render SCENE --play` makes a stroke of its own, plays its "
                       "force to a card or a voice coil, and follows the textures' files");
    return refused(unknown("device", name, names_of(drivers)) + "; `haptel devices` lists what is connected");
}

std::vector<std::string> device_names()
{
    std::vector<std::string> names;
    for (const DevicePreset& preset : device_presets()) names.push_back(fmt::format("simulated:{}", preset.name));
    for (const Driver& driver : drivers)
        if (driver.name != "simulated") names.emplace_back(driver.syntax);
    return names;
}

std::vector<SupportedDevice> supported_devices()
{
    std::vector<SupportedDevice> all;
    for (const Driver& driver : drivers) {
        std::string what(driver.what);
        if (driver.name == "simulated")
            what += fmt::format(": {}; hands: {}", fmt::join(names_of(device_presets()), ", "),
                                fmt::join(names_of(hand_presets()), ", "));
        all.push_back({std::string(driver.syntax), std::move(what)});
    }
    return all;
}

std::vector<ListedDevice> listed_devices()
{
    Listed all;
    for (const Driver& driver : drivers) {
        if (!driver.list) continue;
        Listed found = driver.list();
        if (found.empty()) {
            found.push_back(listed(std::string(driver.name), std::string(driver.what), "", {}));
            found.back().state = DeviceState::absent;
            found.back().refused = {"none is connected", "Plug it in and switch it on"};
        }
        for (ListedDevice& one : found) {
            if (one.name.empty()) one.name = driver.name;
            one.kind = driver.name;
            one.transport = driver.transport;
            all.push_back(std::move(one));
        }
    }
    return all;
}

} // namespace haptel::device
