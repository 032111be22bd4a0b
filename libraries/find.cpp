#include "libraries/find.h"

#include "input/regular_file.h"
#include "lang/abi/library_name.h"
#include "lang/text/near_name.h"
#include "libraries/contents.h"
#include "libraries/lock.h"
#include "libraries/manifest.h"
#include "libraries/places.h"
#include "libraries/sha256.h"

#include <algorithm>
#include <optional>
#include <vector>

namespace haptel::libraries {

namespace fs = std::filesystem;

namespace {

FoundFile none(std::string why, std::string hint)
{
    return {{}, std::move(why), std::move(hint)};
}

// Who asks, as far as it says which versions will do.
struct Asking {
    explicit Asking(const fs::path& folder)
    {
        if (const fs::path file = nearest_file(folder, manifest_name); !file.empty()) {
            ManifestFile read = read_manifest_file(file);
            manifest = std::move(read.manifest);
            fault = std::move(read.fault);
            home = file.parent_path();
        }
        lock_file = nearest_file(folder, lock_name);
        if (!fault.empty() || lock_file.empty()) return;
        LockFile read = read_lock_file(lock_file);
        locked = std::move(read.libraries);
        fault = std::move(read.fault);
    }

    std::optional<Manifest> manifest; // of the library that it belongs to
    fs::path home, lock_file;
    std::vector<Locked> locked;
    std::string fault; // one of these cannot be read

    const Dependency* dependency(std::string_view name) const
    {
        if (!manifest) return nullptr;
        const auto found = std::ranges::find(manifest->dependencies, name, &Dependency::name);
        return found == manifest->dependencies.end() ? nullptr : &*found;
    }
};

std::string versions_of(const std::vector<Installed>& all)
{
    std::string list;
    for (const Installed& one : all)
        list += (list.empty() ? "" : ", ") + to_text(one.version) + " in " +
                one.folder.parent_path().parent_path().string();
    return list;
}

FoundFile not_installed(const std::string& library, const std::vector<Place>& places)
{
    std::vector<std::string> known;
    for (const Installed& one : installed_in(places)) known.push_back(one.name);
    const std::string_view meant = near_name(library, {known.begin(), known.end()}).name;
    if (!meant.empty())
        return none("library '" + library + "' is not installed", "did you mean '" + std::string(meant) + "'?");
    std::string searched;
    bool is_first_project = true;
    for (const Place& place : places) { // of a project's folders the nearest stands for all
        if (place.kind == "project" && !std::exchange(is_first_project, false)) continue;
        searched += (searched.empty() ? "" : ", ") + place.folder.string();
    }
    return none("library '" + library + "' is not installed",
                "haptel install " + library + ".haptlib; it was looked for in " + searched);
}

// What the lock demands, where it names a version that would do; else the highest that would.
FoundFile choose(const std::string& library, const Asking& asking, const std::vector<Place>& places, Installed& chosen)
{
    const std::vector<Installed> all = installed_in(places, library);
    if (all.empty()) return not_installed(library, places);
    const Dependency* const wanted = asking.dependency(library);
    const auto serves = [&](const Version& version) { return !wanted || version.serves(wanted->least); };
    const Locked* locked = nullptr;
    for (const Locked& one : asking.locked)
        if (one.name == library && serves(one.version) && (!locked || one.version > locked->version)) locked = &one;
    const auto found = std::ranges::find_if(
        all, [&](const Installed& one) { return locked ? one.version == locked->version : serves(one.version); });
    if (found == all.end() && locked)
        return none(asking.lock_file.string() + " wants " + library + " " + to_text(locked->version) +
                        ", and there is " + versions_of(all),
                    "install that version, or have the lock written again: haptel install --project " + library +
                        ".haptlib");
    if (found == all.end())
        return none("library '" + asking.manifest->name + "' needs " + library + " " + to_text(wanted->least) +
                        " or one that can take its place, and there is " + versions_of(all),
                    "haptel install " + library + ".haptlib of such a version; several may be installed side by side");
    chosen = *found;
    if (locked && sha256(input::read_regular_file(chosen.folder / sums_name, sums_bytes_max).bytes) != locked->sha256)
        return none(
            chosen.folder.string() + " is not the " + library + " " + to_text(chosen.version) + " that " +
                asking.lock_file.string() + " wants",
            "its files differ: install the right one, or have the lock written again: haptel install --project " +
                library + ".haptlib");
    return {};
}

// Why the library in this folder cannot be used.
std::string fault_of(const Installed& library)
{
    const fs::path file = library.folder / manifest_name;
    const auto [manifest, fault] = read_manifest_file(file);
    if (!manifest) return fault;
    if (manifest->name != library.name || manifest->version != library.version)
        return file.string() + " is of " + manifest->name + " " + to_text(manifest->version);
    return why_too_new(*manifest);
}

std::vector<std::string> files_in(const fs::path& folder)
{
    std::vector<std::string> names;
    std::error_code fault;
    for (fs::directory_iterator entry(folder, fault), end; !fault && entry != end && names.size() < files_max;
         entry.increment(fault))
        if (entry->path().extension() == ".haptel") names.push_back(entry->path().stem());
    return names;
}

} // namespace

FoundFile find_file(std::string_view name, const fs::path& folder)
{
    const std::string library(name.substr(0, name.find('.')));
    const Asking asking(folder);
    if (!asking.fault.empty()) return none(asking.fault, "it says which versions of libraries are used here");
    fs::path home = asking.home;
    if (!asking.manifest || asking.manifest->name != library) { // else one's own library, wherever it stands
        if (asking.manifest && !asking.dependency(library))
            return none("library '" + library + "' is not among the dependencies of library '" + asking.manifest->name +
                            "'",
                        "add it to [dependencies] of " + (asking.home / manifest_name).string() + ": " + library +
                            " = \"1.0\", the least version that will do");
        Installed chosen;
        FoundFile refused = choose(library, asking, search_path(folder), chosen);
        if (!refused.why.empty()) return refused;
        if (const std::string fault = fault_of(chosen); !fault.empty())
            return none("library '" + library + "' " + to_text(chosen.version) + " cannot be used: " + fault,
                        "install it again, or another version of it");
        home = chosen.folder;
    }
    std::string path(name.substr(library.size() + 1));
    std::replace(path.begin(), path.end(), '.', '/');
    const fs::path file = home / (path + ".haptel");
    std::error_code fault;
    if (fs::exists(file, fault)) return {file, {}, {}};
    std::vector<std::string> there = files_in(file.parent_path());
    const std::string_view meant = near_name(file.stem().string(), {there.begin(), there.end()}).name;
    std::sort(there.begin(), there.end());
    std::string list;
    for (const std::string& one : there) list += (list.empty() ? "" : ", ") + one;
    return none("library '" + library + "' in " + home.string() + " has no file " + path + ".haptel",
                !meant.empty()  ? "did you mean '" + std::string(meant) + "'?"
                : there.empty() ? "haptel list shows what it holds"
                                : "it has " + list);
}

std::string path_named(std::string_view path_or_name, const fs::path& folder)
{
    const FoundFile found = names_library_file(path_or_name) ? find_file(path_or_name, folder) : FoundFile();
    return found.file.empty() ? std::string(path_or_name) : found.file.string();
}

} // namespace haptel::libraries
