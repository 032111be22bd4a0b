// A picture of one compiled texture, over a square of a plane.
#pragma once

#include "jit/texture/texture.h"
#include "tools/arguments/texture_argument.h"
#include "tools/plot/plot_picture.h"

#include <glm/glm.hpp>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

namespace haptel::tools {

struct PictureOptions {
    TextureArgument texture;
    ParameterTexts parameters;
    std::string kind = "shaded"; // of plot::texture_kinds()
    double window_m = 0.02, footprint_m = 0;
    glm::dvec3 center_m{0};
    std::optional<std::pair<glm::dvec3, glm::dvec3>> section_m; // its ends
    std::optional<glm::dvec3> direction;                        // of the section, of length 1
    int size_px = 512;
};

// What a program has to be compiled with for it.
jit::TextureOptions compile_options(const PictureOptions& options);

// Nothing where the texture cannot be bound: `say` hears why, and whatever else there is to say.
std::optional<plot::Picture> draw_texture(const std::shared_ptr<const jit::CompiledProgram>& program,
                                          const PictureOptions& options,
                                          const std::function<void(const std::string&)>& say);

} // namespace haptel::tools
