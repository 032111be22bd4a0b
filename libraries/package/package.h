// A library as a whole, in memory: its files with their manifest, checked against every rule of contents.h. From a
// folder that its author works in, or an archive that came from anywhere (archive.h).
#pragma once

#include "libraries/contents.h"
#include "libraries/manifest.h"

#include <filesystem>
#include <optional>
#include <string>

namespace haptel::libraries {

struct Package {
    Manifest manifest;
    Contents contents; // with the file of sums
};

// Or messages, a line each: "wood/library.toml:3:1: error: ...".
struct PackageResult {
    std::optional<Package> package;
    std::string messages;
};

// Of files without their sums, which it makes. `name` stands before what is said of them.
PackageResult make_package(Contents contents, const std::string& name);

// Of an author's folder: hidden files and archives in it are passed over, anything else that is no file of a library is
// refused, links among it.
PackageResult read_folder(const std::filesystem::path& folder);

// "wood 1.2.0"
std::string to_text(const Manifest& manifest);

} // namespace haptel::libraries
