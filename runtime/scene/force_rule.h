// Which force model and which shading a scene asks for; force_model.h and foot.h have their equations.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace haptel::runtime {

enum class ForceModel : uint8_t { displaced, paper, paper_unit, ho99, lateral };

// In the order of ForceModel.
inline constexpr std::array<std::string_view, 5> force_model_names = {"displaced", "paper", "paper_unit", "ho99",
                                                                      "lateral"};

// How facets become round (runtime/force/foot.h): `smooth` has a potential, `paper` is equation (1) as published.
enum class ForceShading : uint8_t { smooth, paper };

// In the order of ForceShading.
inline constexpr std::array<std::string_view, 2> force_shading_names = {"smooth", "paper"};

// What a scene says about it.
struct ForceRule {
    ForceModel model = ForceModel::displaced;
    double lateral_depth_m = 1e-3; // l of `lateral`, > 0
    ForceShading shading = ForceShading::smooth;
};

} // namespace haptel::runtime
