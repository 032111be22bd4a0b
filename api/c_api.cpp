// haptel/c.h over the C++ headers. No exception leaves it: where one would, null or 0 is returned.
#include "api/c_source.h"

#include <haptel/haptel.h>

#include <algorithm>
#include <cmath>
#include <new>
#include <optional>
#include <string>
#include <string_view>

struct haptel_builder {
    haptel::SceneBuilder build;
    std::vector<haptel::Object> objects;
};

struct haptel_scene {
    haptel::Scene scene;
    std::vector<haptel::Object> objects;
};

struct haptel_servo {
    haptel::Servo servo;
    std::string stop_reason;
};

struct haptel_renderer {
    haptel::Renderer renderer;
};

namespace {

constexpr const char* out_of_memory = "error: there is no memory for it\n"; // what a null is

template <typename Make>
auto made(Make&& make) noexcept -> decltype(make())
{
    try {
        return make();
    } catch (const std::exception&) {
        return {};
    }
}

std::string text_or(const char* text, const char* otherwise)
{
    return text ? text : otherwise;
}

haptel::Vec3 to_vec3(const double* of_three)
{
    return of_three ? haptel::Vec3{of_three[0], of_three[1], of_three[2]} : haptel::Vec3{};
}

haptel::Material to_material(const haptel_material* material)
{
    if (!material) return {};
    return {material->stiffness_n_per_m, material->damping_n_s_per_m, material->static_friction,
            material->dynamic_friction};
}

haptel::TextureSource to_source(const haptel_source* source)
{
    return source ? source->textures : haptel::TextureSource{};
}

haptel::SceneSettings to_settings(const haptel_scene_settings& of_c)
{
    haptel::SceneSettings settings;
    settings.rate_hz = of_c.rate_hz;
    settings.force_limit_n = of_c.force_limit_n;
    settings.v_max_m_per_s = of_c.v_max_m_per_s;
    settings.force_rise_s = of_c.force_rise_s;
    settings.force_model = static_cast<haptel::ForceModel>(of_c.force_model);
    settings.probe = {static_cast<haptel::ProbeKind>(of_c.probe), of_c.probe_length_m, of_c.probe_radius_m};
    return settings;
}

uint32_t added(haptel_builder* builder, haptel::Object object)
{
    builder->objects.push_back(std::move(object));
    return static_cast<uint32_t>(builder->objects.size());
}

haptel::Object* object_of(std::vector<haptel::Object>& objects, uint32_t number)
{
    return number >= 1 && number <= objects.size() ? &objects[number - 1] : nullptr;
}

std::optional<haptel::Mesh> shape_of(std::string_view name, double size_m)
{
    if (name == "plane") return haptel::plane(size_m);
    if (name == "box") return haptel::box({size_m, size_m, size_m});
    if (name == "sphere") return haptel::sphere(size_m);
    if (name == "icosphere") return haptel::icosphere(size_m);
    if (name == "torus") return haptel::torus(size_m);
    return std::nullopt;
}

haptel_scene* scene_of(haptel::Scene scene)
{
    std::vector<haptel::Object> objects = scene.objects();
    return new haptel_scene{std::move(scene), std::move(objects)};
}

void put(double (&to)[3], const haptel::Vec3& v)
{
    to[0] = v.x, to[1] = v.y, to[2] = v.z;
}

} // namespace

const char* haptel_version(void)
{
    return HAPTEL_VERSION;
}

haptel_source* haptel_precompiled(const haptel_texture* const* textures, size_t count)
{
    return made([&] {
        return new haptel_source{
            haptel::precompiled(std::vector<const haptel_texture*>(textures, textures + (textures ? count : 0)))};
    });
}

void haptel_source_free(haptel_source* source)
{
    delete source;
}

haptel_material haptel_default_material(void)
{
    const haptel::Material material;
    return {material.stiffness_n_per_m, material.damping_n_s_per_m, material.static_friction,
            material.dynamic_friction};
}

haptel_scene_settings haptel_default_settings(void)
{
    const haptel::SceneSettings settings;
    return {settings.rate_hz,
            settings.force_limit_n,
            settings.v_max_m_per_s,
            settings.force_rise_s,
            static_cast<int32_t>(settings.force_model),
            static_cast<int32_t>(settings.probe.kind),
            settings.probe.length_m,
            settings.probe.radius_m};
}

haptel_builder* haptel_builder_new(const haptel_source* textures)
{
    return made([&] { return new haptel_builder{haptel::SceneBuilder{to_source(textures)}, {}}; });
}

void haptel_builder_free(haptel_builder* builder)
{
    delete builder;
}

uint32_t haptel_add_shape(haptel_builder* builder, const char* shape, double size_m, const haptel_material* material)
{
    if (!builder) return 0;
    return made([&]() -> uint32_t {
        std::optional<haptel::Mesh> mesh = shape_of(text_or(shape, ""), size_m);
        return mesh ? added(builder, builder->build.add(std::move(*mesh), to_material(material))) : 0;
    });
}

uint32_t haptel_add_mesh(haptel_builder* builder, const double* positions_m, size_t positions,
                         const uint32_t* triangles, size_t triangle_count, const haptel_material* material)
{
    if (!builder || (!positions_m && positions > 0) || (!triangles && triangle_count > 0)) return 0;
    return made([&] {
        haptel::Mesh mesh;
        for (size_t i = 0; i < positions; ++i) mesh.positions_m.push_back(to_vec3(positions_m + 3 * i));
        for (size_t i = 0; i < triangle_count; ++i)
            mesh.triangles.push_back({triangles[3 * i], triangles[3 * i + 1], triangles[3 * i + 2]});
        return added(builder, builder->build.add(std::move(mesh), to_material(material)));
    });
}

uint32_t haptel_add_file(haptel_builder* builder, const char* file, double size_m, const haptel_material* material)
{
    if (!builder) return 0;
    return made(
        [&] { return added(builder, builder->build.add_file(text_or(file, ""), size_m, to_material(material))); });
}

int32_t haptel_object_texture(haptel_builder* builder, uint32_t object, const char* reference,
                              const haptel_value* values, size_t count)
{
    if (!builder) return 0;
    return made([&]() -> int32_t {
        haptel::Object* const found = object_of(builder->objects, object);
        if (found) found->texture(text_or(reference, ""), haptel::parameters_of(values, count));
        return found != nullptr;
    });
}

int32_t haptel_object_place(haptel_builder* builder, uint32_t object, const double position_m[3],
                            const double rotation_deg[3])
{
    haptel::Object* const found = builder ? object_of(builder->objects, object) : nullptr;
    if (found) found->place({to_vec3(position_m), to_vec3(rotation_deg)});
    return found != nullptr;
}

int32_t haptel_object_apart(haptel_builder* builder, uint32_t object)
{
    haptel::Object* const found = builder ? object_of(builder->objects, object) : nullptr;
    if (found) found->apart();
    return found != nullptr;
}

haptel_scene* haptel_build(haptel_builder* builder, const haptel_scene_settings* settings)
{
    if (!builder) return nullptr;
    return made([&] {
        const haptel::SceneSettings own = settings ? to_settings(*settings) : haptel::SceneSettings{};
        builder->objects.clear();
        return scene_of(builder->build.finish(own));
    });
}

haptel_scene* haptel_load_scene(const char* file, const haptel_source* textures)
{
    return made([&] { return scene_of(haptel::load_scene(text_or(file, ""), to_source(textures))); });
}

int32_t haptel_scene_ok(const haptel_scene* scene)
{
    return scene && scene->scene;
}

const char* haptel_scene_messages(const haptel_scene* scene)
{
    return scene ? scene->scene.messages().c_str() : out_of_memory;
}

const char* haptel_scene_set(haptel_scene* scene, uint32_t object, const char* parameter, const char* value)
{
    static thread_local std::string refused;
    try {
        haptel::Object* const found = scene ? object_of(scene->objects, object) : nullptr;
        refused = found ? found->set(text_or(parameter, ""), text_or(value, ""))
                        : "the scene has no object " + std::to_string(object);
        return refused.c_str();
    } catch (const std::exception&) {
        return out_of_memory;
    }
}

void haptel_scene_free(haptel_scene* scene)
{
    delete scene;
}

haptel_servo* haptel_servo_new(const haptel_scene* scene, const char* device, double seconds, int32_t virtual_time)
{
    if (!scene) return nullptr;
    return made([&] {
        haptel::ServoOptions options;
        options.seconds = seconds;
        options.virtual_time = virtual_time != 0;
        return new haptel_servo{
            haptel::Servo{scene->scene, haptel::open_device(text_or(device, "simulated:premium")), options}, {}};
    });
}

int32_t haptel_servo_ok(const haptel_servo* servo)
{
    return servo && servo->servo;
}

const char* haptel_servo_messages(const haptel_servo* servo)
{
    return servo ? servo->servo.messages().c_str() : out_of_memory;
}

void haptel_servo_start(haptel_servo* servo)
{
    if (servo) servo->servo.start();
}

void haptel_servo_request_stop(haptel_servo* servo)
{
    if (servo) servo->servo.request_stop();
}

int32_t haptel_servo_running(const haptel_servo* servo)
{
    return servo && servo->servo.running();
}

haptel_report haptel_servo_wait(haptel_servo* servo)
{
    return made([&]() -> haptel_report {
        if (!servo) return {};
        const haptel::Report run = servo->servo.wait();
        servo->stop_reason = run.stop_reason;
        return {run.faulted,        run.seconds,          run.ticks,       run.contact_ticks, run.missed_deadlines,
                run.faults,         run.textures_changed, run.force_rms_n, run.force_max_n,   run.energy_j,
                run.tick_ns_median, run.tick_ns_p99};
    });
}

const char* haptel_servo_stop_reason(const haptel_servo* servo)
{
    return servo ? servo->stop_reason.c_str() : out_of_memory;
}

void haptel_servo_free(haptel_servo* servo)
{
    delete servo;
}

haptel_renderer* haptel_renderer_new(const haptel_scene* scene)
{
    if (!scene) return nullptr;
    return made([&] { return new haptel_renderer{haptel::Renderer{scene->scene}}; });
}

const char* haptel_renderer_messages(const haptel_renderer* renderer)
{
    return renderer ? renderer->renderer.messages().c_str() : out_of_memory;
}

haptel_force haptel_tick(haptel_renderer* renderer, const double tip_m[3], const double tail_m[3], uint64_t periods)
{
    haptel_force force{};
    if (!renderer) return force;
    const haptel::Force felt = renderer->renderer.tick({to_vec3(tip_m), to_vec3(tail_m)}, periods);
    force.grip_force_n = felt.grip_force_n;
    put(force.force_n, felt.force_n);
    put(force.torque_n_m, felt.torque_n_m);
    force.depth_m = felt.depth_m;
    force.height_m = felt.height_m;
    force.contacts = felt.contacts;
    force.faults = felt.faults;
    return force;
}

void haptel_between_ticks(haptel_renderer* renderer)
{
    if (renderer) renderer->renderer.between_ticks();
}

void haptel_renderer_free(haptel_renderer* renderer)
{
    delete renderer;
}
