// From the name of a library's file, "wood.oak", to a path: what an import, a scene and a command line ask.
//
// Of several versions the highest counts that the asking file's surroundings allow: the dependencies of the library
// that it belongs to, and the lock of its project. Each file is asked for anew, so that two majors of one library stand
// side by side where two libraries want them. Nothing is remembered between calls.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace haptel::libraries {

struct FoundFile {
    std::filesystem::path file; // empty: none
    std::string why, hint;      // "library wood is not installed"; what to do
};

// `name` as in lang/abi/library_name.h; `folder` is the asking file's.
FoundFile find_file(std::string_view name, const std::filesystem::path& folder);

// What stands where a path may: a path as it is, the name of a library's file as that file's path. A name that finds
// nothing stays, so that whoever opens it can say why.
std::string path_named(std::string_view path_or_name, const std::filesystem::path& folder = {});

} // namespace haptel::libraries
