#include "libraries/places.h"

#include "libraries/lock.h"
#include "libraries/manifest.h"

#include <algorithm>
#include <cstdlib>

namespace haptel::libraries {

namespace fs = std::filesystem;

namespace {

constexpr const char* system_folders[] = {"/usr/local/share/haptel/libraries", "/usr/share/haptel/libraries"};
constexpr std::size_t entries_max = 10'000; // of a folder: more are nobody's libraries

std::string environment(const char* name)
{
    const char* const found = std::getenv(name);
    return found ? found : "";
}

fs::path whole(const fs::path& folder)
{
    std::error_code fault;
    const fs::path absolute = fs::absolute(folder.empty() ? "." : folder, fault);
    return absolute.lexically_normal();
}

// This folder and those above it, nearest first.
std::vector<fs::path> upward(const fs::path& folder)
{
    std::vector<fs::path> folders;
    for (fs::path at = whole(folder);; at = at.parent_path()) {
        if (at.has_filename() || at == at.root_path()) folders.push_back(at);
        if (at == at.parent_path()) return folders;
    }
}

bool holds(const fs::path& folder, const char* name)
{
    std::error_code fault;
    return fs::exists(folder / name, fault);
}

std::vector<std::string> folders_in(const fs::path& folder)
{
    std::vector<std::string> names;
    std::error_code fault;
    for (fs::directory_iterator entry(folder, fault), end; !fault && entry != end && names.size() < entries_max;
         entry.increment(fault)) {
        std::error_code gone;
        if (entry->is_directory(gone)) names.push_back(entry->path().filename());
    }
    return names;
}

} // namespace

fs::path user_folder()
{
    // A relative path would be another folder for every working directory.
    if (const fs::path data = environment("XDG_DATA_HOME"); data.is_absolute()) return data / "haptel" / "libraries";
    if (const fs::path home = environment("HOME"); home.is_absolute())
        return home / ".local" / "share" / "haptel" / "libraries";
    return {};
}

std::vector<Place> search_path(const fs::path& folder)
{
    std::vector<Place> places;
    for (const fs::path& at : upward(folder)) places.push_back({"project", at / project_folder_name});
    std::string listed = environment("HAPTEL_PATH");
    while (!listed.empty()) {
        const std::size_t colon = std::min(listed.find(':'), listed.size());
        if (colon > 0) places.push_back({"HAPTEL_PATH", whole(listed.substr(0, colon))});
        listed.erase(0, colon + 1);
    }
    if (const fs::path user = user_folder(); !user.empty()) places.push_back({"user", user});
    for (const char* const system : system_folders) places.push_back({"system", system});
    return places;
}

fs::path nearest_file(const fs::path& folder, const char* name)
{
    for (const fs::path& at : upward(folder))
        if (holds(at, name)) return at / name;
    return {};
}

fs::path project_of(const fs::path& folder)
{
    for (const fs::path& at : upward(folder))
        if (holds(at, lock_name) || holds(at, project_folder_name) || holds(at, manifest_name)) return at;
    return {};
}

std::vector<Installed> installed_in(const std::vector<Place>& places, std::string_view name)
{
    std::vector<Installed> all;
    for (const Place& place : places) {
        const std::vector<std::string> names = name.empty() ? folders_in(place.folder) : std::vector{std::string(name)};
        for (const std::string& one : names) {
            if (!is_library_name(one)) continue;
            for (const std::string& version : folders_in(place.folder / one))
                if (const std::optional<Version> parsed = parse_version(version))
                    all.push_back({one, *parsed, place.folder / one / version, place.kind});
        }
    }
    std::stable_sort(all.begin(), all.end(), [](const Installed& a, const Installed& b) {
        return a.name != b.name ? a.name < b.name : a.version > b.version;
    });
    return all;
}

} // namespace haptel::libraries
