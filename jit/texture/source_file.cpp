#include "jit/texture/source_file.h"

#include "input/regular_file.h"
#include "lang/abi/library_name.h"
#include "lang/text/diagnostic.h"
#include "lang/text/near_name.h"
#include "libraries/find.h"

#include <algorithm>
#include <filesystem>
#include <utility>
#include <vector>

namespace haptel::jit {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t listed_max = 5; // of the files of a folder

// A texture file of nearly that name in the same folder, or else where it was looked for and what is there.
std::string did_you_mean(const fs::path& path)
{
    std::error_code ignored, unreadable;
    std::vector<std::string> names;
    const fs::path folder = fs::absolute(path, ignored).parent_path();
    for (fs::directory_iterator entry(folder, unreadable), end; !unreadable && entry != end && names.size() < 1000;
         entry.increment(unreadable))
        if (entry->path().extension() == ".haptel") names.push_back(entry->path().filename());
    const std::string wanted = path.filename();
    const std::string_view nearest = near_name(wanted, {names.begin(), names.end()}).name;
    if (!nearest.empty()) return "did you mean '" + lang::printable(nearest) + "'?";
    const std::string there = "'" + lang::printable(folder.lexically_normal().string()) + "'";
    if (!fs::is_directory(folder, ignored)) return "there is no folder " + there;
    if (unreadable) return "it was looked for in " + there + ", which cannot be listed";
    if (names.empty()) return "it was looked for in " + there + ", which holds no texture file (*.haptel)";
    std::sort(names.begin(), names.end());
    std::string list;
    for (std::size_t i = 0; i < std::min(names.size(), listed_max); ++i)
        list += (i == 0 ? "" : ", ") + lang::printable(names[i]);
    return "it was looked for in " + there + ", which holds " + list + (names.size() > listed_max ? ", ..." : "");
}

// With the error as a clause of its own: "it is a pipe".
SourceText read(const std::string& path)
{
    input::FileBytes file = input::read_regular_file(path, source_bytes_max);
    const input::Refusal refusal = file.refused.refusal;
    if (refusal == input::Refusal::none) return {std::move(file.bytes), {}, {}};
    return {{},
            "it " + file.refused.why,
            refusal == input::Refusal::missing     ? did_you_mean(path)
            : refusal == input::Refusal::folder    ? "name a texture file inside it: FILE.haptel"
            : refusal == input::Refusal::too_large ? "no texture is as large: is it the right file?"
                                                   : ""};
}

} // namespace

SourceText read_source(const std::string& path)
{
    if (names_library_file(path)) // it was not to be found
        if (libraries::FoundFile found = libraries::find_file(path, {}); found.file.empty())
            return {{}, std::move(found.why), std::move(found.hint)};
    SourceText source = read(path);
    if (!source.error.empty()) source.error.insert(0, "cannot read this file: ");
    return source;
}

lang::Imported load_beside(std::string_view path, std::string_view importer)
{
    const fs::path folder = fs::path(importer).parent_path();
    fs::path full = (folder / fs::path(path)).lexically_normal();
    if (names_library_file(path)) {
        libraries::FoundFile found = libraries::find_file(path, folder);
        if (found.file.empty()) return {std::nullopt, std::move(found.why), std::move(found.hint)};
        full = std::move(found.file);
    }
    SourceText source = read(full);
    if (!source.error.empty()) return {std::nullopt, std::move(source.error), std::move(source.hint)};
    return {lang::SourceFile{full, std::move(source.text)}};
}

TextureReference split_reference(std::string_view reference, const std::string& folder)
{
    const size_t colon = reference.rfind(':');
    const bool has_texture = colon != reference.npos && is_plain_name(reference.substr(colon + 1));
    return {libraries::path_named(has_texture ? reference.substr(0, colon) : reference, folder),
            std::string(has_texture ? reference.substr(colon + 1) : std::string_view())};
}

std::string about_file(const std::string& file, std::string_view messages)
{
    std::string told;
    while (!messages.empty()) {
        const std::string_view line = messages.substr(0, messages.find('\n'));
        if (!line.starts_with(' ')) told += lang::printable(file) + ": ";
        told.append(line).append("\n");
        messages.remove_prefix(std::min(messages.size(), line.size() + 1));
    }
    return told;
}

} // namespace haptel::jit
