// How far the inputs reach that tell of the contact itself: who fills a haptel_point keeps them within, and bounds of
// what reads them rest on that.
#pragma once

namespace haptel {

// No hand is faster, and no device stronger; what is measured beyond is an encoder's mistake.
inline constexpr double contact_speed_max_m_per_s = 10;
inline constexpr double normal_force_max_n = 1000;
// Of a tool in a hand, and of a surface that such a tool could feel to be bent.
inline constexpr double tool_radius_max_m = 1;
inline constexpr double curvature_max_per_m = 1e6;

} // namespace haptel
