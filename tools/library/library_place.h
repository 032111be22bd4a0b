// Where a command puts libraries, and takes them from: --user or --project; and which one an argument names.
#pragma once

#include <CLI/CLI.hpp>

#include <filesystem>
#include <string>

namespace haptel::tools {

struct PlaceOptions {
    bool user = false, project = false; // neither: of the user
};
void add_place(CLI::App& app, PlaceOptions& place);

struct LibraryPlace {
    std::filesystem::path folder;  // of the libraries; empty: there is none, see no_place
    std::filesystem::path project; // that the working directory belongs to, or may become
    bool is_project = false;
};
inline constexpr const char* no_place = "there is no HOME where libraries could be: give --project";
LibraryPlace library_place(const PlaceOptions& options);

// A folder with a library.toml, or the name of an installed library: its folder, of the highest version. Empty: none.
std::filesystem::path library_named(const std::string& what);

} // namespace haptel::tools
