#include "runtime/servo/servo_thread.h"

#include "runtime/servo/real_time.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace haptel::runtime {

namespace {

const char* reason_of(DeviceStatus status)
{
    switch (status) {
    case DeviceStatus::ok: return "";
    case DeviceStatus::finished: return "the device's stroke or recording is over";
    case DeviceStatus::not_ready: return "the device is not ready";
    case DeviceStatus::disconnected: return "the device was disconnected";
    case DeviceStatus::fault: return "the device reported a fault";
    }
    return "";
}

ServoOptions with_limits_of(const HapticDevice& device, ServoOptions options)
{
    options.hand.force_max_n = device.info().force_max_n;
    return options;
}

} // namespace

ServoThread::ServoThread(std::shared_ptr<const Scene> scene, std::unique_ptr<HapticDevice> device,
                         const ServoOptions& options)
    : device_(std::move(device))
    , options_(with_limits_of(*device_, options))
    , renderer_(std::make_unique<Renderer>(scene, options_.hand))
    , rate_hz_(renderer_->rate_hz())
    , periods_wanted_(std::ceil(options.seconds * rate_hz_ - 1e-6))
    , scenes_(std::move(scene), options_.hand)
    , overload_(rate_hz_)
    , telemetry_(options.telemetry_capacity)
{
    report_.rate_hz = rate_hz_;
}

ServoThread::~ServoThread()
{
    request_stop();
    if (thread_.joinable()) thread_.join();
    device_->stop();
}

void ServoThread::start()
{
    running_.store(true, std::memory_order_release);
    try {
        thread_ = std::thread([this] { run(); });
    } catch (...) { // the system has none
        running_.store(false, std::memory_order_release);
        throw;
    }
}

const ServoReport& ServoThread::wait()
{
    if (thread_.joinable()) thread_.join();
    return report_;
}

void ServoThread::run()
{
    begin();
    if (options_.clock == ServoClock::wall)
        keep_deadlines();
    else
        while (turn()) {
        }
    finish();
}

void ServoThread::begin()
{
    set_exact_floating_point();
    use_exact_timers();
    if (options_.clock == ServoClock::wall && options_.ask_for_real_time) {
        RealTime real_time = ask_for_real_time();
        report_.real_time = real_time.granted;
        report_.real_time_note = std::move(real_time.note);
    }
    if (options_.clock == ServoClock::wall && options_.core)
        if (const std::string why = bind_to_core(*options_.core); !why.empty())
            report_.real_time_note += (report_.real_time_note.empty() ? "" : "; ") + why;
    report_.state = ServoState::running;
    if (options_.allocation_count) report_.allocations_in_tick = 0;
    if (!renderer_->refused().empty()) end(ServoState::faulted, "the scene is refused:\n" + renderer_->refused());
}

void ServoThread::finish()
{
    if (report_.state == ServoState::faulted)
        if (const std::string state = device_->state(); !state.empty()) report_.stop_reason += ": " + state;
    device_->stop();
    report_.seconds = static_cast<double>(periods_) / rate_hz_;
    const auto rms = [&](double squared_sum) {
        return report_.ticks == 0 ? 0 : std::sqrt(squared_sum / static_cast<double>(report_.ticks));
    };
    report_.force_rms_n = rms(force_squared_sum_);
    report_.grip_force_rms_n = rms(grip_squared_sum_);
    report_.skipped = renderer_->skipped();
    report_.reloads = scenes_.reloads();
    report_.records_dropped = telemetry_.dropped();
    running_.store(false, std::memory_order_release);
}

bool ServoThread::over()
{
    if (report_.state != ServoState::running) return true;
    if (static_cast<double>(periods_) >= periods_wanted_)
        end(ServoState::finished, "stopped after the requested time");
    else if (stop_requested_.load(std::memory_order_relaxed))
        end(ServoState::stopped, "stopped on request");
    return report_.state != ServoState::running;
}

bool ServoThread::turn()
{
    while (!over()) {
        if (options_.wait_for_reader && telemetry_.full()) {
            std::this_thread::yield();
            continue;
        }
        ++periods_since_pose_;
        if (!tick()) return false;
        ++periods_;
        return true;
    }
    return false;
}

void ServoThread::keep_deadlines()
{
    const auto period_ns = std::max(int64_t{1}, static_cast<int64_t>(std::llround(1e9 / rate_hz_)));
    const int64_t spin_ns = report_.real_time ? std::min(int64_t{200'000}, period_ns / 5) : 0;
    const int64_t start_ns = monotonic_ns(), processor_start_ns = processor_ns();
    int64_t deadline_ns = start_ns + period_ns;
    while (!over()) {
        const int64_t now_ns = wait_until(deadline_ns, spin_ns);
        woken_ns_ = static_cast<uint64_t>(now_ns);
        wake_late_ns_ = static_cast<uint64_t>(now_ns - deadline_ns);
        report_.wake_late_ns.add(wake_late_ns_);
        ++periods_since_pose_;
        if (!tick()) break;
        ++periods_;
        deadline_ns += period_ns;
        const int64_t late_ns = monotonic_ns() - deadline_ns;
        const int64_t missed = late_ns < 0 ? 0 : late_ns / period_ns + 1;
        overload_.tick(static_cast<uint64_t>(missed));
        report_.missed_deadlines += static_cast<uint64_t>(missed);
        missed_deadlines_.store(report_.missed_deadlines, std::memory_order_relaxed);
        periods_ += static_cast<uint64_t>(missed);
        periods_since_pose_ += static_cast<uint64_t>(missed);
        deadline_ns += missed * period_ns;
    }
    const int64_t took_ns = std::max(int64_t{1}, monotonic_ns() - start_ns);
    report_.processor_share = static_cast<double>(processor_ns() - processor_start_ns) / static_cast<double>(took_ns);
}

bool ServoThread::tick()
{
    const uint64_t allocations_before = options_.allocation_count ? options_.allocation_count() : 0;

    report_.scenes_swapped += scenes_.take(renderer_);
    DevicePose pose;
    const DeviceStatus read = device_->read(pose);
    if (read == DeviceStatus::not_ready) {
        device_->write_grip(0);
        device_->write(glm::dvec3(0), glm::dvec3(0));
        interrupted_ = true;
        return true;
    }
    if (read != DeviceStatus::ok) {
        end(read == DeviceStatus::finished ? ServoState::finished : ServoState::faulted, reason_of(read));
        return false;
    }
    if (pose.link_ns > 0) report_.link_ns.add(static_cast<uint64_t>(pose.link_ns));
    if (pose.periods == 0) pose.periods = periods_since_pose_;
    const bool is_withheld = withheld_.load(std::memory_order_relaxed);
    pose.interrupted = pose.interrupted || interrupted_ || is_withheld;
    pose.degradation = std::max(pose.degradation, overload_.step());
    periods_since_pose_ = 0;
    interrupted_ = false;

    const int64_t start_ns = monotonic_ns();
    TickResult result = renderer_->tick(pose);
    if (is_withheld) { // also of a scene in which forces do not rise
        result.force_n = result.torque_n_m = glm::dvec3(0);
        result.grip_force_n = 0;
    }
    const int64_t compute_ns = monotonic_ns() - start_ns;

    device_->write_grip(result.grip_force_n);
    const DeviceStatus written = device_->write(result.force_n, result.torque_n_m);
    record(pose, result, static_cast<uint64_t>(compute_ns));
    renderer_->between_ticks();
    if (options_.allocation_count) *report_.allocations_in_tick += options_.allocation_count() - allocations_before;
    if (overload_.step() == Degradation::no_force && renderer_->faded_away())
        end(ServoState::faulted,
            "the servo missed more than half of its deadlines for a second, even without effects and textures: it took "
            "the force away and stopped. Give it the processor (docs/realtime.md), or lower `rate_hz`");
    if (written != DeviceStatus::ok && written != DeviceStatus::not_ready)
        end(written == DeviceStatus::finished ? ServoState::finished : ServoState::faulted, reason_of(written));
    return true;
}

void ServoThread::record(const DevicePose& pose, const TickResult& result, uint64_t compute_ns)
{
    if (result.interrupted) has_last_tip_ = false; // no force was on the hand while it came here
    if (result.faults & fault_pose_not_finite) {
        has_last_tip_ = false;
    } else {
        // The force of the tick before was held while the hand came here, and so was the torque while it turned; what
        // pushed a gripper's fingers apart, while they opened: half of the sum and of the difference are the second's.
        const glm::dvec3 shaft = pose.tail_m - pose.tip_m;
        const double length = glm::length(shaft);
        const glm::dvec3 along = length > 0 ? shaft / length : glm::dvec3(0);
        if (has_last_tip_)
            report_.energy_j += glm::dot(last_force_n_, pose.tip_m - last_tip_m_) +
                                glm::dot(last_torque_n_m_, glm::cross(last_along_, along));
        if (has_last_tip_ && last_grip_n_ != 0)
            report_.energy_j += (last_grip_n_ + 0.5 * glm::dot(last_force_n_, last_along_)) * (length - last_length_m_);
        last_tip_m_ = pose.tip_m;
        last_along_ = along;
        last_torque_n_m_ = result.torque_n_m + torque_about(pose.tip_m, result.grip_m, result.force_n);
        last_force_n_ = result.force_n;
        last_length_m_ = length;
        last_grip_n_ = result.grip_force_n;
        has_last_tip_ = true;
    }
    const double force_n = glm::length(result.force_n);
    force_squared_sum_ += force_n * force_n;
    report_.force_max_n = std::max(report_.force_max_n, force_n);
    grip_squared_sum_ += result.grip_force_n * result.grip_force_n;
    report_.grip_force_max_n = std::max(report_.grip_force_max_n, std::abs(result.grip_force_n));
    report_.contact_ticks += result.contacts > 0;
    report_.waiting_ticks += result.waiting;
    report_.degraded.without_effects += pose.degradation >= Degradation::no_effects;
    report_.degraded.without_textures += pose.degradation >= Degradation::no_textures;
    report_.degraded.without_force += pose.degradation >= Degradation::no_force;
    report_.faults += result.faults != 0;
    report_.fault_bits |= result.faults;
    report_.tick_ns.add(compute_ns);

    TickRecord row;
    row.tick = report_.ticks++;
    row.time_s = result.time_s;
    row.device_force_max_n = device_->info().force_max_n;
    row.interrupted = result.interrupted;
    row.waiting = result.waiting;
    row.degradation = static_cast<uint32_t>(pose.degradation);
    row.tip_m = pose.tip_m;
    row.tail_m = pose.tail_m;
    row.force_n = result.force_n;
    row.torque_n_m = result.torque_n_m;
    row.grip_force_n = result.grip_force_n;
    row.contact = result.contacts;
    row.depth_m = result.depth_m;
    row.height_m = result.height_m;
    row.object = result.object;
    row.compute_ns = compute_ns;
    row.woken_ns = woken_ns_;
    row.wake_late_ns = wake_late_ns_;
    row.binding = result.binding;
    row.faults = result.faults;
    telemetry_.push(row);
}

void ServoThread::end(ServoState state, const std::string& reason)
{
    device_->write_grip(0);
    device_->write(glm::dvec3(0), glm::dvec3(0));
    report_.state = state;
    report_.stop_reason = reason;
}

} // namespace haptel::runtime
