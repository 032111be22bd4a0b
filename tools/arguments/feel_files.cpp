#include "tools/arguments/feel_files.h"

#include <cstddef>
#include <filesystem>
#include <set>
#include <system_error>

namespace haptel::tools {

namespace fs = std::filesystem;

std::string recording_of_hand(const std::string& first, std::size_t hand)
{
    if (hand == 0) return first;
    const std::string extension = fs::path(first).extension().string();
    const std::size_t ending = first.size() - (first.ends_with(feel_ending) ? feel_ending.size() : extension.size());
    return first.substr(0, ending) + "_" + std::to_string(hand + 1) + first.substr(ending);
}

FeelTargets feel_targets(const std::vector<std::string>& paths)
{
    FeelTargets targets;
    std::set<std::string> found;
    for (const std::string& path : paths) {
        std::error_code error;
        if (path.ends_with(feel_ending)) {
            found.insert(path);
        } else if (fs::path(path).extension() == ".toml") {
            const std::string first = fs::path(path).replace_extension(feel_ending).string();
            const std::size_t before = found.size();
            constexpr std::size_t devices_max = 64; // of a scene; any of them may have one
            for (std::size_t hand = 0; hand < devices_max; ++hand)
                if (const std::string of_hand = recording_of_hand(first, hand); fs::exists(of_hand, error))
                    found.insert(of_hand);
            if (found.size() == before) targets.without.push_back(path);
        } else {
            targets.others.push_back(path);
            constexpr auto careful = fs::directory_options::skip_permission_denied;
            for (fs::recursive_directory_iterator entry(path, careful, error), end; !error && entry != end;
                 entry.increment(error))
                if (entry->path().string().ends_with(feel_ending) && entry->is_regular_file(error))
                    found.insert(entry->path().string());
        }
    }
    targets.recordings.assign(found.begin(), found.end());
    return targets;
}

} // namespace haptel::tools
