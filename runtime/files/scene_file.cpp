#include "runtime/files/scene_file.h"

#include "input/regular_file.h"
#include "input/toml/toml_syntax.h"
#include "runtime/files/assemble_scene.h"
#include "runtime/files/device_reader.h"
#include "runtime/files/effects_reader.h"
#include "runtime/files/motion_reader.h"
#include "runtime/files/object_texture.h"
#include "runtime/files/table_reader.h"
#include "runtime/process/fork_server.h"
#include "runtime/surface/shapes.h"

#include <algorithm>
#include <exception>
#include <optional>
#include <utility>

namespace haptel::runtime {

namespace {

// What is tried with servos is half of it. Who meets whom is found in a time that may grow by the square.
constexpr std::size_t objects_max = 20'000;

ServoSettings read_servo(const toml::table& root, FileMessages& messages)
{
    ServoSettings servo;
    TableReader table(table_named(root, "servo", messages), "[servo]", messages);
    servo_fields(servo, table.fields());
    if (const auto model = table.word("force_model", {force_model_names.begin(), force_model_names.end()}))
        servo.force.model = static_cast<ForceModel>(*model);
    if (const auto shading = table.word("shading", {force_shading_names.begin(), force_shading_names.end()}))
        servo.force.shading = static_cast<ForceShading>(*shading);
    if (table.has("lateral_depth_m") && servo.force.model != ForceModel::lateral)
        messages.error(table.where("lateral_depth_m"),
                       "`lateral_depth_m` is for `force_model = \"lateral\"` alone: write that, or leave it out");
    table.report_unknown_keys();
    return servo;
}

Material read_material(TableReader& table)
{
    Material material;
    material_fields(material, table.fields());
    // A default gives way to what is written.
    if (!table.has("dynamic_friction"))
        material.dynamic_friction = std::min(material.dynamic_friction, material.static_friction);
    else if (!table.has("static_friction"))
        material.static_friction = std::max(material.dynamic_friction, material.static_friction);
    check_material(material, table.broken());
    return material;
}

ObjectText read_object(const toml::table& source, double rate_hz, FileMessages& messages)
{
    ObjectText text;
    TableReader table(source, "[[object]]", messages);
    table.text("mesh", text.mesh);
    if (const auto shape = table.word("shape", {shape_names.begin(), shape_names.end()}))
        text.shape = shape_names[*shape];
    if (table.has("mesh") == table.has("shape"))
        messages.error(source.source(), table.has("mesh") ? "an object has either a `mesh` or a `shape`, not both"
                                                          : "an object needs a `mesh = \"FILE\"` or a `shape`: " +
                                                                either_of({shape_names.begin(), shape_names.end()}));
    text.mesh_at = table.where(table.has("mesh") ? "mesh" : "shape");
    if (!table.has("mesh")) text.size_m = default_shape_size_m;
    table.number("size_m", text.size_m, Quantity::length, {0, 1000, true});

    if (table.has("crease_deg")) table.number("crease_deg", text.crease_deg.emplace(), Quantity::angle_deg, {0, 180});
    text.object.placement = read_placement(table);
    text.motion = read_motion(table, text.object.placement, rate_hz, messages);
    text.object.motion = text.motion.motion;
    table.yes_or_no("joined", text.joined);
    if (table.has("joined") && text.joined && text.object.motion)
        messages.error(table.where("joined"), "an object that moves cannot be joined to what it meets");
    text.object.material = read_material(table);
    text.stiffness_at = table.where("stiffness_n_per_m");
    text.object.effects = read_object_effects(table, rate_hz, messages);
    text.reach_at = farthest_reach_at(source, text.object.effects);
    text.texture = read_texture(table, messages);
    table.report_unknown_keys();
    return text;
}

SceneText read_scene(const toml::table& root, const std::filesystem::path& folder, const SceneChanges& changes,
                     FileMessages& messages)
{
    SceneText text;
    text.probe = read_probe(table_named(root, "probe", messages), "[probe]", messages);
    text.servo = read_servo(root, messages);
    text.servo.rate_hz = changes.rate_hz.value_or(text.servo.rate_hz);
    text.devices = read_devices(root, text.probe, folder, messages);
    text.regions = read_regions(root, text.servo.rate_hz, messages);

    TableReader top(root, "", messages);
    for (const char* name : {"probe", "servo", "workspace", "device", "object", "region"}) (void)top.has(name);
    top.report_unknown_keys();

    if (!root.contains("object"))
        messages.error("a scene needs something to touch: add an `[[object]]` with a `mesh` or a `shape`");
    for (const toml::table* object : tables_of(root, "object", objects_max, "", messages))
        text.objects.push_back(read_object(*object, text.servo.rate_hz, messages));
    return text;
}

LoadedScene load(const std::filesystem::path& file, const TextureResolver& textures, const DeviceFactory& devices,
                 SurfaceCache* surfaces, const Loading& loading, const SceneChanges& changes, FileMessages& messages)
{
    LoadedScene loaded;
    if (file.extension().string().starts_with(".haptel")) { // with or without ":NAME" behind it
        messages.error("this is a texture, and a scene is needed: a TOML file with an `[[object]]` that has this "
                       "`texture`");
        return loaded;
    }
    const input::FileBytes source = input::read_regular_file(file, scene_bytes_max);
    if (const auto& [refusal, why] = source.refused; refusal != input::Refusal::none) {
        messages.error(refusal == input::Refusal::missing     ? "the scene could not be read: is the path right?"
                       : refusal == input::Refusal::folder    ? "this is a folder: name the scene file in it"
                       : refusal == input::Refusal::too_large ? "the scene " + why + ": is it the right file?"
                                                              : "the scene " + why);
        return loaded;
    }
    const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
    SceneText text;
    if (const std::optional<toml::table> tables = input::parse_toml(source.bytes, messages))
        text = read_scene(*tables, folder, changes, messages);
    if (messages.any_error()) return loaded;

    return assemble_scene(std::move(text), folder, textures, devices, surfaces, loading, messages);
}

} // namespace

LoadedScene load_scene(const std::filesystem::path& file, const TextureResolver& textures, const DeviceFactory& devices,
                       SurfaceCache* surfaces, const Loading& loading, const SceneChanges& changes)
{
    start_fork_server(); // a mesh may come into the scene while a servo runs
    FileMessages messages(file);
    LoadedScene loaded;
    try {
        loaded = load(file, textures, devices, surfaces, loading, changes, messages);
    } catch (const std::exception& problem) {
        messages.error(std::string("the scene could not be loaded: ") + problem.what());
    }
    loaded.diagnostics = messages.text();
    return loaded;
}

} // namespace haptel::runtime
