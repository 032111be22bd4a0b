#include "runtime/files/scene_file.h"

#include "input/regular_file.h"
#include "input/toml/toml_syntax.h"
#include "runtime/files/device_reader.h"
#include "runtime/files/effects_reader.h"
#include "runtime/files/joining.h"
#include "runtime/files/mesh_surface.h"
#include "runtime/files/motion_reader.h"
#include "runtime/files/object_texture.h"
#include "runtime/files/open_hands.h"
#include "runtime/files/table_reader.h"
#include "runtime/process/fork_server.h"
#include "runtime/surface/shapes.h"
#include "runtime/texture/shading.h"

#include <algorithm>
#include <exception>
#include <map>
#include <optional>
#include <sstream>
#include <tuple>
#include <utility>

namespace haptel::runtime {

namespace {

// Side of a built-in shape whose size the scene does not say, metres.
constexpr double default_shape_size_m = 0.1;

// What is tried with servos is half of it. Who meets whom is found in a time that may grow by the square.
constexpr std::size_t objects_max = 20'000;

// What a scene file says, before anything else is opened.
struct ObjectText {
    std::string mesh, shape;
    double size_m = 0; // 0: as it is
    double crease_deg = default_crease_deg;
    bool own_crease = false; // it was written: the mesh's smoothing groups do not count
    bool joined = true;      // with what it meets
    std::string surface_key;
    SceneObject object;
    MotionText motion;
    TextureText texture;
    toml::source_region mesh_at, stiffness_at, reach_at;
};

struct SceneText {
    ProbeSettings probe;
    ServoSettings servo;
    std::vector<Region> regions;
    std::vector<DeviceText> devices;
    std::vector<ObjectText> objects;
};

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

    table.number("crease_deg", text.crease_deg, Quantity::angle_deg, {0, 180});
    text.own_crease = table.has("crease_deg");

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

    const toml::node* objects = root.get("object");
    const toml::array* list = objects ? objects->as_array() : nullptr;
    if (!objects)
        messages.error("a scene needs something to touch: add an `[[object]]` with a `mesh` or a `shape`");
    else if (!list || !list->is_array_of_tables())
        messages.error(objects->source(), "expected `[[object]]` in double brackets: a scene may hold several objects");
    else if (list->size() > objects_max)
        messages.error((*list)[objects_max].source(), "a scene may hold " + std::to_string(objects_max) +
                                                          " objects, and this one has " + std::to_string(list->size()) +
                                                          ": leave some out");
    else
        for (const toml::node& object : *list)
            text.objects.push_back(read_object(*object.as_table(), text.servo.rate_hz, messages));
    return text;
}

// Told as being about that.
Loading about(const std::string& what, const Loading& loading)
{
    if (!loading.tell) return loading;
    return {[&loading, what](std::string_view doing) { loading.tell(what + ": " + std::string(doing)); }, loading.stop,
            loading.threads};
}

void load_geometry(ObjectText& text, const std::filesystem::path& folder, SurfaceCache* surfaces,
                   const Loading& loading, FileMessages& messages)
{
    text.object.name = text.mesh.empty() ? text.shape : text.mesh;
    const std::filesystem::path file = text.mesh.empty() ? "" : (folder / text.mesh).lexically_normal();
    const std::string key = text.surface_key = SurfaceCache::key(
        file, text.shape, text.size_m, text.own_crease ? std::optional(text.crease_deg) : std::nullopt);
    if (surfaces) text.object.surface = surfaces->find(key);
    if (text.object.surface) return;
    const std::string named = "mesh `" + text.object.name + "`";
    const Loading of_mesh = about(named, loading);
    MeshSurface built;
    if (text.mesh.empty()) {
        Mesh mesh = make_shape(text.shape).value_or(Mesh{});
        if (text.size_m > 0) scale_to_size(mesh, text.size_m);
        SurfaceResult shape = build_surface(mesh, text.crease_deg, &of_mesh);
        built = {std::move(shape.surface), shape.report, std::move(shape.error), {}};
    } else {
        built = surface_of_mesh_file(file, text.size_m, text.own_crease ? std::optional(text.crease_deg) : std::nullopt,
                                     of_mesh);
    }
    if (!built.error.empty()) {
        messages.error(text.mesh_at, named + ": " + built.error);
        return;
    }
    if (!built.warning.empty()) messages.warning(text.mesh_at, named + ": " + built.warning);
    if (built.all_groups_off)
        messages.note(text.mesh_at, named + ": all its faces are without a smoothing group (`s off`) and felt flat; "
                                            "write `crease_deg = 40` to feel it round where it is not sharper than "
                                            "that");
    if (const std::string warning = built.report.warning(); !warning.empty())
        messages.warning(text.mesh_at, named + ": " + warning);
    if (const std::string note = built.report.note(); !text.mesh.empty() && !note.empty())
        messages.note(text.mesh_at, named + ": " + note);
    text.object.surface = std::move(built.surface);
    if (surfaces) surfaces->keep(key, text.object.surface);
}

double largest_scale(const std::vector<DeviceText>& devices)
{
    double scale = 0;
    for (const DeviceText& device : devices) scale = std::max(scale, device.hand.workspace.scale);
    return scale;
}

double largest_side_m(const SceneObject& object)
{
    const glm::dvec3 sides_m = object.surface->box_maximum_m - object.surface->box_minimum_m;
    return std::max({sides_m.x, sides_m.y, sides_m.z});
}

// Mesh files do not say their unit. No hand reaches round something this large.
constexpr double hand_reach_m = 5;

void check_unit(const ObjectText& text, const std::vector<DeviceText>& devices, FileMessages& messages)
{
    const double largest_m = largest_side_m(text.object);
    if (text.mesh.empty() || text.size_m > 0 || largest_m <= hand_reach_m * largest_scale(devices)) return;
    std::ostringstream size;
    size << largest_m; // to 6 digits
    messages.warning(text.mesh_at, "mesh `" + text.mesh + "` is " + size.str() +
                                       " m large, as its numbers are taken for metres: if they are millimetres write "
                                       "`size_m = \"" +
                                       size.str() + "mm\"`, else `size_m = \"" + size.str() + "m\"`");
}

// What leaves both the reach of a hand that sits at its device, and its own place by far, is hardly met again.
// Something small may well cross all of the workspace.
constexpr double seated_reach_m = 0.5, swing_sides_max = 5;

void check_swing(const ObjectText& text, const std::vector<DeviceText>& devices, FileMessages& messages)
{
    const double swing_m = text.motion.swing_m, largest_m = largest_side_m(text.object);
    if (swing_m <= std::max(seated_reach_m * largest_scale(devices), swing_sides_max * largest_m)) return;
    std::ostringstream figures; // to 6 digits
    figures << "`" << text.object.name << "` swings by " << swing_m << " m to either side, but is only " << largest_m
            << " m large: a hand hardly meets it again. Is a unit wrong (`swing_m = [0, 0, \"1mm\"]`, `size_m` of the "
               "object)?";
    messages.warning(text.motion.swing_at, figures.str());
}

void check_reach(const ObjectText& text, const std::vector<DeviceText>& devices, FileMessages& messages)
{
    const auto told_at = [&](const toml::source_region& where) {
        return [&messages, where](std::string_view, const std::string& why) { messages.error(where, why); };
    };
    const std::size_t errors = messages.errors();
    for (const DeviceText& device : devices)
        if (messages.errors() == errors) check_probe_size(device.probe, text.object, told_at(text.mesh_at));
    check_effects_reach(text.object, told_at(text.reach_at));
}

// How fast hands move in the scene: its speeds are those of the hand times the scale.
double hand_speed_max_m_per_s(const SceneText& scene)
{
    return largest_scale(scene.devices) * scene.servo.v_max_m_per_s;
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

    using Geometry = std::tuple<std::string, std::string, double, double, bool>;
    std::map<Geometry, std::vector<ObjectText>::iterator> first_of;
    for (auto object = text.objects.begin(); object != text.objects.end(); ++object) {
        const Geometry geometry{object->mesh, object->shape, object->size_m, object->crease_deg, object->own_crease};
        const auto same = first_of.try_emplace(geometry, object).first->second;
        if (same == object) {
            if (!object->mesh.empty()) loaded.meshes.push_back((folder / object->mesh).lexically_normal());
            load_geometry(*object, folder, surfaces, loading, messages);
        } else { // what is there many times is held once
            object->object.name = same->object.name;
            object->object.surface = same->object.surface;
            object->surface_key = same->surface_key;
        }
        if (loading.stopped()) break;
        if (object->object.surface && same == object) check_unit(*object, text.devices, messages);
        if (object->object.surface) check_swing(*object, text.devices, messages);
        if (object->object.surface) check_reach(*object, text.devices, messages);
    }
    if (messages.any_error()) return loaded;
    const HandLimits hands{hand_speed_max_m_per_s(text), text.servo.rate_hz};
    for (ObjectText& object : text.objects) {
        if (loading.stopped()) break;
        if (loading.tell && !object.texture.reference.empty())
            loading.tell("texture `" + object.texture.reference + "`");
        load_texture(object.object, object.texture, hands, folder, textures, messages);
    }
    if (messages.any_error()) return loaded;

    auto scene = std::make_shared<Scene>();
    scene->probe = text.probe;
    scene->servo = text.servo;
    scene->regions = std::move(text.regions);
    std::vector<ObjectAtRest> at_rest;
    for (ObjectText& object : text.objects) {
        if (!object.object.motion)
            at_rest.push_back(
                {uint32_t(scene->objects.size()), std::move(object.surface_key), object.mesh_at, object.joined});
        scene->objects.push_back(std::move(object.object));
    }
    warn_of_doubles(*scene, at_rest, messages);
    const Loading of_joining = about("objects that meet", loading);
    join_objects(*scene, std::move(at_rest), surfaces, messages, &of_joining);
    if (loading.stopped()) {
        messages.error(std::string(loading_was_stopped));
        return loaded;
    }

    // All that a scene can break is told above, where it is written; a renderer asks for this, too.
    if (const std::string faults = validate(scene.get(), {.probe = text.devices.front().probe}); !faults.empty())
        messages.error(faults);
    std::vector<toml::source_region> stiffness_at;
    for (const ObjectText& object : text.objects) stiffness_at.push_back(object.stiffness_at);
    loaded.hands = open_hands(text.devices, scene, stiffness_at, devices, messages);
    if (messages.any_error()) {
        loaded.hands.clear();
        return loaded;
    }
    for (const DeviceText& device : text.devices) loaded.probes.push_back(device.probe);
    loaded.scene = std::move(scene);
    return loaded;
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
