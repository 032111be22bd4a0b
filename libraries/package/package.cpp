#include "libraries/package/package.h"

#include "input/regular_file.h"

#include <algorithm>

namespace haptel::libraries {

namespace fs = std::filesystem;

namespace {

PackageResult refused(const std::string& name, const std::string& why)
{
    return {std::nullopt, name + ": error: " + why + "\n"};
}

} // namespace

PackageResult make_package(Contents contents, const std::string& name)
{
    contents.erase(sums_name);
    if (const std::string fault = fault_of_sizes(contents); !fault.empty()) return refused(name, fault);
    const auto source = contents.find(manifest_name);
    if (source == contents.end())
        return refused(name, std::string("it has no ") + manifest_name +
                                 ", which says what the library is: haptel new --library NAME writes one");
    input::FileMessages messages(fs::path(name) / manifest_name);
    std::optional<Manifest> manifest = read_manifest(source->second, messages);
    if (!manifest) return {std::nullopt, messages.text()};
    if (const std::string why = why_too_new(*manifest); !why.empty()) return refused(name, why);
    for (const TextureName& texture : manifest->textures)
        if (!contents.contains(texture.file + ".haptel"))
            messages.error("`textures` names \"" + texture.file + ":" + texture.texture + "\", and there is no file " +
                           texture.file + ".haptel");
    if (messages.any_error()) return {std::nullopt, messages.text()};
    contents[sums_name] = sums_of(contents);
    return {Package{std::move(*manifest), std::move(contents)}, {}};
}

PackageResult read_folder(const fs::path& folder)
{
    const std::string name = folder.lexically_normal().string();
    Contents contents;
    std::error_code fault;
    fs::recursive_directory_iterator entry(folder, fault), end;
    if (fault) return refused(name, "cannot read this folder: " + fault.message());
    for (; entry != end; entry.increment(fault)) {
        const std::string file = entry->path().filename();
        const bool is_folder = entry->symlink_status(fault).type() == fs::file_type::directory;
        if (file.starts_with('.') || file.ends_with(".haptlib")) {
            if (is_folder) entry.disable_recursion_pending();
            continue;
        }
        if (is_folder) continue;
        const std::string path = entry->path().lexically_relative(folder).generic_string();
        if (entry->symlink_status(fault).type() != fs::file_type::regular)
            return refused(name, "'" + path + "' is a link or no regular file: a library holds files alone");
        if (const std::string why = fault_of_path(path); !why.empty()) return refused(name, why);
        if (contents.size() >= files_max) break; // which is told
        input::FileBytes read = input::read_regular_file(entry->path(), file_bytes_max);
        if (read.refused.refusal != input::Refusal::none) return refused(name, "'" + path + "' " + read.refused.why);
        contents[path] = std::move(read.bytes);
    }
    if (fault) return refused(name, "cannot read this folder: " + fault.message());
    return make_package(std::move(contents), name);
}

std::string to_text(const Manifest& manifest)
{
    return manifest.name + " " + to_text(manifest.version);
}

} // namespace haptel::libraries
