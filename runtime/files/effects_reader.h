// The parts of a scene file that say what is felt beside contact.
#pragma once

#include "runtime/files/table_reader.h"
#include "runtime/force/effects.h"
#include "runtime/geometry/placement.h"

#include <vector>

namespace haptel::runtime {

// `position_m` and `rotation_deg`, of objects and regions alike.
Placement read_placement(TableReader& table);

// Of one `[[object]]`: `magnet`, `viscosity`, `vibration`.
ObjectEffects read_object_effects(TableReader& object, double rate_hz, FileMessages& messages);

// Where the `reach_m` is written of the effect that reaches farthest; the object where there is none.
const toml::source_region& farthest_reach_at(const toml::table& object, const ObjectEffects& effects);

// All of `[[region]]`.
std::vector<Region> read_regions(const toml::table& root, double rate_hz, FileMessages& messages);

} // namespace haptel::runtime
