#include "runtime/files/object_texture.h"

#include "lang/abi/library_name.h"
#include "runtime/surface/surface.h"
#include "runtime/texture/shading.h"

#include <algorithm>
#include <array>
#include <sstream>

namespace haptel::runtime {

namespace {

// A mesh of which only parts have coordinates has 0 at the corners of the others.
std::size_t faces_without_uv(const Surface& surface)
{
    if (surface.uv.empty()) return surface.faces.size();
    const auto none = [&](const std::array<uint32_t, 3>& of) {
        return std::all_of(of.begin(), of.end(), [&](uint32_t corner) { return surface.uv[corner] == glm::dvec2(0); });
    };
    return static_cast<std::size_t>(std::count_if(surface.uv_of.begin(), surface.uv_of.end(), none));
}

TextureRequest request_of(const SceneObject& object, const HandLimits& hands)
{
    const Surface& surface = *object.surface;
    TextureRequest request;
    for (int i = 0; i < 3; ++i) {
        request.box_minimum_m[i] = surface.box_minimum_m[i];
        request.box_maximum_m[i] = surface.box_maximum_m[i];
    }
    const glm::dvec3 farthest = glm::max(glm::abs(surface.box_minimum_m), glm::abs(surface.box_maximum_m));
    double speed_m_per_s = hands.speed_max_m_per_s;
    if (object.motion) speed_m_per_s += object.motion->speed_max_m_per_s(glm::length(farthest));
    request.footprint_m = 2 * speed_m_per_s / hands.rate_hz;
    request.normal_turn_max_per_m = surface.normal_turn_max_per_m;
    request.uv = uv_figures(surface);
    request.servo_period_s = 1 / hands.rate_hz;
    return request;
}

// The bounds count and not the heights that occur: from the upper one on the hand sinks in before it is held.
std::string warning_of_depth(const haptel_facts& facts, const SceneObject& object)
{
    glm::dvec3 sides_m = object.surface->box_maximum_m - object.surface->box_minimum_m;
    std::sort(&sides_m[0], &sides_m[0] + 3);
    const double depth_m = facts.height_max_m - facts.height_min_m, width_m = sides_m[1];
    if (depth_m <= width_m / 2) return {};
    std::ostringstream text;
    text.precision(3);
    text
        << "has heights from " << facts.height_min_m << " to " << facts.height_max_m << " m, " << depth_m
        << " m deep, but `" << object.name << "` is only " << width_m
        << " m wide: a hand may sink in that far. Is a unit wrong (`depth = \"60um\"` of its `parameters`, `size_m` of "
           "the object)? If not, bound the height with clamp()";
    return text.str();
}

// Of a texture that can be felt, but hardly as it is meant.
void warn_of_texture(const TextureBinding& binding, const TextureText& text, const SceneObject& object,
                     FileMessages& messages)
{
    if (!binding.texture) return; // flat
    const Surface& surface = *object.surface;
    const std::size_t undrawn = !(binding.texture->reads & HAPTEL_READS_UV) ? 0 : faces_without_uv(surface);
    if (undrawn > 0)
        messages.warning(text.at, "texture `" + text.reference + "` reads `uv`, but `" + object.name +
                                      "` has no coordinates" +
                                      (undrawn < surface.faces.size() ? " on some of its faces" : "") +
                                      ": there `uv` is 0, and it is felt as flat. Give the mesh "
                                      "coordinates, or map `p` in the texture (`sphere_map`, `triplanar`)");
    if (const std::string warning = warning_of_depth(binding.facts, object); !warning.empty())
        messages.warning(text.at, "texture `" + text.reference + "` " + warning);
}

} // namespace

TextureText read_texture(TableReader& object, FileMessages& messages)
{
    TextureText text;
    object.text("texture", text.reference);
    text.at = object.where("texture");
    text.parameters = object.values_as_written("parameters");
    if (!text.parameters.empty() && text.reference.empty() && !object.has("texture"))
        messages.error(object.where("parameters"), "`parameters` belong to a `texture`, but this object has none");
    return text;
}

void load_texture(SceneObject& object, const TextureText& text, const HandLimits& hands,
                  const std::filesystem::path& folder, const TextureResolver& textures, FileMessages& messages)
{
    if (text.reference.empty() || !textures) return;
    std::string reference = text.reference;
    if (names_library_file(reference)) reference.append(":").append(texture_called_like(text.reference));
    const std::size_t colon = reference.rfind(':');
    if (colon == std::string::npos || colon == 0 || colon + 1 == reference.size()) {
        messages.error(text.at,
                       "expected a file, a colon and the name of a texture in it, such as "
                       "\"rock.haptel:rock\", or a file of an installed library, such as \"wood.oak\", found \"" +
                           reference + "\"");
        return;
    }
    TextureRequest request = request_of(object, hands);
    const std::string file = reference.substr(0, colon);
    request.reference =
        names_library_file(file) // which the resolver knows where to find
            ? reference
            : std::filesystem::absolute(folder / file).lexically_normal().string() + reference.substr(colon);
    request.parameters = text.parameters;
    request.folder = std::filesystem::absolute(folder).lexically_normal().string();

    TextureResult result = textures(request);
    const std::string fault = result.binding ? binding_fault(*result.binding) : "";
    if (!result.binding || !fault.empty()) {
        messages.error(text.at,
                       "texture `" + text.reference + "` cannot be used" + (fault.empty() ? "" : ": " + fault));
    } else {
        warn_of_texture(*result.binding, text, object, messages);
        object.texture = std::make_shared<TextureSlot>(std::move(*result.binding));
    }
    messages.add(result.diagnostics);
    object.request = std::move(request);
}

} // namespace haptel::runtime
