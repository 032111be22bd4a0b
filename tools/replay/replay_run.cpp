#include "tools/replay/replay_run.h"

#include "device/replay_device.h"
#include "jit/texture/resolver.h"
#include "runtime/files/scene_file.h"
#include "runtime/servo/servo_thread.h"
#include "tools/replay/traced_files.h"

#include <chrono>
#include <cstddef>
#include <fmt/format.h>
#include <memory>
#include <thread>
#include <utility>

namespace haptel::tools {

namespace fs = std::filesystem;

namespace {

// Every tick that the servo tells of.
void take_all(runtime::ServoThread& servo, std::vector<runtime::TickRecord>& ticks)
{
    while (true) {
        const bool is_over = !servo.running(); // before the last look
        runtime::TickRecord tick;
        bool any = false;
        while (servo.telemetry().pop(tick)) ticks.push_back(tick), any = true;
        if (is_over) return;
        if (!any) std::this_thread::sleep_for(std::chrono::microseconds(200));
    }
}

} // namespace

fs::path scene_of(const fs::path& recording, const runtime::TraceResult& recorded)
{
    const runtime::TracedFile* scene = recorded.origin ? recorded.origin->scene() : nullptr;
    return scene ? (recording.parent_path() / scene->path).lexically_normal() : fs::path();
}

Replayed replay_run(const fs::path& scene, const fs::path& recording, const runtime::TraceResult& recorded)
{
    Replayed replayed;
    const std::size_t wanted = recorded.origin && recorded.origin->hand > 0 ? recorded.origin->hand - 1 : 0;
    const auto devices = [&, hand = std::size_t{0}](const runtime::DeviceRequest& request) mutable {
        if (hand++ == wanted) return device::replay_of("the recording", recording, recorded, request.rate_hz);
        return runtime::DeviceResult{std::make_unique<device::ReplayDevice>(runtime::DeviceInfo{request.name},
                                                                            std::vector<runtime::DevicePose>{}),
                                     {}};
    };
    runtime::LoadedScene loaded = runtime::load_scene(scene, jit::make_resolver(), devices);
    replayed.diagnostics = std::move(loaded.diagnostics);
    if (!loaded.scene || loaded.hands.empty()) {
        replayed.fault = "the scene " + scene.string() + " cannot be felt";
        return replayed;
    }
    if (wanted >= loaded.hands.size()) {
        replayed.fault = fmt::format("recorded with device {} of its scene, but {} has {}", wanted + 1, scene.string(),
                                     loaded.hands.size());
        return replayed;
    }
    for (const runtime::SceneObject& object : loaded.scene->objects) replayed.objects.push_back(object.name);
    replayed.files = traced_files(recording, scene, loaded);
    runtime::ServoOptions options;
    options.hand = loaded.hands[wanted].settings;
    options.clock = runtime::ServoClock::virtual_time;
    options.wait_for_reader = true;
    runtime::ServoThread servo(loaded.scene, std::move(loaded.hands[wanted].device), options);
    replayed.ticks.reserve(recorded.records.size());
    servo.start();
    take_all(servo, replayed.ticks);
    if (const runtime::ServoReport& report = servo.wait(); report.state == runtime::ServoState::faulted)
        replayed.fault = report.stop_reason;
    return replayed;
}

} // namespace haptel::tools
