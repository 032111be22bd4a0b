// Presets, "texture oak = wood(depth = 40um);": textures that call another one with all of its parameters, some of
// which have other defaults.
#pragma once

#include "lang/program/checked_program.h"
#include "lang/text/diagnostic.h"

namespace haptel::lang {

// Adds each file's presets to its textures, in their places: of textures of this file, of its imports, and of presets
// further up.
void add_presets(std::vector<CheckFile>& files, Diagnostics& diagnostics);

} // namespace haptel::lang
