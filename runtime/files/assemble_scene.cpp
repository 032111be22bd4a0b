#include "runtime/files/assemble_scene.h"

#include "runtime/files/joining.h"
#include "runtime/files/mesh_surface.h"
#include "runtime/files/open_hands.h"
#include "runtime/surface/shapes.h"

#include <algorithm>
#include <map>
#include <optional>
#include <sstream>
#include <tuple>
#include <utility>

namespace haptel::runtime {

namespace {

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
    if (text.object.name.empty()) text.object.name = text.mesh.empty() ? text.shape : text.mesh;
    const std::filesystem::path file = text.mesh.empty() ? "" : (folder / text.mesh).lexically_normal();
    const std::string key = text.surface_key = SurfaceCache::key(file, text.shape, text.size_m, text.crease_deg);
    if (surfaces && !text.own_mesh) text.object.surface = surfaces->find(key);
    if (text.object.surface) return;
    const std::string named = "mesh `" + text.object.name + "`";
    const Loading of_mesh = about(named, loading);
    MeshSurface built;
    if (text.mesh.empty()) {
        Mesh mesh = text.own_mesh ? *text.own_mesh : make_shape(text.shape).value_or(Mesh{});
        if (text.size_m > 0) scale_to_size(mesh, text.size_m);
        SurfaceResult shape = build_surface(mesh, text.crease_deg.value_or(default_crease_deg), &of_mesh);
        built = {std::move(shape.surface), shape.report, std::move(shape.error), {}};
    } else {
        built = surface_of_mesh_file(file, text.size_m, text.crease_deg, of_mesh);
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
    if (const std::string note = built.report.note(); text.shape.empty() && !note.empty())
        messages.note(text.mesh_at, named + ": " + note);
    text.object.surface = std::move(built.surface);
    if (surfaces && !text.own_mesh) surfaces->keep(key, text.object.surface);
}

double largest_scale(const std::vector<DeviceText>& devices)
{
    double scale = 0;
    for (const DeviceText& device : devices) scale = std::max(scale, device.hand.workspace.scale);
    return scale;
}

// Mesh files do not say their unit. No hand reaches round something this large.
constexpr double hand_reach_m = 5;

void check_unit(const ObjectText& text, const std::vector<DeviceText>& devices, FileMessages& messages)
{
    const double largest_m = text.object.surface->largest_side_m();
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
    const double swing_m = text.motion.swing_m, largest_m = text.object.surface->largest_side_m();
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
        if (messages.errors() == errors) check_probe_size(*device.hand.probe, text.object, told_at(text.mesh_at));
    check_effects_reach(text.object, told_at(text.reach_at));
}

// How fast hands move in the scene: its speeds are those of the hand times the scale.
double hand_speed_max_m_per_s(const SceneText& scene)
{
    return largest_scale(scene.devices) * scene.servo.v_max_m_per_s;
}

} // namespace

LoadedScene assemble_scene(SceneText text, const std::filesystem::path& folder, const TextureResolver& textures,
                           const DeviceFactory& devices, SurfaceCache* surfaces, const Loading& loading,
                           FileMessages& messages)
{
    LoadedScene loaded;
    using Geometry = std::tuple<std::string, std::string, const Mesh*, double, std::optional<double>>;
    std::map<Geometry, std::vector<ObjectText>::iterator> first_of;
    for (auto object = text.objects.begin(); object != text.objects.end(); ++object) {
        const Geometry geometry{object->mesh, object->shape, object->own_mesh.get(), object->size_m,
                                object->crease_deg};
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
    if (const std::string faults = validate(scene.get(), {.probe = text.devices.front().hand.probe}); !faults.empty())
        messages.error(faults);
    std::vector<toml::source_region> stiffness_at;
    for (const ObjectText& object : text.objects) stiffness_at.push_back(object.stiffness_at);
    loaded.hands = open_hands(text.devices, scene, stiffness_at, devices, messages);
    if (messages.any_error()) {
        loaded.hands.clear();
        return loaded;
    }
    for (const DeviceText& device : text.devices) loaded.probes.push_back(*device.hand.probe);
    loaded.scene = std::move(scene);
    return loaded;
}

} // namespace haptel::runtime
