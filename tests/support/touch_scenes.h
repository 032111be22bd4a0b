// Scenes and hands that several tests of the runtime touch.
#pragma once

#include "lang/abi/texture_binding.h"
#include "runtime/scene/scene.h"
#include "runtime/surface/shapes.h"

#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <utility>

namespace haptel::tests {

inline constexpr double spring_n_per_m = 1000; // the stiffness of bare_scene

// One object, no friction, no damping, no rise at the start: what is left is the static force.
inline runtime::Scene bare_scene(const runtime::Mesh& mesh, TextureBinding texture = {})
{
    runtime::Scene scene;
    runtime::SceneObject object;
    object.name = "test object";
    object.surface = runtime::build_surface(mesh).surface;
    object.material.stiffness_n_per_m = spring_n_per_m;
    object.material.damping_n_s_per_m = 0;
    object.material.static_friction = object.material.dynamic_friction = 0;
    object.texture = std::make_shared<runtime::TextureSlot>(std::move(texture));
    scene.objects.push_back(std::move(object));
    scene.servo.force_rise_s = 0;
    scene.servo.force_limit_n = 100;
    return scene;
}

// A built-in shape whose largest side is that long.
inline runtime::Mesh shape(const char* name, double size_m)
{
    runtime::Mesh mesh = *runtime::make_shape(name);
    runtime::scale_to_size(mesh, size_m);
    return mesh;
}

// 20 * 4^subdivisions triangles, of that diameter.
inline runtime::Mesh ball_mesh(uint32_t subdivisions, double size_m)
{
    runtime::Mesh mesh = runtime::make_icosphere(subdivisions);
    runtime::scale_to_size(mesh, size_m);
    return mesh;
}

inline runtime::Scene magnet_scene(const runtime::Mesh& mesh, double force_n, double reach_m)
{
    runtime::Scene scene = bare_scene(mesh);
    scene.objects[0].effects.magnet = {force_n, reach_m};
    return scene;
}

// The plane z = 0 with the given side, metres.
inline runtime::Mesh plane_mesh(double side_m = 0.1, uint32_t cells = 1)
{
    runtime::Mesh mesh = runtime::make_plane(cells);
    runtime::scale_to_size(mesh, side_m);
    return mesh;
}

inline std::shared_ptr<const runtime::Scene> shared(runtime::Scene scene)
{
    return std::make_shared<const runtime::Scene>(std::move(scene));
}

inline runtime::DevicePose at(double x, double y, double z)
{
    return {{x, y, z}, {x, y, z}};
}

inline double degrees_between(const glm::dvec3& a, const glm::dvec3& b)
{
    return glm::degrees(std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)));
}

// A device whose hand follows a function of the tick; what is written is kept for the test to see.
class ScriptedDevice : public runtime::HapticDevice {
public:
    using Read = std::function<runtime::DeviceStatus(uint64_t tick, runtime::DevicePose&)>;

    struct Seen {
        uint64_t writes = 0;
        bool stopped = false;
        glm::dvec3 last_force_n{0};
        std::string state; // what the device says of itself
    };

    explicit ScriptedDevice(Read read, std::shared_ptr<Seen> seen = std::make_shared<Seen>())
        : read_(std::move(read)), seen_(std::move(seen))
    {
        info_.name = "scripted";
    }

    const runtime::DeviceInfo& info() const override { return info_; }
    runtime::DeviceStatus read(runtime::DevicePose& pose) noexcept override { return read_(tick_++, pose); }
    runtime::DeviceStatus write(const glm::dvec3& force_n, const glm::dvec3&) noexcept override
    {
        ++seen_->writes;
        seen_->last_force_n = force_n;
        return runtime::DeviceStatus::ok;
    }
    std::string state() const override { return seen_->state; }
    void stop() noexcept override { seen_->stopped = true; }

private:
    runtime::DeviceInfo info_;
    Read read_;
    std::shared_ptr<Seen> seen_;
    uint64_t tick_ = 0;
};

} // namespace haptel::tests
