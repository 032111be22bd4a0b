#include "runtime/files/open_hands.h"

#include "runtime/hand/fewer_axes.h"
#include "runtime/surface/surface.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <string>
#include <utility>

namespace haptel::runtime {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// First hit of a line along the hand's -z, raised by the radius of a probe that lies there. The hand's space.
std::optional<SurfaceHit> surface_below(const SceneObject& object, const Workspace& workspace,
                                        const glm::dvec3& above_m, const glm::dvec3& below_m, double radius_m)
{
    const Placement& placement = object.placement;
    const auto hit = object.surface->first_hit(placement.to_object(workspace.to_scene(above_m)),
                                               placement.to_object(workspace.to_scene(below_m)));
    if (!hit) return std::nullopt;
    const glm::dvec3 normal = placement.direction_to_world(hit->facet_normal);
    return SurfaceHit{workspace.to_hand(placement.to_world(hit->point_m) + radius_m * normal),
                      workspace.direction_to_hand(normal)};
}

// What the driver needs to know of the object that is explored, the first one, as its hand sees it.
void describe_object(DeviceText& device, const std::shared_ptr<const Scene>& scene)
{
    const SceneObject& object = scene->objects.front();
    const Workspace& workspace = device.hand.workspace;
    const ProbeSettings& probe = *device.hand.probe;
    DeviceRequest& request = device.request;
    request.rate_hz = scene->servo.rate_hz;
    request.stylus_length_m = probe.has_tail() ? probe.length_m / workspace.scale : 0;
    request.gripper = probe.kind == ProbeKind::gripper;
    request.box_minimum_m = glm::dvec3(infinity);
    request.box_maximum_m = glm::dvec3(-infinity);
    for (const glm::dvec3& vertex : object.surface->vertices) {
        const glm::dvec3 p = workspace.to_hand(object.placement.to_world(object.surface->lattice.metres(vertex)));
        request.box_minimum_m = glm::min(request.box_minimum_m, p);
        request.box_maximum_m = glm::max(request.box_maximum_m, p);
    }
    const glm::dvec3 sides = request.box_maximum_m - request.box_minimum_m;
    const double margin_m = 0.01 * std::max({sides.x, sides.y, sides.z});
    const double radius_m = probe.kind == ProbeKind::sphere ? probe.radius_m : 0;
    request.surface_below = [scene, workspace, radius_m, above_m = request.box_maximum_m.z + margin_m,
                             below_m = request.box_minimum_m.z - margin_m](double x_m, double y_m) {
        return surface_below(scene->objects.front(), workspace, {x_m, y_m, above_m}, {x_m, y_m, below_m}, radius_m);
    };
}

// What a device holds still grows with the rate. Its figure is a recommendation: what it holds depends on the hand,
// too, and twice as much is still taken without a word.
void warn_of_stiffness(const DeviceInfo& info, const Scene& scene, std::span<const toml::source_region> stiffness_at,
                       FileMessages& messages)
{
    const double recommended_n_per_m = info.stiffness_max_n_per_m * scene.servo.rate_hz / 1000;
    if (recommended_n_per_m <= 0) return; // not known
    for (std::size_t i = 0; i < scene.objects.size(); ++i)
        if (const double stiffness_n_per_m = scene.objects[i].material.stiffness_n_per_m;
            stiffness_n_per_m > 2 * recommended_n_per_m)
            messages.warning(stiffness_at[i], "`" + scene.objects[i].name + "` has a stiffness of " +
                                                  shortest(stiffness_n_per_m) + " N/m, but `" + info.name +
                                                  "` is made for up to " + shortest(recommended_n_per_m) + " N/m at " +
                                                  shortest(scene.servo.rate_hz) +
                                                  " Hz: a touch may hum or kick. Lower `stiffness_n_per_m`, or raise "
                                                  "`rate_hz`");
}

// What pushes back is limited: a hand that presses harder is never held.
void warn_of_press(const DeviceInfo& info, const Scene& scene, const toml::source_region& press_at,
                   FileMessages& messages)
{
    const bool by_device = info.force_max_n > 0 && info.force_max_n <= scene.servo.force_limit_n;
    const double most_n = by_device ? info.force_max_n : scene.servo.force_limit_n;
    if (info.press_n <= most_n) return;
    messages.warning(press_at, "`press_n` is " + shortest(info.press_n) + " N, but at most " + shortest(most_n) +
                                   " N push back, " +
                                   (by_device ? "all that `" + info.name + "` can hold" : "the `force_limit_n`") +
                                   ": the hand sinks in, and the force stays at that limit. Lower `press_n`" +
                                   (by_device ? "" : ", or raise `force_limit_n`"));
}

// What the device lacks is held by an imagined finger; without the normal that feels the slopes alone.
void complete(LoadedHand& hand, const DeviceText& device, const Scene& scene, FileMessages& messages)
{
    const DeviceInfo& info = hand.device->info();
    if (info.axes.all()) {
        hand.settings.slopes_only = info.slopes_only;
        return;
    }
    if (device.request.gripper)
        messages.error(device.where(DeviceKey::stylus_length),
                       "`" + info.name +
                           "` has too few axes for a gripper: write `kind = \"point\"`, `\"sphere\"` or "
                           "`\"stylus\"` under [probe]");
    // newtons per metre of the hand's way, as all stiffnesses are
    const double press_depth_m = device.request.press_n / scene.objects.front().material.stiffness_n_per_m;
    hand.device = std::make_unique<FewerAxes>(std::move(hand.device), device.request.surface_below, press_depth_m,
                                              scene.servo.rate_hz);
    hand.settings.slopes_only = hand.device->info().slopes_only;
}

} // namespace

std::vector<LoadedHand> open_hands(std::vector<DeviceText>& texts, const std::shared_ptr<const Scene>& scene,
                                   std::span<const toml::source_region> stiffness_at, const DeviceFactory& devices,
                                   FileMessages& messages)
{
    std::vector<LoadedHand> hands;
    for (DeviceText& device : texts) {
        if (!devices) break;
        describe_object(device, scene);
        DeviceResult opened = devices(device.request);
        const std::string name = "device `" + device.request.name + "`: ";
        if (!opened.device) {
            messages.error(device.where(opened.about), name + opened.error);
            continue;
        }
        if (!opened.warning.empty()) messages.warning(device.where(opened.about), name + opened.warning);
        device.hand.force_max_n = opened.device->info().force_max_n;
        warn_of_press(opened.device->info(), *scene, device.where(DeviceKey::press), messages);
        warn_of_stiffness(opened.device->info(), *scene, stiffness_at, messages);
        hands.push_back({std::move(opened.device), std::move(device.hand)});
        complete(hands.back(), device, *scene, messages);
    }
    return hands;
}

} // namespace haptel::runtime
