// Files of the project that tests read.
#pragma once

#include <string>

namespace haptel::test {

// Of a file or folder that is named from the project's root.
std::string project_path(const std::string& name);

} // namespace haptel::test
