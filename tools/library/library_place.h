// Where a command puts libraries, and takes them from: --user or --project.
#pragma once

#include <CLI/CLI.hpp>

#include <filesystem>

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

} // namespace haptel::tools
