#include "tools/explore/explore_scene.h"

#include "input/regular_file.h"
#include "jit/live/file_watch.h"
#include "lang/text/source.h"

#include <algorithm>
#include <chrono>
#include <poll.h>
#include <set>
#include <system_error>
#include <tuple>
#include <utility>

namespace haptel::tools {

namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr auto look_interval = 50ms;
constexpr auto look_unasked = 500ms; // where the system does not tell of changes
// After the last sign of a change: who writes may not be done.
constexpr auto settle_after_written = 20ms, settle_after_writing = 200ms;
// Between deleting the old file and making the new one, some editors take a while.
constexpr auto absence_forgiven = 500ms;

std::string content_of(const std::filesystem::path& file)
{
    const input::FileBytes read = input::read_regular_file(file, runtime::scene_bytes_max);
    return read.bytes.empty() ? read.refused.why : read.bytes;
}

} // namespace

ExploreScene::ExploreScene(std::filesystem::path file, std::vector<std::filesystem::path> meshes,
                           std::vector<runtime::ProbeSettings> probes, runtime::SurfaceCache& surfaces,
                           ExploreTextures& textures, ExploreHands& hands)
    : folder_(file.parent_path())
    , file_(std::move(file))
    , meshes_(std::move(meshes))
    , probes_(std::move(probes))
    , written_(probes_)
    , surfaces_(surfaces)
    , textures_(textures)
    , hands_(hands)
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

std::string ExploreScene::follow(const std::string& name)
{
    const std::filesystem::path plain = name;
    if (name.empty() || name.find('\0') != name.npos || plain.filename() != plain || plain.extension() != ".toml")
        return "expected the name of a scene file, without a folder: \"other.toml\" beside the first scene";
    std::error_code unknown;
    if (!std::filesystem::is_regular_file(folder_ / plain, unknown))
        return "there is no file " + lang::printable(name) + " in the folder of the first scene";
    const std::lock_guard lock(messages_mutex_);
    asked_ = folder_ / plain;
    return {};
}

void ExploreScene::follow_asked()
{
    std::unique_lock lock(messages_mutex_);
    std::filesystem::path asked = std::exchange(asked_, {});
    lock.unlock();
    if (asked.empty() || asked == file_) return;
    const auto before = std::tuple(std::exchange(file_, std::move(asked)), meshes_, std::exchange(loaded_state_, {}));
    if (!load()) std::tie(file_, meshes_, loaded_state_) = before;
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
    constexpr auto never = Clock::time_point::max();
    Clock::time_point due = never, gone_since = never;
    Clock::time_point looked = Clock::now();
    while (!stop_.load(std::memory_order_relaxed)) {
        std::set<std::string> names = {file_.string()};
        for (const auto& mesh : meshes_) names.insert(mesh.string());
        files.watch(names);
        pollfd descriptor{files.descriptor(), POLLIN, 0};
        poll(&descriptor, 1, static_cast<int>(look_interval.count()));
        follow_asked();
        const auto now = Clock::now();
        if (const auto change = files.take(); change != jit::FileWatch::Change::none)
            due = now + (change == jit::FileWatch::Change::written ? settle_after_written : settle_after_writing);
        // Not of a file that comes back together with its folder.
        const bool is_told = files.descriptor() >= 0 && !loaded_state_.empty();
        if (!is_told && now - looked > look_unasked) due = now, looked = now;
        if (now >= due) {
            due = never;
            std::error_code unknown;
            if (std::filesystem::exists(file_, unknown)) {
                gone_since = never;
                load();
            } else {
                gone_since = std::min(gone_since, now);
                if (now < gone_since + absence_forgiven)
                    due = gone_since + absence_forgiven;
                else
                    tell_that_it_is_gone();
            }
        }
        hands_.collect();
    }
}

// Once. Whatever is there later is loaded, also what was there before.
void ExploreScene::tell_that_it_is_gone()
{
    if (loaded_state_.empty()) return;
    loaded_state_.clear();
    say(file_.filename().string() + ": the file is gone; what was felt stays, and the file is read when it is back\n");
}

// Of a probe that was edited, once. A device was made for the probe that it has: one that gives no tail can hold no
// gripper, and the hand would stick.
std::string ExploreScene::told_of_probes(std::vector<runtime::ProbeSettings> now)
{
    bool edited = false;
    for (std::size_t i = 0; i < std::min(now.size(), probes_.size()); ++i)
        edited = edited || (now[i] != probes_[i] && (i >= written_.size() || now[i] != written_[i]));
    written_ = std::move(now);
    return edited ? file_.filename().string() + ": another probe is felt after a restart\n" : "";
}

bool ExploreScene::load()
{
    std::string now = state();
    if (now == loaded_state_) return true;
    loaded_state_ = std::move(now);
    runtime::LoadedScene loaded = runtime::load_scene(file_, textures_.resolver(), {}, &surfaces_, {{}, &stop_, 1});
    if (!loaded.meshes.empty()) {
        meshes_ = std::move(loaded.meshes);
        loaded_state_ = state();
    }
    say(loaded.diagnostics);
    const std::string name = file_.filename().string();
    if (!loaded.scene) {
        say(name + ": not used; what was felt stays\n");
        return false;
    }
    if (const std::string refused = hands_.publish(loaded.scene); !refused.empty()) {
        say(name + ": not used: " + refused + "\n");
        return false;
    }
    textures_.watch(*loaded.scene);
    say(name + ": reloaded; devices, probes and workspaces stay as they were at the start\n" +
        told_of_probes(std::move(loaded.probes)));
    return true;
}

} // namespace haptel::tools
