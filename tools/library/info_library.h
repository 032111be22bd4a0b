// haptel info LIBRARY: what a library says of itself, and its textures with the first sentence of each.
#pragma once

#include "tools/output/exit_code.h"

#include <string>

namespace haptel::tools {

// An archive, a folder with a library.toml, or the name of a library that is installed where this folder finds it.
bool names_library(const std::string& what);

ExitCode show_library(const std::string& what, bool json);

} // namespace haptel::tools
