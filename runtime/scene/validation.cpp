#include "runtime/scene/validation.h"

#include "runtime/surface/surface.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace haptel::runtime {

namespace {

std::string in_words(const Range& range)
{
    if (std::isinf(range.maximum)) return (range.above_minimum ? "more than " : "at least ") + shortest(range.minimum);
    return (range.above_minimum ? "above " : "from ") + shortest(range.minimum) +
           (range.above_minimum ? " up to " : " to ") + shortest(range.maximum);
}

constexpr double beyond_rounding = 1 + 1e-9;

// Reasons after this many are counted and not told: a program that builds many objects errs in all of them alike.
constexpr std::size_t most_told = 20;

// What is wrong with a whole scene, part by part.
class Findings {
public:
    std::string text() const
    {
        return count_ > most_told ? told_ + "\nand " + std::to_string(count_ - most_told) + " more" : told_;
    }

    // Of the parts that follow, "object 3 (`ball`): "; empty: of the scene.
    void part(std::string name) { part_ = std::move(name); }
    void add(const std::string& why)
    {
        if (++count_ > most_told) return;
        told_ += (told_.empty() ? "" : "\n") + (part_.empty() ? part_ : part_ + ": ") + why;
    }
    std::size_t count() const { return count_; }

    Broken broken()
    {
        return [this](std::string_view, const std::string& why) { add(why); };
    }
    RangeCheck ranges() { return RangeCheck(broken()); }

private:
    std::string part_, told_;
    std::size_t count_ = 0;
};

template <class Enum>
bool one_of(Enum value, Enum last)
{
    return static_cast<unsigned>(value) <= static_cast<unsigned>(last);
}

void validate(const Placement& placement, Findings& findings)
{
    placement_fields(placement, findings.ranges());
    if (const std::string fault = placement_fault(placement); !fault.empty() && finite(placement.position_m))
        findings.add(fault);
}

void validate(const Vibration& vibration, double rate_hz, Findings& findings)
{
    if (vibration.force_n == 0) return; // none
    const std::size_t before = findings.count();
    vibration_fields(vibration, findings.ranges());
    if (findings.count() > before) return;
    check_rounds("frequency_hz", vibration.frequency_hz, Rounds::swings, rate_hz, findings.broken());
    if (std::fabs(glm::length(vibration.direction) - 1) > orthonormal_within)
        findings.add("the `direction` of a vibration must be a unit vector, and is " +
                     shortest(glm::length(vibration.direction)) + " long");
}

void validate(const ProbeSettings& probe, Findings& findings)
{
    if (!one_of(probe.kind, ProbeKind::gripper)) return findings.add("unknown `kind`");
    const std::size_t before = findings.count();
    probe_fields(probe, findings.ranges());
    if (findings.count() == before) check_probe(probe, findings.broken());
}

void validate(const SceneObject& object, const Scene& scene, const ProbeSettings& probe, Findings& findings)
{
    const double rate_hz = scene.servo.rate_hz;
    if (!object.texture) findings.add("there is no slot for a texture: an object without one has an empty slot");
    if (!object.surface || object.surface->faces.empty()) {
        findings.add("there is no surface: build_surface() says why");
        return;
    }
    validate(object.placement, findings);
    if (object.motion) {
        if (const std::string fault = object.motion->fault(rate_hz); !fault.empty())
            findings.add(fault);
        else if (const auto start = object.motion->at(0); start && !placement_fault(*start).empty())
            findings.add("where its motion begins " + placement_fault(*start));
    }
    std::size_t before = findings.count();
    material_fields(object.material, findings.ranges());
    if (findings.count() == before) check_material(object.material, findings.broken());

    before = findings.count();
    const ObjectEffects& effects = object.effects;
    if (effects.magnet.force_n != 0) magnet_fields(effects.magnet, findings.ranges());
    if (effects.damping_n_s_per_m != 0) viscosity_fields(effects, findings.ranges());
    validate(effects.vibration, rate_hz, findings);
    if (effects.vibration.force_n != 0) vibration_reach_field(effects.vibration_reach_m, findings.ranges());
    if (findings.count() == before) check_effects_reach(object, findings.broken());
    check_probe_size(probe, object, findings.broken());
}

void validate(const Region& region, double rate_hz, Findings& findings)
{
    if (!one_of(region.shape, RegionShape::box)) return findings.add("unknown `shape`");
    validate(region.placement, findings);
    const std::size_t before = findings.count();
    if (region.shape != RegionShape::space)
        findings.ranges()("half_sides_m", region.half_sides_m, Quantity::length, region_size_m);
    region_fields(region, findings.ranges());
    if (findings.count() == before) check_edge(region, findings.broken());
    validate(region.vibration, rate_hz, findings);
}

std::string name_of(const char* what, std::size_t number, const std::string& name)
{
    return std::string(what) + " " + std::to_string(number + 1) + (name.empty() ? "" : " (`" + name + "`)");
}

void validate_joined(const Scene& scene, Findings& findings)
{
    std::vector<uint8_t> taken(scene.objects.size());
    for (std::size_t i = 0; i < scene.joined.size(); ++i) {
        const JoinedObjects& joined = scene.joined[i];
        findings.part(name_of("joined objects", i, ""));
        for (const uint32_t number : joined.objects) {
            if (number >= scene.objects.size())
                findings.add("there is no object " + std::to_string(uint64_t{number} + 1));
            else if (std::exchange(taken[number], 1))
                findings.add("object " + std::to_string(number + 1) + " is joined twice");
            else if (scene.objects[number].motion)
                findings.add("object " + std::to_string(number + 1) + " moves, and joined objects are at rest");
        }
        if (!joined.surface || joined.surface->faces.empty() || joined.objects.empty())
            findings.add("there is no surface: join() says why");
        else if (joined.surface->origins.size() != joined.surface->faces.size() ||
                 std::any_of(joined.surface->origins.begin(), joined.surface->origins.end(),
                             [&](const auto& origin) { return origin.part >= joined.objects.size(); }))
            findings.add("the surface does not say which of its faces are of which object: join() makes one that does");
    }
}

} // namespace

std::string shortest(double value)
{
    const double size = std::abs(value);
    const auto format =
        size == 0 || (size >= 1e-5 && size < 1e15) ? std::chars_format::fixed : std::chars_format::general;
    std::array<char, 64> text;
    return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value, format).ptr};
}

std::string out_of_range(std::string_view key, const Range& range, std::string_view found)
{
    return "`" + std::string(key) + "` must be " + in_words(range) + ", found " + std::string(found);
}

void RangeCheck::check(std::string_view key, const glm::dvec3& values, const Range& range) const
{
    for (int i = 0; i < 3; ++i)
        if (!range.holds(values[i])) return broken_(key, out_of_range(key, range, shortest(values[i])));
}

void check_probe(const ProbeSettings& probe, const Broken& broken)
{
    if (probe.grip_m && probe.kind != ProbeKind::stylus)
        broken("grip_m", "`grip_m` is for `kind = \"stylus\"` alone: leave it out");
    else if (probe.grip_m && *probe.grip_m > probe.length_m)
        broken("grip_m", "`grip_m` is measured from the tip, and may not be beyond the stylus's `length_m`");
    if (probe.kind == ProbeKind::sphere && probe.radius_m == 0)
        broken("radius_m", "a sphere needs a radius: write `radius_m = 0.005`, or `kind = \"point\"`");
    if (probe.kind != ProbeKind::sphere && probe.radius_m > 0)
        broken("radius_m", "`radius_m` is for `kind = \"sphere\"` alone: write that, or leave `radius_m` out");
}

void check_material(const Material& material, const Broken& broken)
{
    if (material.dynamic_friction > material.static_friction)
        broken("dynamic_friction", "`dynamic_friction` must not exceed `static_friction`: a surface that slides harder "
                                   "than it sticks chatters");
}

void check_edge(const Region& region, const Broken& broken)
{
    const glm::dvec3& half_m = region.half_sides_m;
    const double smallest_m = std::min({half_m.x, half_m.y, half_m.z});
    if (region.shape != RegionShape::space && smallest_m > 0 && region.edge_m > smallest_m)
        broken("edge_m", "`edge_m` must be at most " + shortest(smallest_m) +
                             ", half of the region's smallest side: beyond that its effects are nowhere felt in full");
}

// What reaches farther than the object is large is not looked for.
void check_probe_size(const ProbeSettings& probe, const SceneObject& object, const Broken& broken)
{
    if (probe.kind == ProbeKind::sphere && probe.radius_m > object.surface->largest_side_m() * beyond_rounding)
        broken("radius_m",
               "the probe's `radius_m` is larger than `" + object.name + "`: at most the largest side of its box");
}

void check_effects_reach(const SceneObject& object, const Broken& broken)
{
    if (object.effects.reach_m() > object.surface->largest_side_m() * beyond_rounding)
        broken("reach_m", "the `reach_m` of an effect is larger than `" + object.name +
                              "`: at most the largest side of its box; what is felt farther away is a `[[region]]`");
}

void check_rounds(std::string_view key, double value, Rounds rounds, double rate_hz, const Broken& broken)
{
    const bool turns = rounds == Rounds::turns;
    const double limit = turns ? 180 * rate_hz : rate_hz / 2;
    if (value < limit) return;
    broken(key, "`" + std::string(key) + "` must be below " + (turns ? "half a turn in a tick at" : "half of") +
                    " the servo's `rate_hz`, so below " + shortest(limit) + (turns ? " about all axes together" : "") +
                    ": at that rate faster " + (turns ? "turns" : "swings") +
                    " are felt as slower ones. Lower it, or raise `rate_hz`");
}

std::string validate(const Scene* scene, const HandSettings& hand)
{
    if (!scene) return "there is no scene";
    Findings findings;
    findings.part("servo");
    servo_fields(scene->servo, findings.ranges());
    if (!one_of(scene->servo.force.model, ForceModel::lateral)) findings.add("unknown `force_model`");
    if (!one_of(scene->servo.force.shading, ForceShading::paper)) findings.add("unknown `shading`");
    if (findings.count() > 0) return findings.text(); // the rate is what other figures are compared with

    findings.part("hand");
    findings.ranges()("force_max_n", hand.force_max_n, Quantity::force, {0, std::numeric_limits<double>::infinity()});
    workspace_fields(hand.workspace, findings.ranges());
    validate(hand.workspace.placement, findings);

    findings.part("probe");
    const ProbeSettings& probe = hand.probe ? *hand.probe : scene->probe;
    validate(probe, findings);
    for (std::size_t i = 0; i < scene->objects.size(); ++i) {
        findings.part(name_of("object", i, scene->objects[i].name));
        validate(scene->objects[i], *scene, probe, findings);
    }
    for (std::size_t i = 0; i < scene->regions.size(); ++i) {
        findings.part(name_of("region", i, ""));
        validate(scene->regions[i], scene->servo.rate_hz, findings);
    }
    validate_joined(*scene, findings);
    return findings.text();
}

} // namespace haptel::runtime
