// Feel recordings as a command line names them. Such a recording lies beside a scene, SCENE.feel.haptrace, and
// `haptel test` holds the scene to the forces in it.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace haptel::tools {

inline constexpr std::string_view feel_ending = ".feel.haptrace";

struct FeelTargets {
    std::vector<std::string> recordings; // by name, each once
    std::vector<std::string> without;    // scenes that have none
    std::vector<std::string> others; // paths that are neither scene nor recording: folders (for textures too), files
};

// A scene stands for the recordings beside it, of each of its devices; a folder for those in it, at any depth.
FeelTargets feel_targets(const std::vector<std::string>& paths);

// Of which device of the scene: run.haptrace, run_2.haptrace, scene.feel.haptrace, scene_2.feel.haptrace ...
std::string recording_of_hand(const std::string& first, std::size_t hand);

} // namespace haptel::tools
