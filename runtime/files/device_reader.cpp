#include "runtime/files/device_reader.h"

#include "runtime/files/effects_reader.h"

#include <string_view>
#include <utility>

namespace haptel::runtime {

namespace {

// Each has a servo with a thread and some MiB of records that nobody has read yet.
constexpr std::size_t devices_max = 64;

Workspace read_workspace(const toml::table& source, const std::string& name, FileMessages& messages)
{
    Workspace workspace;
    TableReader table(source, name, messages);
    workspace_fields(workspace, table.fields());
    workspace.placement = read_placement(table);
    table.report_unknown_keys();
    return workspace;
}

// The probe of a device or of the scene.
void find_stylus_length(const toml::table& owner, DeviceText& device)
{
    for (const toml::node* node : {owner["probe"].node(), owner["probe"]["length_m"].node()})
        if (node) device.at[static_cast<std::size_t>(DeviceKey::stylus_length)] = node->source();
}

DeviceText read_device(const toml::table& source, const std::string& name, DeviceText device,
                       const std::filesystem::path& folder, FileMessages& messages)
{
    TableReader table(source, name, messages);
    table.text("name", device.request.name);
    static const std::vector<std::string_view> strokes = {"circles", "scan", "press", "random"};
    if (const auto stroke = table.word("stroke", strokes)) device.request.stroke = strokes[*stroke];
    table.number("speed_m_per_s", device.request.speed_m_per_s, Quantity::speed, {0, 10, true});
    table.number("press_n", device.request.press_n, Quantity::force, {0, 100});
    static constexpr std::pair<DeviceKey, const char*> keys[] = {{DeviceKey::device, ""},
                                                                 {DeviceKey::name, "name"},
                                                                 {DeviceKey::stroke, "stroke"},
                                                                 {DeviceKey::speed, "speed_m_per_s"},
                                                                 {DeviceKey::press, "press_n"}};
    for (const auto& [key, written] : keys) device.at[static_cast<std::size_t>(key)] = table.where(written);
    find_stylus_length(source, device);
    table.whole_number("seed", device.request.seed);
    if (const toml::table* probe = table.table("probe", "{ kind = \"point\" }"))
        device.hand.probe = read_probe(*probe, "`probe`", messages);
    if (const toml::table* workspace = table.table("workspace", "{ scale = 2 }"))
        device.hand.workspace = read_workspace(*workspace, "`workspace`", messages);
    table.report_unknown_keys();

    constexpr std::string_view replay = "replay:";
    std::string& driver = device.request.name;
    if (driver.starts_with(replay))
        driver = std::string(replay) + (folder / driver.substr(replay.size())).lexically_normal().string();
    return device;
}

} // namespace

ProbeSettings read_probe(const toml::table& source, const std::string& name, FileMessages& messages)
{
    ProbeSettings probe;
    TableReader table(source, name, messages);
    if (const auto kind = table.word("kind", {"point", "sphere", "stylus", "gripper"}))
        probe.kind = static_cast<ProbeKind>(*kind);
    if (table.has("grip_m")) probe.grip_m = 0.0; // to be read
    probe_fields(probe, table.fields());
    if (table.has("length_m") && !probe.has_tail())
        messages.error(table.where("length_m"), "`length_m` is for `kind = \"stylus\"` or `\"gripper\"`: write one of "
                                                "them, or leave `length_m` out");
    check_probe(probe, [&](std::string_view key, const std::string& why) {
        messages.error(table.where(table.has(key) ? key : "kind"), why);
    });
    table.report_unknown_keys();
    return probe;
}

std::vector<DeviceText> read_devices(const toml::table& root, const ProbeSettings& probe,
                                     const std::filesystem::path& folder, FileMessages& messages)
{
    DeviceText common;
    common.request.name = "simulated:premium";
    common.request.stroke = "circles";
    common.hand.probe = probe;
    find_stylus_length(root, common);
    common.hand.workspace = read_workspace(table_named(root, "workspace", messages), "[workspace]", messages);

    if (!root["device"].is_array_of_tables())
        return {read_device(table_named(root, "device", messages), "[device]", common, folder, messages)};
    std::vector<DeviceText> devices;
    for (const toml::table* device :
         tables_of(root, "device", devices_max, ", each with a thread of its own", messages))
        devices.push_back(read_device(*device, "[[device]]", common, folder, messages));
    return devices;
}

} // namespace haptel::runtime
