#include "tools/explore_scene.h"

#include "jit/file_watch.h"

#include <chrono>
#include <fstream>
#include <iterator>
#include <poll.h>
#include <set>
#include <utility>

namespace haptel::tools {

namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr auto look_interval = 50ms;
constexpr auto look_unasked = 500ms; // where the system does not tell of changes
// After the last sign of a change: who writes may not be done.
constexpr auto settle_after_written = 20ms, settle_after_writing = 200ms;

std::string content_of(const std::filesystem::path& file)
{
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

} // namespace

ExploreScene::ExploreScene(std::filesystem::path file, std::vector<std::filesystem::path> meshes,
                           runtime::SurfaceCache& surfaces, ExploreTextures& textures, ExploreHands& hands)
    : file_(std::move(file)), meshes_(std::move(meshes)), surfaces_(surfaces), textures_(textures), hands_(hands)
{
    loaded_state_ = state();
    thread_ = std::thread([this] { watch(); });
}

ExploreScene::~ExploreScene()
{
    stop_.store(true, std::memory_order_relaxed);
    thread_.join();
}

std::string ExploreScene::take_messages()
{
    const std::lock_guard lock(messages_mutex_);
    return std::exchange(messages_, {});
}

void ExploreScene::say(const std::string& message)
{
    const std::lock_guard lock(messages_mutex_);
    messages_ += message;
}

std::string ExploreScene::state() const
{
    std::string state = content_of(file_);
    for (const auto& mesh : meshes_) state += runtime::SurfaceCache::key(mesh, "", 0, {});
    return state;
}

void ExploreScene::watch()
{
    jit::FileWatch files;
    std::optional<Clock::time_point> due;
    Clock::time_point looked = Clock::now();
    while (!stop_.load(std::memory_order_relaxed)) {
        std::set<std::string> names = {file_.string()};
        for (const auto& mesh : meshes_) names.insert(mesh.string());
        files.watch(names);
        pollfd descriptor{files.descriptor(), POLLIN, 0};
        poll(&descriptor, 1, static_cast<int>(look_interval.count()));
        const auto now = Clock::now();
        if (const auto change = files.take(); change != jit::FileWatch::Change::none)
            due = now + (change == jit::FileWatch::Change::written ? settle_after_written : settle_after_writing);
        if (files.descriptor() < 0 && now - looked > look_unasked) due = now, looked = now;
        if (due && now >= *due) {
            due.reset();
            load();
        }
        hands_.collect();
    }
}

void ExploreScene::load()
{
    std::string now = state();
    if (now == loaded_state_) return;
    loaded_state_ = std::move(now);
    runtime::LoadedScene loaded = runtime::load_scene(file_, textures_.resolver(), {}, &surfaces_);
    if (!loaded.meshes.empty()) {
        meshes_ = std::move(loaded.meshes);
        loaded_state_ = state();
    }
    say(loaded.diagnostics);
    const std::string name = file_.filename().string();
    if (!loaded.scene) return say(name + ": not used; what was felt stays\n");
    if (const std::string refused = hands_.publish(loaded.scene); !refused.empty())
        return say(name + ": not used: " + refused + "\n");
    textures_.watch(*loaded.scene);
    say(name + ": reloaded; devices and workspaces stay as they were at the start\n");
}

} // namespace haptel::tools
