// Libraries put in place and taken away, each in one step: whoever looks meanwhile, or whatever ends the process, finds
// all of a library or nothing. Nothing of it is run.
#pragma once

#include "libraries/package/package.h"
#include "libraries/places.h"

#include <filesystem>
#include <string>
#include <vector>

namespace haptel::libraries {

struct Installation {
    std::filesystem::path folder; // of the library; empty: nothing is written, and `why` says why
    bool was_there = false;       // the same, to the byte
    std::string why;
};

// As ROOT/NAME/VERSION. Refused where that version stands there with other files.
Installation install(const Package& package, const std::filesystem::path& root);

// Why not; empty: it is gone.
std::string remove(const Installed& library);

// Adds to the lock of a project, which is made where there is none, or takes away; why not, or empty.
std::string lock(const std::filesystem::path& project, const Package& package);
std::string unlock(const std::filesystem::path& project, const Installed& library);

// A library that it needs and that is not to be found in these places, in words; empty: all are there.
std::string missing_dependency(const Manifest& manifest, const std::vector<Place>& places);

} // namespace haptel::libraries
