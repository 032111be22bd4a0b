// A textured plane under a finger that keeps still, and textures that follow their files and other programs' messages:
// what `haptel explore --osc` is made of, in this process, so that its memory and its ticks can be counted.
#pragma once

#include "jit/texture/texture.h"
#include "runtime/files/scene_file.h"
#include "runtime/servo/allocation_count.h"
#include "runtime/servo/servo_thread.h"
#include "tests/support/catch.h"
#include "tests/support/folder.h"
#include "tests/support/touch_scenes.h"
#include "tools/explore/explore_textures.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <functional>
#include <malloc.h>
#include <numeric>
#include <string>
#include <thread>
#include <unistd.h>
#include <utility>
#include <vector>

namespace haptel::test {

// What OSC reaches here: the textures.
class TexturesAlone final : public tools::Controlled {
public:
    explicit TexturesAlone(tools::ExploreTextures& textures) : textures_(textures) {}

    tools::ControlAnswer set(uint32_t object, const std::string& parameter, const std::string& value) override
    {
        return textures_.set(object, parameter, value);
    }
    tools::ControlAnswer choose_preset(uint32_t object, const std::string& name) override
    {
        return textures_.choose_preset(object, name);
    }
    tools::ControlAnswer load_scene(const std::string&) override { return {"not here", {}}; }
    tools::ControlAnswer start_recording() override { return {"not here", {}}; }
    tools::ControlAnswer stop_recording() override { return {"not here", {}}; }
    void withhold_force(bool) override {}
    bool is_force_withheld() const override { return false; }
    std::vector<tools::ControlledHand> hands() const override { return {{}}; }
    std::vector<tools::ControlledObject> objects() const override { return textures_.controlled(); }
    uint64_t objects_version() const override { return textures_.version(); }

private:
    tools::ExploreTextures& textures_;
};

struct LiveStage {
    Folder folder;
    tools::ExploreTextures textures;
    std::shared_ptr<const runtime::Scene> scene;

    // `text`: of t.haptel, which has a texture t; another one where it is named.
    explicit LiveStage(const std::string& text, const std::string& reference = "t.haptel:t")
    {
        folder.write("t.haptel", text);
        const std::string file =
            folder.write("scene.toml", "[servo]\nforce_rise_s = 0.01\n[[object]]\nshape = \"plane\"\nsize_m = 0.1\n"
                                       "texture = \"" +
                                           reference + "\"\n");
        const runtime::LoadedScene loaded = runtime::load_scene(file, textures.resolver(), {});
        INFO(loaded.diagnostics);
        REQUIRE(loaded.scene);
        scene = loaded.scene;
        textures.watch(*scene);
    }
    const runtime::TextureSlot& slot() const { return *scene->objects[0].texture; }
};

// A finger that comes down to a millimetre below the plane and stays there.
inline runtime::DeviceStatus press_and_stay(uint64_t tick, runtime::DevicePose& pose)
{
    const double down_m = 5e-6 * static_cast<double>(std::min<uint64_t>(tick, 400));
    pose = tests::at(0.0003, 0.0004, 1e-3 - down_m);
    return runtime::DeviceStatus::ok;
}

inline bool comes_true(const std::function<bool()>& condition)
{
    const auto patience = std::chrono::steady_clock::now() + std::chrono::seconds(30);
    while (std::chrono::steady_clock::now() < patience) {
        if (condition()) return true;
        std::this_thread::sleep_for(std::chrono::microseconds(100));
    }
    return false;
}

inline int64_t heap_bytes()
{
    return static_cast<int64_t>(mallinfo2().uordblks);
}

inline int64_t resident_bytes()
{
    std::ifstream pages("/proc/self/statm");
    int64_t all = 0, resident = 0;
    pages >> all >> resident;
    return resident * sysconf(_SC_PAGESIZE);
}

// Deadlines that a servo missed, of 1000, in each of several stretches.
struct Deadlines {
    std::vector<double> missed;

    double mean() const
    {
        return std::accumulate(missed.begin(), missed.end(), 0.0) / static_cast<double>(missed.size());
    }
    double error() const // of the mean, one standard deviation
    {
        double squares = 0;
        for (const double m : missed) squares += (m - mean()) * (m - mean());
        const double count = static_cast<double>(missed.size());
        return std::sqrt(squares / (count * std::max(1.0, count - 1)));
    }
};

// A servo of 1 kHz that feels the stage, and what became of it.
struct LiveRun {
    using Meddle = std::function<void(int)>;

    runtime::ServoReport report;
    std::vector<Deadlines> deadlines;          // of each that takes turns
    double force_max_n = 0, force_min_n = 1e9; // once the finger rests
    double step_max_n = 0;                     // change of the force in a period, likewise
    int64_t heap_growth = 0, resident_growth = 0;

    // `meddle(i)` is called `times` times while it runs; growth is counted from the first tenth on. `others`, which
    // should change nothing, take turns with it, a hundred times each: deadlines that the system misses of itself come
    // in bursts, so runs of their own would not tell them.
    static LiveRun of(LiveStage& stage, int times, const Meddle& meddle, const std::vector<Meddle>& others = {})
    {
        runtime::ServoOptions options;
        options.allocation_count = runtime::allocations_of_this_thread;
        runtime::ServoThread servo(stage.scene, std::make_unique<tests::ScriptedDevice>(press_and_stay), options);
        LiveRun run;
        runtime::TickRecord before, now;
        const auto drain = [&] {
            while (servo.telemetry().pop(now)) {
                if (before.tick >= 500 && now.tick == before.tick + 1) {
                    const double periods = std::max(1.0, std::round((now.time_s - before.time_s) * 1000));
                    const double force_n = glm::length(now.force_n);
                    run.step_max_n = std::max(run.step_max_n, glm::distance(now.force_n, before.force_n) / periods);
                    run.force_max_n = std::max(run.force_max_n, force_n);
                    run.force_min_n = std::min(run.force_min_n, force_n);
                }
                before = now;
            }
        };
        run.deadlines.resize(others.size() + 1);
        uint64_t missed = 0, tick = 0;
        const auto count_for = [&](std::size_t turn) {                    // since the last count
            for (int wait = 0; wait < 300; ++wait) drain(), usleep(1000); // until what was begun is compiled
            const uint64_t missed_before = std::exchange(missed, servo.missed_deadlines()),
                           tick_before = std::exchange(tick, before.tick);
            run.deadlines[turn].missed.push_back(1000 * static_cast<double>(missed - missed_before) /
                                                 static_cast<double>(missed - missed_before + tick - tick_before));
        };
        servo.start();
        while (before.tick < 600 && servo.running()) drain(), usleep(1000);
        missed = servo.missed_deadlines(), tick = before.tick;
        int64_t heap = 0, resident = 0;
        for (int i = 0; i < times; ++i) {
            if (i == times / 10) heap = heap_bytes(), resident = resident_bytes();
            meddle(i);
            drain();
            if (others.empty() || i % 100 != 99) continue;
            count_for(0);
            for (std::size_t other = 0; other < others.size(); ++other) {
                for (int j = i - 99; j <= i; ++j) others[other](j), drain();
                count_for(other + 1);
            }
        }
        run.heap_growth = heap_bytes() - heap;
        run.resident_growth = resident_bytes() - resident;
        servo.request_stop();
        run.report = servo.wait();
        drain();
        return run;
    }
};

} // namespace haptel::test
