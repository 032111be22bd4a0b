#include "api/device_state.h"
#include "api/scene_state.h"
#include "runtime/files/open_hands.h"
#include "runtime/scene/scene_fields.h"
#include "runtime/servo/servo_thread.h"

#include <haptel/servo.h>

#include <exception>
#include <utility>

namespace haptel {

struct Servo::State {
    std::shared_ptr<const Scene::State> scene; // whose textures go on following their files
    std::unique_ptr<runtime::ServoThread> thread;
    bool is_started = false;
    std::string messages;
};

namespace {

bool pushes_a_hand(const DeviceSource::Implementation& source)
{
    return !source.own && !source.name.starts_with("simulated") && !source.name.starts_with("replay:");
}

// Devices are opened where the scene's first object lies, as those of a scene file.
std::vector<runtime::LoadedHand> open_for(const std::shared_ptr<const runtime::Scene>& scene,
                                          DeviceSource::Implementation& source, input::FileMessages& messages)
{
    std::vector<runtime::DeviceText> texts(1);
    texts[0].request.name = source.name;
    texts[0].request.stroke = source.stroke.name;
    texts[0].request.speed_m_per_s = source.stroke.speed_m_per_s;
    texts[0].request.press_n = source.stroke.press_n;
    texts[0].hand.probe = scene->probe;
    const std::vector<toml::source_region> stiffness_at(scene->objects.size());
    return runtime::open_hands(
        texts, scene, stiffness_at, [&source](const runtime::DeviceRequest& request) { return open(source, request); },
        messages);
}

} // namespace

Servo::Servo(const Scene& scene, DeviceSource device, const ServoOptions& options) : state_(std::make_unique<State>())
{
    if (!scene) {
        state_->messages = scene.messages();
        return;
    }
    const auto source = device.take();
    if (!source || (source->name.empty() && !source->own)) {
        state_->messages = "error: a servo needs a device: open_device() or own_device()\n";
        return;
    }
    if (!(options.seconds >= 0)) {
        state_->messages = "error: `seconds` must be at least 0, found " + runtime::shortest(options.seconds) + "\n";
        return;
    }
    if (options.virtual_time && pushes_a_hand(*source)) {
        state_->messages =
            "error: `virtual_time` is for simulated devices, and '" + source->name + "' pushes a hand: leave it out\n";
        return;
    }
    input::FileMessages messages{{}};
    std::vector<runtime::LoadedHand> hands = open_for(scene.state().scene, *source, messages);
    state_->messages = messages.text();
    if (messages.any_error() || hands.empty()) return;
    runtime::ServoOptions own;
    own.hand = hands.front().settings;
    if (options.seconds > 0) own.seconds = options.seconds;
    own.ask_for_real_time = options.ask_for_real_time;
    own.clock = options.virtual_time ? runtime::ServoClock::virtual_time : runtime::ServoClock::wall;
    state_->scene = scene.share();
    state_->thread = std::make_unique<runtime::ServoThread>(scene.state().scene, std::move(hands.front().device), own);
}

Servo::~Servo() = default;
Servo::Servo(Servo&&) noexcept = default;
Servo& Servo::operator=(Servo&&) noexcept = default;

Servo::operator bool() const
{
    return state_->thread != nullptr;
}

const std::string& Servo::messages() const
{
    return state_->messages;
}

void Servo::start()
{
    if (!state_->thread || std::exchange(state_->is_started, true)) return;
    try {
        state_->thread->start();
    } catch (const std::exception& problem) { // the system has no thread for it
        state_->messages += std::string("error: the servo cannot run: ") + problem.what() + "\n";
        state_->thread.reset();
    }
}

void Servo::request_stop()
{
    if (state_->thread) state_->thread->request_stop();
}

bool Servo::running() const
{
    return state_->thread && state_->thread->running();
}

Report Servo::wait()
{
    Report report;
    if (!state_->thread) {
        report.faulted = true;
        report.stop_reason = state_->messages;
        return report;
    }
    const runtime::ServoReport& run = state_->thread->wait();
    report.faulted = run.state == runtime::ServoState::faulted;
    report.stop_reason = run.stop_reason;
    report.real_time = run.real_time;
    report.seconds = run.seconds;
    report.ticks = run.ticks;
    report.contact_ticks = run.contact_ticks;
    report.missed_deadlines = run.missed_deadlines;
    report.faults = run.faults;
    report.textures_changed = run.reloads;
    report.force_rms_n = run.force_rms_n;
    report.force_max_n = run.force_max_n;
    report.energy_j = run.energy_j;
    report.tick_ns_median = static_cast<double>(run.tick_ns.percentile(0.5));
    report.tick_ns_p99 = static_cast<double>(run.tick_ns.percentile(0.99));
    report.wake_late_us_median = 1e-3 * static_cast<double>(run.wake_late_ns.percentile(0.5));
    report.wake_late_us_p99 = 1e-3 * static_cast<double>(run.wake_late_ns.percentile(0.99));
    return report;
}

} // namespace haptel
