// Shared libraries, which need the system's linker.
#pragma once

#include <string>

namespace haptel::tools {

struct SharedLibrary {
    std::string bytes, error; // one of them is empty
};

// Of an object, by `cc` or what the environment's CC names, which must be for the object's processor. `name`: what the
// library is asked for by, libNAME.so.
SharedLibrary link_shared(const std::string& object, const std::string& name);

} // namespace haptel::tools
