// Pictures of one texture over a square of the plane z = const, seen from +z.
#pragma once

#include "lang/abi/abi.h"
#include "tools/plot/plot_picture.h"

#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

namespace haptel::tools::plot {

struct TextureView {
    std::string title;                                       // "rock.haptel:rock"
    std::function<haptel_point(const glm::dvec3&)> on_plane; // a point of the plane that is drawn, metres
    std::function<void(std::span<const haptel_point>, std::span<haptel_sample>)> samples; // any thread
    std::function<glm::dvec3(const glm::dvec3&)> true_gradient; // by an oracle; for gradient-error alone
    glm::dvec3 center_m{0};
    double window_m = 0.02;                                     // side of the square
    int size_px = 512;                                          // of the picture, each way
    bool is_bounded = true;                                     // the height is: else colours leave poles out
    std::optional<std::pair<glm::dvec3, glm::dvec3>> section_m; // its ends; none: along x, all of the window
    std::function<void(const std::string&)> say;                // what a picture cannot show; may be empty
};

struct TextureKind {
    std::string_view name;
    std::string_view shows;
    Picture (*draw)(const TextureView&);
};

// height:         colours for metres
// shaded:         relief lit from the upper left, from the exact gradient
// relief:         the same from edge to edge, without axes and words
// ball:           the texture on a ball as wide as the window, for what asks for its object or its normal
// cylinder:       the same on an upright cylinder
// section:        height and slope along a line
// spectrum:       amplitude against wavelength, along x and along y
// gradient-error: log10 of |g - g_oracle| / max |g_oracle|
std::span<const TextureKind> texture_kinds();

} // namespace haptel::tools::plot
