// The scene of an exploration, felt anew whenever its file or one of its meshes changes.
#pragma once

#include "runtime/files/surface_cache.h"
#include "tools/explore/explore_hands.h"
#include "tools/explore/explore_textures.h"

#include <atomic>
#include <filesystem>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace haptel::tools {

class ExploreScene {
public:
    // Watches from now on: every edit reaches the hands, or leaves a message why not. `meshes` and `probes` of the
    // scene as it was loaded first, with `surfaces`; all of them outlive this.
    ExploreScene(std::filesystem::path file, std::vector<std::filesystem::path> meshes,
                 std::vector<runtime::ProbeSettings> probes, runtime::SurfaceCache& surfaces, ExploreTextures& textures,
                 ExploreHands& hands);
    ~ExploreScene(); // stops watching

    // From then on another file of the first one's folder, by its name. Returns why not, or nothing: then it is read
    // soon, and felt, or a message says why not, and the one before goes on. Any thread.
    std::string follow(const std::string& name);

    // What there is to say since the last call, ready to print; empty: nothing.
    std::string take_messages();

private:
    void watch();
    bool load(); // false: what was felt stays
    void follow_asked();
    void tell_that_it_is_gone();
    std::string told_of_probes(std::vector<runtime::ProbeSettings> now);
    std::string state() const; // of the files: what is the same needs no loading
    void say(const std::string& message);

    const std::filesystem::path folder_;
    std::filesystem::path file_; // with what follows, of the watching thread
    std::vector<std::filesystem::path> meshes_;
    const std::vector<runtime::ProbeSettings> probes_; // that the hands have,
    std::vector<runtime::ProbeSettings> written_;      // and that the file had when it was last used
    runtime::SurfaceCache& surfaces_;
    ExploreTextures& textures_;
    ExploreHands& hands_;
    std::string loaded_state_;
    std::mutex messages_mutex_; // of both
    std::string messages_;
    std::filesystem::path asked_; // for; empty: none
    std::atomic<bool> stop_{false};
    std::thread thread_;
};

} // namespace haptel::tools
