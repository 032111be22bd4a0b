#include "tools/plot/plot_surface.h"

#include "runtime/texture/shading.h"
#include "runtime/texture/surface_texture.h"

namespace haptel::tools::plot {

using namespace runtime;

NormalBelow textured_normal_below(const std::shared_ptr<const Scene>& scene, const Workspace& workspace,
                                  double exaggeration)
{
    if (scene->objects.empty()) return {};
    const SceneObject& object = scene->objects.front();
    const Surface& surface = *object.surface;
    const glm::dvec3 low_m = surface.box_minimum_m;
    const glm::dvec3 high_m = surface.box_maximum_m;
    const glm::dvec3 middle_m = workspace.to_hand(object.placement.to_world((low_m + high_m) / 2.0));
    const double reach_m = glm::length(high_m - low_m) / workspace.scale; // from its middle, in every direction

    // A reader leaves its slot when it goes: the slot stays as long.
    const std::shared_ptr<TextureReader> reader(new TextureReader(*object.texture),
                                                [slot = object.texture](TextureReader* one) { delete one; });

    return [scene, workspace, exaggeration, middle_m, reach_m, reader](double x_m,
                                                                       double y_m) -> std::optional<glm::dvec3> {
        const SceneObject& seen = scene->objects.front();
        const auto to_object = [&](double z_m) {
            return seen.placement.to_object(workspace.to_scene({x_m, y_m, z_m}));
        };
        const auto hit = seen.surface->first_hit(to_object(middle_m.z + reach_m), to_object(middle_m.z - reach_m));
        if (!hit) return std::nullopt;
        const SurfacePoint at{hit->point_m, shade(*seen.surface, hit->face, hit->side, hit->barycentric), 0};
        const glm::dvec3 bent =
            at.shading.normal -
            exaggeration * tangential(sample_texture(reader->to().binding, at).gradient, at.shading.normal);
        return glm::normalize(workspace.direction_to_hand(seen.placement.direction_to_world(bent)));
    };
}

} // namespace haptel::tools::plot
