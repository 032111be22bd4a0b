// Every kind of probe, as it comes down on a surface.
#pragma once

#include "runtime/contact/probe_contact.h"

#include <glm/glm.hpp>

#include <vector>

namespace haptel::test {

inline constexpr double ball_m = 2.5e-3; // the radius of a sphere

struct EachProbe {
    runtime::ProbeSettings settings;
    glm::dvec3 tail_off_m{0}; // of its tail from its tip
    double above_m = 0;       // of its tip, where it just touches
};
inline const std::vector<EachProbe> every_probe{{{runtime::ProbeKind::point}},
                                                {{runtime::ProbeKind::sphere, 0, ball_m}, {}, ball_m},
                                                {{runtime::ProbeKind::stylus, 0.06}, {0.02, 0.01, 0.0556}},
                                                {{runtime::ProbeKind::gripper, 0.03}, {0, 0.03, 0}}};

} // namespace haptel::test
