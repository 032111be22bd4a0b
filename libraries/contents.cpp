#include "libraries/contents.h"

#include "input/regular_file.h"
#include "libraries/sha256.h"

#include <algorithm>

namespace haptel::libraries {

namespace {

constexpr std::string_view endings[] = {".haptel", ".toml", ".png", ".md", ".txt"};
constexpr std::string_view plain_files[] = {"README.md", "LICENSE",      "LICENSE.txt", "LICENSE.md",
                                            "NOTICE",    "CHANGELOG.md", sums_name};
constexpr std::size_t path_max = 200, depth_max = 8;

// In single quotes, whatever the bytes.
std::string shown(std::string_view path)
{
    std::string text = "'";
    for (const char c : path.substr(0, path_max)) text += c >= ' ' && c < 127 ? c : '?';
    return text + (path.size() > path_max ? "...'" : "'");
}

bool is_part(std::string_view part)
{
    return !part.empty() && part[0] != '-' && std::all_of(part.begin(), part.end(), [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
    });
}

} // namespace

std::string fault_of_path(std::string_view path)
{
    if (std::find(std::begin(plain_files), std::end(plain_files), path) != std::end(plain_files)) return {};
    if (path.size() > path_max)
        return shown(path) + " is too long a path: at most " + std::to_string(path_max) + " bytes";
    const auto ending =
        std::find_if(std::begin(endings), std::end(endings), [&](std::string_view one) { return path.ends_with(one); });
    const bool is_known = ending != std::end(endings);
    std::string_view rest = path.substr(0, path.size() - (is_known ? ending->size() : 0));
    for (std::size_t depth = 1;; ++depth) {
        const std::size_t slash = rest.find('/');
        const bool is_last = slash == rest.npos;
        if (!is_part(rest.substr(0, slash)) && (!is_last || is_known))
            return shown(path) +
                   " cannot be the path of a library's file: its parts are of small letters, digits, _ and -";
        if (is_last) break;
        if (depth == depth_max) return shown(path) + " is too deep: at most " + std::to_string(depth_max) + " folders";
        rest.remove_prefix(slash + 1);
    }
    return is_known
               ? ""
               : shown(path) +
                     " is no file for a library: it holds *.haptel, *.toml, *.png, *.md, *.txt, LICENSE and NOTICE";
}

std::string fault_of_sizes(const Contents& contents)
{
    std::size_t bytes = 0;
    if (contents.size() > files_max) return "it has more than " + std::to_string(files_max) + " files";
    for (const auto& [path, text] : contents) {
        if (std::string fault = fault_of_path(path); !fault.empty()) return fault;
        if (text.size() > file_bytes_max) return shown(path) + " has more than " + input::size_in_words(file_bytes_max);
        bytes += text.size();
    }
    return bytes > library_bytes_max ? "its files have more than " + input::size_in_words(library_bytes_max) : "";
}

std::string sums_of(const Contents& contents)
{
    std::string text;
    for (const auto& [path, bytes] : contents)
        if (path != sums_name) text += sha256(bytes) + "  " + path + "\n";
    return text;
}

std::string fault_of_sums(const Contents& contents)
{
    const auto sums = contents.find(sums_name);
    if (sums == contents.end()) return std::string("it has no ") + sums_name + ": haptel pack makes one";
    if (sums->second == sums_of(contents)) return {};
    for (const auto& [path, bytes] : contents) {
        const std::size_t line = path == sums_name ? std::string::npos : sums->second.find("  " + path + "\n");
        if (path != sums_name && line == std::string::npos) return shown(path) + " is not named in " + sums_name;
        if (path != sums_name && !sums->second.substr(0, line).ends_with(sha256(bytes)))
            return shown(path) + " is not the file that " + sums_name + " tells of: it was changed or damaged";
    }
    return std::string(sums_name) + " does not tell of these files";
}

} // namespace haptel::libraries
