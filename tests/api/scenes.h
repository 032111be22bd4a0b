// Scenes of the tests of the public interface.
#pragma once

#include <haptel/haptel.h>

#include <string>

namespace haptel::test {

inline const Material frictionless = {
    .stiffness_n_per_m = 500, .damping_n_s_per_m = 0, .static_friction = 0, .dynamic_friction = 0};

// A table without a texture, its top at z = 0.
inline Scene table(const Material& material = frictionless, const SceneSettings& settings = {.force_rise_s = 0})
{
    SceneBuilder build;
    build.add(plane(0.2), material);
    return build.finish(settings);
}

inline bool contains(const std::string& text, const std::string& part)
{
    return text.find(part) != std::string::npos;
}

} // namespace haptel::test
