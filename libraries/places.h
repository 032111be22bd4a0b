// Where libraries stand on disk: FOLDER/wood/1.2.0/library.toml, in folders of a project, of HAPTEL_PATH, of the user
// and of the system.
#pragma once

#include "libraries/version.h"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace haptel::libraries {

inline constexpr const char* project_folder_name = "haptel_libraries"; // beside what a project's files are

struct Place {
    std::string kind; // project, HAPTEL_PATH, user, system
    std::filesystem::path folder;
};

// For a file in `folder`, nearest first: haptel_libraries of that folder and of each above it, then the others. They
// need not exist.
std::vector<Place> search_path(const std::filesystem::path& folder);

// $XDG_DATA_HOME/haptel/libraries, else ~/.local/share/haptel/libraries; empty where there is no home.
std::filesystem::path user_folder();

// The nearest file of that name, in this folder or one above; empty: there is none.
std::filesystem::path nearest_file(const std::filesystem::path& folder, const char* name);

// The nearest folder, from this one up, that is a project's: with a haptel.lock, haptel_libraries or library.toml.
// Empty: there is none.
std::filesystem::path project_of(const std::filesystem::path& folder);

struct Installed {
    std::string name;
    Version version;
    std::filesystem::path folder; // of its library.toml
    std::string place;            // kind of the place
};

// What is installed there, of one name or, where that is empty, of all: by name, then the highest version first, then
// the nearest place.
std::vector<Installed> installed_in(const std::vector<Place>& places, std::string_view name = {});

} // namespace haptel::libraries
