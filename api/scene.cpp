#include "api/conversions.h"
#include "api/scene_state.h"
#include "runtime/files/assemble_scene.h"
#include "runtime/process/fork_server.h"
#include "runtime/scene/validation.h"

#include <algorithm>
#include <exception>
#include <utility>

namespace haptel {

namespace {

using input::FileMessages;

const TextureResolver& resolver_of(const TextureSource& textures)
{
    static const TextureResolver none = [](const TextureRequest&) {
        return TextureResult{std::nullopt, "error: this program brings no textures: make the scene with compiler() or "
                                           "precompiled()\n"};
    };
    return textures.implementation() ? textures.implementation()->resolve : none;
}

// From here on set() reaches the slot that the servos read.
void connect(Object::State& object, const runtime::SceneObject& built, const TextureSource& textures)
{
    const std::lock_guard lock(object.mutex);
    object.textures = textures;
    object.slot = built.texture;
    object.request = built.request;
    if (!object.request || !textures.implementation() || !textures.implementation()->follow) return;
    object.followed = textures.implementation()->follow(
        *object.request, [slot = object.slot](TextureBinding binding) { return slot->publish(std::move(binding)); });
}

runtime::ServoSettings servo_of(const SceneSettings& settings)
{
    runtime::ServoSettings servo;
    servo.rate_hz = settings.rate_hz;
    servo.force_limit_n = settings.force_limit_n;
    servo.v_max_m_per_s = settings.v_max_m_per_s;
    servo.force_rise_s = settings.force_rise_s;
    servo.force.model = static_cast<runtime::ForceModel>(settings.force_model);
    return servo;
}

runtime::ProbeSettings probe_of(const Probe& probe)
{
    runtime::ProbeSettings settings;
    settings.kind = static_cast<runtime::ProbeKind>(probe.kind);
    settings.length_m = probe.length_m;
    settings.radius_m = probe.radius_m;
    return settings;
}

// Repair leaves out what does not fit, which is no help to who meant it.
void check_mesh(const runtime::Mesh& mesh, const toml::source_region& at, FileMessages& messages)
{
    const auto check = [&](std::string_view name, size_t found, std::string_view of, size_t wanted) {
        if (found != 0 && found != wanted)
            messages.error(at, "`" + std::string(name) + "` must be one per " + std::string(of) + ", " +
                                   std::to_string(wanted) + ", or empty, found " + std::to_string(found));
    };
    check("uv", mesh.uv.size(), "position", mesh.positions_m.size());
    check("smoothing_groups", mesh.smoothing_groups.size(), "triangle", mesh.triangles.size());
}

// Of what the textures are asked for, before anything is built.
void check(const runtime::SceneText& text, FileMessages& messages)
{
    const runtime::Broken broken = [&](std::string_view, const std::string& why) { messages.error(why); };
    servo_fields(text.servo, runtime::RangeCheck(broken));
    probe_fields(text.probe, runtime::RangeCheck(broken));
    check_probe(text.probe, broken);
    for (const runtime::ObjectText& object : text.objects) {
        const runtime::Broken broken_here = [&](std::string_view, const std::string& why) {
            messages.error(object.mesh_at, why);
        };
        material_fields(object.object.material, runtime::RangeCheck(broken_here));
        check_material(object.object.material, broken_here);
        placement_fields(object.object.placement, runtime::RangeCheck(broken_here));
        if (!(object.size_m >= 0 && object.size_m <= 1000))
            messages.error(object.mesh_at,
                           "`size_m` must be from 0 to 1000, found " + runtime::shortest(object.size_m));
        if (object.own_mesh) check_mesh(*object.own_mesh, object.mesh_at, messages);
        if (const std::string fault = placement_fault(object.object.placement); !fault.empty())
            messages.error(object.mesh_at, fault);
    }
    if (text.objects.empty()) messages.error("a scene needs something to touch: add() an object");
}

} // namespace

Object& Object::texture(std::string reference, Parameters parameters)
{
    state_->text.texture.reference = std::move(reference);
    state_->text.texture.parameters = std::move(parameters);
    return *this;
}

Object& Object::place(const Placement& placement)
{
    state_->text.object.placement = {runtime::rotation_about_axes(to_glm(placement.rotation_deg)),
                                     to_glm(placement.position_m)};
    return *this;
}

Object& Object::apart()
{
    state_->text.joined = false;
    return *this;
}

std::string Object::set(const std::string& parameter, const std::string& value)
{
    const std::lock_guard lock(state_->mutex);
    if (!state_->slot) return "the scene is not built";
    if (!state_->request) return "the object has no texture";
    TextureRequest changed = *state_->request;
    std::erase_if(changed.parameters, [&](const auto& known) { return known.first == parameter; });
    changed.parameters.emplace_back(parameter, value); // the last counts, of a vector and its components too
    TextureResult made = state_->textures.implementation()->rebind(changed);
    const bool may_wait = state_->followed && made.diagnostics.empty(); // until the file is mended
    if (!made.binding && !may_wait)
        return made.diagnostics.empty() ? "the texture's file has mistakes now, and was compiled again: mend it first"
                                        : made.diagnostics;
    if (state_->followed)
        state_->followed->set(parameter, value);
    else if (std::string fault = state_->slot->publish(std::move(*made.binding)); !fault.empty())
        return fault;
    state_->request = std::move(changed);
    return {};
}

Scene::operator bool() const
{
    return state_->scene != nullptr;
}

const std::string& Scene::messages() const
{
    return state_->messages;
}

std::vector<Object> Scene::objects() const
{
    std::vector<Object> all;
    for (const auto& object : state_->objects) all.emplace_back(object);
    return all;
}

struct SceneBuilder::State {
    TextureSource textures;
    std::vector<std::shared_ptr<Object::State>> objects;

    Object add(const Material& material)
    {
        auto object = std::make_shared<Object::State>();
        object->text.object.material = {material.stiffness_n_per_m, material.damping_n_s_per_m,
                                        material.static_friction, material.dynamic_friction};
        objects.push_back(object);
        const auto number = static_cast<toml::source_index>(objects.size());
        object->text.mesh_at.begin = {number, 1};
        object->text.stiffness_at = object->text.reach_at = object->text.texture.at = object->text.mesh_at;
        return Object(std::move(object));
    }
};

SceneBuilder::SceneBuilder(TextureSource textures) : state_(std::make_unique<State>())
{
    state_->textures = std::move(textures);
}

SceneBuilder::~SceneBuilder() = default;
SceneBuilder::SceneBuilder(SceneBuilder&&) noexcept = default;
SceneBuilder& SceneBuilder::operator=(SceneBuilder&&) noexcept = default;

Object SceneBuilder::add(Mesh mesh, const Material& material)
{
    Object object = state_->add(material);
    object.state_->text.object.name = "mesh " + std::to_string(state_->objects.size());
    object.state_->text.own_mesh = std::make_shared<const runtime::Mesh>(to_runtime(std::move(mesh)));
    return object;
}

Object SceneBuilder::add_file(std::string file, double size_m, const Material& material)
{
    Object object = state_->add(material);
    object.state_->text.mesh = std::move(file);
    object.state_->text.size_m = size_m;
    return object;
}

Scene SceneBuilder::finish(const SceneSettings& settings)
{
    auto state = std::make_shared<Scene::State>();
    FileMessages messages{{}};
    runtime::SceneText text;
    text.probe = probe_of(settings.probe);
    text.servo = servo_of(settings);
    text.devices.emplace_back().hand.probe = text.probe;
    for (const auto& object : state_->objects) text.objects.push_back(std::move(object->text));
    check(text, messages);
    const auto is_file = [](const runtime::ObjectText& object) { return !object.mesh.empty(); };
    if (std::ranges::any_of(text.objects, is_file)) runtime::start_fork_server(); // which reads what strangers wrote
    try {
        if (!messages.any_error())
            state->scene =
                runtime::assemble_scene(std::move(text), ".", resolver_of(state_->textures), {}, nullptr, {}, messages)
                    .scene;
        for (std::size_t i = 0; state->scene && i < state_->objects.size(); ++i)
            connect(*state_->objects[i], state->scene->objects[i], state_->textures);
    } catch (const std::exception& problem) { // no memory, no thread
        state->scene = nullptr;
        messages.error(std::string("the scene could not be built: ") + problem.what());
    }
    state->messages = messages.text();
    if (state->scene) state->objects = std::move(state_->objects);
    state_->objects.clear();
    return Scene(std::move(state));
}

Scene load_scene(const std::string& file, TextureSource textures)
{
    auto state = std::make_shared<Scene::State>();
    runtime::LoadedScene loaded = runtime::load_scene(file, resolver_of(textures), {});
    state->scene = std::move(loaded.scene);
    state->messages = std::move(loaded.diagnostics);
    if (state->scene)
        for (const runtime::SceneObject& built : state->scene->objects)
            connect(*state->objects.emplace_back(std::make_shared<Object::State>()), built, textures);
    return Scene(std::move(state));
}

} // namespace haptel
