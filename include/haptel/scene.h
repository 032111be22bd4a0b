// What there is to touch. A scene that a program builds is held to the same rules, and is told of faults in the same
// words, as one from a scene file (docs/scenes.md).
#pragma once

#include <haptel/mesh.h>
#include <haptel/texture.h>

#include <memory>
#include <string>
#include <vector>

namespace haptel {

// What an object is made of, apart from its texture.
struct Material {
    double stiffness_n_per_m = 800; // > 0, per metre of the hand's way
    double damping_n_s_per_m = 1;   // >= 0, along the normal
    double static_friction = 0.3;   // >= dynamic_friction: largest sideways over normal force that sticks
    double dynamic_friction = 0.2;  // >= 0: the same while sliding
};

// Where an object stands in the world.
struct Placement {
    Vec3 position_m = {};   // of its origin
    Vec3 rotation_deg = {}; // about x, then y, then z
};

// What touches: a point, a ball, a line from tip to tail that has torque, or two fingers.
enum class ProbeKind { point, sphere, stylus, gripper };

// What the hand holds.
struct Probe {
    ProbeKind kind = ProbeKind::point; // and so which of these counts
    double length_m = 0.15;            // of a stylus, from tip to tail
    double radius_m = 0;               // of a sphere
};

// How height and gradient become a force.
enum class ForceModel { displaced, paper, paper_unit, ho99, lateral }; // docs/forces.md

// What holds for all objects of a scene.
struct SceneSettings {
    double rate_hz = 1000;                          // ticks per second, > 0
    double force_limit_n = 7;                       // > 0: a larger force is scaled down to it
    double v_max_m_per_s = 0.3;                     // hand speed that textures are band-limited for
    double force_rise_s = 0.1;                      // after start and interruptions
    ForceModel force_model = ForceModel::displaced; // of all objects
    Probe probe = {};                               // of each hand
};

class SceneBuilder;

// One object of a scene, before and after it is built. Cheap to copy; all copies are the same object.
class HAPTEL_API Object {
public:
    // Before the scene is built: "FILE.haptel:NAME", "wood.oak" or "wood.oak:board" of an installed library, or
    // "precompiled:NAME", and values of its parameters.
    Object& texture(std::string reference, Parameters parameters = {});
    Object& place(const Placement& placement); // at the origin, if it is not called
    Object& apart(); // with a seam where it meets others; otherwise objects that meet are felt as one

    // Of the texture, while it is felt: the next tick fades to the new value. Nothing is compiled, nor read from files
    // but pictures. Returns why not, or nothing. Any thread but a servo's.
    std::string set(const std::string& parameter, const std::string& value);

    struct State;
    // By SceneBuilder.
    explicit Object(std::shared_ptr<State> state) : state_(std::move(state)) {}

private:
    friend class SceneBuilder;
    std::shared_ptr<State> state_;
};

// Immutable, and shared by all that feel it. Cheap to copy.
class HAPTEL_API Scene {
public:
    explicit operator bool() const; // false: messages() says why
    // Errors, warnings and notes, a line each: "object 1: warning: ...", or with file, line and column.
    const std::string& messages() const;
    std::vector<Object> objects() const; // in the order in which they were added; none of a refused scene

    struct State;
    // By SceneBuilder and load_scene.
    explicit Scene(std::shared_ptr<const State> state) : state_(std::move(state)) {}
    const State& state() const { return *state_; }                // for servos and renderers
    std::shared_ptr<const State> share() const { return state_; } // likewise

private:
    std::shared_ptr<const State> state_; // never null
};

// Collects objects and makes a scene of them.
class HAPTEL_API SceneBuilder {
public:
    explicit SceneBuilder(TextureSource textures = {}); // where objects get their textures
    ~SceneBuilder();
    SceneBuilder(SceneBuilder&&) noexcept;
    SceneBuilder& operator=(SceneBuilder&&) noexcept;

    // A mesh, with its origin where it is placed. Faults of it are told by finish().
    Object add(Mesh mesh, const Material& material = {});
    // A mesh file; scaled until its largest side has that size, at most 1 km; 0: as it is.
    Object add_file(std::string file, double size_m = 0, const Material& material = {});

    // Builds all surfaces and textures. Once.
    Scene finish(const SceneSettings& settings = {});

private:
    struct State;
    std::unique_ptr<State> state_;
};

// From a scene file. Its devices are left to the program.
HAPTEL_API Scene load_scene(const std::string& file, TextureSource textures = {});

} // namespace haptel
