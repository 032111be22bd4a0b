#include "libraries/package/install.h"

#include "input/regular_file.h"
#include "libraries/lock.h"
#include "libraries/sha256.h"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>

namespace haptel::libraries {

namespace fs = std::filesystem;

namespace {

// A folder beside the target, which becomes it or goes away again, with folders above it that were made for it.
class Workplace {
public:
    explicit Workplace(const fs::path& root)
    {
        std::error_code fault;
        for (fs::path at = root; !at.empty() && !fs::exists(at, fault); at = at.parent_path()) made.push_back(at);
        fs::create_directories(root, fault);
        std::string name = (root / ".installing-XXXXXX").string();
        if (mkdtemp(name.data()))
            folder = name;
        else
            error = std::strerror(errno);
    }
    ~Workplace()
    {
        std::error_code ignored;
        if (!folder.empty()) fs::remove_all(folder, ignored);
        for (const fs::path& each : made) fs::remove(each, ignored); // those that are empty
    }
    Workplace(const Workplace&) = delete;
    Workplace& operator=(const Workplace&) = delete;

    fs::path folder; // empty: there is an error
    std::string error;

private:
    std::vector<fs::path> made; // deepest first
};

std::string write(const fs::path& file, std::string_view bytes)
{
    std::error_code fault;
    fs::create_directories(file.parent_path(), fault);
    std::ofstream out(file, std::ios::binary);
    out << bytes;
    out.close();
    return out ? "" : file.string() + " cannot be written: " + std::strerror(errno);
}

bool stands_in(const Contents& contents, const fs::path& folder)
{
    return std::all_of(contents.begin(), contents.end(), [&](const auto& file) {
        const input::FileBytes there = input::read_regular_file(folder / file.first, file_bytes_max);
        return there.refused.refusal == input::Refusal::none && there.bytes == file.second;
    });
}

Installation refused(std::string why)
{
    return {{}, false, std::move(why)};
}

// As a whole or not at all.
std::string replace_lock(const fs::path& file, const std::vector<Locked>& libraries)
{
    const fs::path beside = file.string() + ".new";
    if (std::string fault = write(beside, lock_text(libraries)); !fault.empty()) return fault;
    std::error_code fault;
    fs::rename(beside, file, fault);
    return fault ? file.string() + " cannot be written: " + fault.message() : "";
}

} // namespace

Installation install(const Package& package, const fs::path& root)
{
    const fs::path target = root / package.manifest.name / to_text(package.manifest.version);
    std::error_code fault;
    if (fs::exists(target, fault)) {
        if (stands_in(package.contents, target)) return {target, true, {}};
        return refused(
            target.string() + " is there already, with other files: give this one another version, or take " +
            "that one away: haptel remove " + package.manifest.name + "@" + to_text(package.manifest.version));
    }
    Workplace work(root);
    if (work.folder.empty()) return refused(root.string() + " cannot be written: " + work.error);
    const fs::path made = work.folder / "library";
    for (const auto& [path, bytes] : package.contents)
        if (std::string why = write(made / path, bytes); !why.empty()) return refused(std::move(why));
    const bool is_first = fs::create_directory(target.parent_path(), fault);
    fs::rename(made, target, fault);
    if (!fault) return {target, false, {}};
    if (stands_in(package.contents, target)) return {target, true, {}}; // somebody was faster
    std::error_code ignored;
    if (is_first) fs::remove(target.parent_path(), ignored);
    return refused(target.string() + " cannot be written: " + fault.message());
}

std::string remove(const Installed& library)
{
    const fs::path root = library.folder.parent_path().parent_path();
    std::string gone = (root / ".removing-XXXXXX").string();
    std::error_code fault;
    if (!mkdtemp(gone.data())) return root.string() + " cannot be written: " + std::strerror(errno);
    fs::rename(library.folder, fs::path(gone) / "library", fault);
    std::error_code ignored;
    fs::remove_all(gone, ignored);
    if (fault) return library.folder.string() + " cannot be taken away: " + fault.message();
    fs::remove(library.folder.parent_path(), ignored); // if that was the last version
    return {};
}

std::string lock(const fs::path& project, const Package& package)
{
    const Manifest& manifest = package.manifest;
    LockFile open = read_lock_file(project / lock_name);
    if (!open.fault.empty()) return open.fault;
    // Of a major version a project uses one.
    std::erase_if(open.libraries, [&](const Locked& one) {
        return one.name == manifest.name && one.version.major == manifest.version.major;
    });
    open.libraries.push_back({manifest.name, manifest.version, sha256(package.contents.at(sums_name))});
    return replace_lock(project / lock_name, open.libraries);
}

std::string unlock(const fs::path& project, const Installed& library)
{
    LockFile open = read_lock_file(project / lock_name);
    if (!open.fault.empty()) return open.fault;
    const std::size_t count = std::erase_if(
        open.libraries, [&](const Locked& one) { return one.name == library.name && one.version == library.version; });
    return count > 0 ? replace_lock(project / lock_name, open.libraries) : "";
}

std::string missing_dependency(const Manifest& manifest, const std::vector<Place>& places)
{
    for (const Dependency& needed : manifest.dependencies) {
        const std::vector<Installed> there = installed_in(places, needed.name);
        const bool is_there = std::any_of(there.begin(), there.end(),
                                          [&](const Installed& one) { return one.version.serves(needed.least); });
        if (!is_there)
            return "it needs " + needed.name + " " + to_text(needed.least) + " or one that can take its place, and " +
                   (there.empty() ? "none is installed" : "there is " + to_text(there.front().version) + " at most") +
                   ": install that first";
    }
    return {};
}

} // namespace haptel::libraries
