// A scene held to the forces that were recorded on it: how it feels may change only when somebody means it to.
#pragma once

#include "tools/replay/feel_report.h"

#include <string>

namespace haptel::tools {

// Rounding is the same on every machine (docs/realtime.md), but for what the C library computes: the sines by which
// objects are turned and vibrations swing may differ in their last bit, some 1e-17 m, which springs and friction make
// larger. This leaves room for that, and is a millionth of what a hand can tell. N, and N m of torques.
inline constexpr double feel_tolerance = 1e-9;

// Replays it on the scene that it names.
TestedFeel test_feel(const std::string& recording, double tolerance);

// Puts the forces as they are now in the place of those recorded, along the same path of the hand, and leaves out the
// columns that tell nothing. `said`: what became of it, a line. False: it could not be done, and is as it was.
bool update_feel(const std::string& recording, std::string& said);

} // namespace haptel::tools
