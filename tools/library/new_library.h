// The files of a first library, which haptel pack packs as they are.
#pragma once

#include "libraries/contents.h"

#include <string>

namespace haptel::tools {

libraries::Contents new_library(const std::string& name);

} // namespace haptel::tools
