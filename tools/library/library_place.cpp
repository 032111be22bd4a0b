#include "tools/library/library_place.h"

#include "libraries/manifest.h"
#include "libraries/places.h"

namespace haptel::tools {

namespace fs = std::filesystem;

void add_place(CLI::App& app, PlaceOptions& place)
{
    auto* const user = app.add_flag("--user", place.user, "For you, in $XDG_DATA_HOME/haptel/libraries; as without it");
    app.add_flag("--project", place.project,
                 "For the project around the working directory, in its haptel_libraries; haptel.lock keeps the version")
        ->excludes(user);
}

LibraryPlace library_place(const PlaceOptions& options)
{
    std::error_code fault;
    const fs::path here = fs::current_path(fault), known = libraries::project_of(here);
    LibraryPlace place{libraries::user_folder(), known.empty() ? here : known, options.project};
    if (place.is_project) place.folder = place.project / libraries::project_folder_name;
    return place;
}

fs::path library_named(const std::string& what)
{
    std::error_code fault;
    if (fs::exists(fs::path(what) / libraries::manifest_name, fault)) return what;
    if (!libraries::is_library_name(what)) return {};
    const std::vector<libraries::Installed> installed =
        installed_in(libraries::search_path(fs::current_path(fault)), what);
    return installed.empty() ? fs::path() : installed.front().folder;
}

} // namespace haptel::tools
