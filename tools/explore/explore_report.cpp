#include "tools/explore/explore_report.h"

#include "tools/explore/axes_json.h"

#include "lang/abi/abi.h"
#include "runtime/render/renderer.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <utility>

namespace haptel::tools {

namespace {

using runtime::Histogram;
using runtime::ServoState;

const char* name_of(ServoState state)
{
    switch (state) {
    case ServoState::ready: return "ready";
    case ServoState::running: return "running";
    case ServoState::finished: return "finished";
    case ServoState::stopped: return "stopped";
    case ServoState::faulted: return "faulted";
    }
    return "";
}

// A percentile in units of `ns_per_unit`, or null where nothing was measured (no deadlines on the virtual clock).
Json percentile(const Histogram& histogram, double fraction, double ns_per_unit)
{
    if (histogram.count() == 0) return nullptr;
    return static_cast<double>(histogram.percentile(fraction)) / ns_per_unit;
}

Json maximum(const Histogram& histogram, double ns_per_unit)
{
    if (histogram.count() == 0) return nullptr;
    return static_cast<double>(histogram.maximum()) / ns_per_unit;
}

std::string time_text(double ns)
{
    if (ns < 1e3) return fmt::format("{:.0f} ns", ns);
    if (ns < 1e6) return fmt::format("{:.1f} us", ns / 1e3);
    return fmt::format("{:.1f} ms", ns / 1e6);
}

std::string percentiles_text(const Histogram& histogram)
{
    const auto at = [&](double fraction) { return time_text(static_cast<double>(histogram.percentile(fraction))); };
    return fmt::format("median {}, p99 {}, p99.9 {}, longest {}", at(0.5), at(0.99), at(0.999),
                       time_text(static_cast<double>(histogram.maximum())));
}

std::string faults_text(uint32_t bits)
{
    constexpr std::pair<uint32_t, const char*> meanings[] = {
        {HAPTEL_FAULT_HEIGHT_NOT_FINITE, "a height was not finite (0 was used)"},
        {HAPTEL_FAULT_GRADIENT_NOT_FINITE, "a gradient was not finite (0 was used)"},
        {HAPTEL_FAULT_OUTPUT_NOT_FINITE, "a material output was not finite or negative (1 was used)"},
        {runtime::fault_height_above_bound, "a height was above its proven bound (cut off there)"},
        {runtime::fault_height_bent,
         "a height was beyond what a search had found of its texture (bent to stay within)"},
        {runtime::fault_vibration_too_fast, "a vibration was too fast for the servo's rate (left out)"},
        {runtime::fault_pose_not_finite, "the device gave a pose that is not finite (no force)"},
        {runtime::fault_force_not_finite, "the force was not finite (none was sent)"},
        {runtime::fault_scene_refused, "the scene was refused (no force)"},
        {runtime::fault_contact_unfinished, "the probe could not go all its way in one tick (it went on in the next)"},
    };
    std::string text;
    for (const auto& [bit, meaning] : meanings) {
        if (bits & bit) text += (text.empty() ? "" : "; ") + std::string(meaning);
        bits &= ~bit;
    }
    if (bits != 0) text += fmt::format("{}unknown bits 0x{:x}", text.empty() ? "" : "; ", bits);
    return text;
}

double percent(uint64_t part, uint64_t whole)
{
    return whole == 0 ? 0 : 100 * static_cast<double>(part) / static_cast<double>(whole);
}

std::string micrometres(double metres)
{
    return fmt::format("{:.3g} um", metres * 1e6);
}

void add(Json& json, const HandOutcome& hand)
{
    const runtime::ServoReport& servo = hand.servo;
    json["device"] = hand.device.name;
    json["axes"] = axes_json(hand.device.axes);
    json["seconds"] = servo.seconds;
    json["rate_hz"] = servo.rate_hz;
    json["ticks"] = servo.ticks;
    json["missed_deadlines"] = servo.missed_deadlines;
    json["degraded"]["without_effects"] = servo.degraded.without_effects;
    json["degraded"]["without_textures"] = servo.degraded.without_textures;
    json["degraded"]["without_force"] = servo.degraded.without_force;
    json["contact_ticks"] = servo.contact_ticks;
    json["waiting_ticks"] = servo.waiting_ticks;
    json["tick_ns"]["median"] = percentile(servo.tick_ns, 0.5, 1);
    json["tick_ns"]["p99"] = percentile(servo.tick_ns, 0.99, 1);
    json["tick_ns"]["p999"] = percentile(servo.tick_ns, 0.999, 1);
    json["tick_ns"]["max"] = maximum(servo.tick_ns, 1);
    json["wake_late_us"]["median"] = percentile(servo.wake_late_ns, 0.5, 1e3);
    json["wake_late_us"]["p99"] = percentile(servo.wake_late_ns, 0.99, 1e3);
    json["wake_late_us"]["max"] = maximum(servo.wake_late_ns, 1e3);
    json["link_us"]["median"] = percentile(servo.link_ns, 0.5, 1e3);
    json["link_us"]["p99"] = percentile(servo.link_ns, 0.99, 1e3);
    json["link_us"]["max"] = maximum(servo.link_ns, 1e3);
    json["force_n"]["rms"] = finite_or_null(servo.force_rms_n);
    json["force_n"]["max"] = finite_or_null(servo.force_max_n);
    json["grip_force_n"]["rms"] = finite_or_null(servo.grip_force_rms_n);
    json["grip_force_n"]["max"] = finite_or_null(servo.grip_force_max_n);
    json["energy_j"] = finite_or_null(servo.energy_j);
    json["felt_height_m"]["minimum"] = finite_or_null(hand.heights.minimum_m);
    json["felt_height_m"]["maximum"] = finite_or_null(hand.heights.maximum_m);
    const double resolution_m = hand.device.position_resolution_m;
    json["position_resolution_m"] = resolution_m > 0 ? Json(resolution_m) : Json(nullptr);
    json["texture_below_resolution"] = hand.hides_texture();
    json["unfelt"] = {{"longest_s", hand.unfelt_s()}, {"depth_m", hand.unfelt.depth_m}};
    json["faults"] = servo.faults;
    json["reloads"] = servo.reloads;
    json["scenes_swapped"] = servo.scenes_swapped;
    json["allocations_in_tick"] = value_or_null(servo.allocations_in_tick);
    json["skipped"]["free_space"] = servo.skipped.free_space;
    json["skipped"]["objects"] = servo.skipped.objects;
    json["skipped"]["texture"] = servo.skipped.texture;
    json["skipped"]["octaves"] = servo.skipped.octaves;
    json["skipped"]["mapping"] = servo.skipped.mapping;
    json["state"] = name_of(servo.state);
    json["stop_reason"] = servo.stop_reason;
    json["real_time"] = servo.real_time;
    json["processor_share"] = servo.processor_share;
    json["records_dropped"] = servo.records_dropped;
}

std::string lines_of(const HandOutcome& hand, const ExploreOutcome& outcome)
{
    const runtime::ServoReport& servo = hand.servo;
    std::string text;
    const auto line = [&](const char* name, const std::string& value) {
        text += fmt::format("  {:<12} {}\n", name, value);
    };
    text += fmt::format("{} with {}: {}\n", outcome.scene, hand.device.name, servo.stop_reason);
    line("time", fmt::format("{:.3f} s, {} ticks at {:g} Hz, {} missed deadlines", servo.seconds, servo.ticks,
                             servo.rate_hz, servo.missed_deadlines));
    line("contact", fmt::format("{} ticks ({:.1f} %)", servo.contact_ticks, percent(servo.contact_ticks, servo.ticks)));
    if (servo.degraded.without_effects > 0)
        line("overload", fmt::format("effects were left out in {} ticks, textures in {}, all force in {}: too many "
                                     "deadlines were missed",
                                     servo.degraded.without_effects, servo.degraded.without_textures,
                                     servo.degraded.without_force));
    if (servo.waiting_ticks > 0)
        line("waited", fmt::format("{} ticks without force, until it was small", servo.waiting_ticks));
    line("force", fmt::format("rms {:.3f} N, largest {:.3f} N", servo.force_rms_n, servo.force_max_n));
    if (servo.grip_force_max_n > 0)
        line("grip", fmt::format("rms {:.3f} N, largest {:.3f} N", servo.grip_force_rms_n, servo.grip_force_max_n));
    line("energy",
         fmt::format("{:.3g} J {} the hand", std::abs(servo.energy_j), servo.energy_j < 0 ? "taken from" : "given to"));
    line("tick", percentiles_text(servo.tick_ns));
    if (servo.wake_late_ns.count() > 0) line("woke late", percentiles_text(servo.wake_late_ns));
    if (servo.processor_share > 0) line("processor", fmt::format("{:.3g} % of one", 100 * servo.processor_share));
    if (servo.link_ns.count() > 0) line("link", percentiles_text(servo.link_ns));
    line("textures", fmt::format("{} compiled, {} reloads", outcome.textures_compiled, servo.reloads));
    if (servo.scenes_swapped > 0) line("scenes", fmt::format("{} took the place of the first", servo.scenes_swapped));
    const runtime::SkippedStages& skipped = servo.skipped;
    line("skipped",
         fmt::format("collision in {} ticks, texture in {}, octaves in {}, mapping in {}; objects out of reach {} "
                     "times",
                     skipped.free_space, skipped.texture, skipped.octaves, skipped.mapping, skipped.objects));
    if (servo.allocations_in_tick) line("allocations", fmt::format("{} in ticks", *servo.allocations_in_tick));
    if (servo.faults > 0) line("faults", fmt::format("in {} ticks: {}", servo.faults, faults_text(servo.fault_bits)));
    if (servo.records_dropped > 0) line("telemetry", fmt::format("{} records were dropped", servo.records_dropped));
    if (!servo.real_time_note.empty()) line("note", servo.real_time_note);
    if (hand.feels_nothing())
        line("note",
             fmt::format("for {:.2g} s the hand was up to {} below a surface and felt nothing: what is felt there lies "
                         "deeper, a valley of the texture, or the smooth surface of a coarse mesh. Press harder "
                         "(`press_n`), or make the texture shallower: haptel check says within which heights it is "
                         "felt",
                         hand.unfelt_s(), micrometres(hand.unfelt.depth_m)));
    if (hand.hides_texture())
        line("note", fmt::format("the texture is {} high along the path, but {} measures positions in steps of {}: the "
                                 "steps hide it. Make the texture deeper, or take a finer device",
                                 micrometres(hand.heights.width_m()), hand.device.name,
                                 micrometres(hand.device.position_resolution_m)));
    return text;
}

} // namespace

void HeightRange::add(const runtime::TickRecord& tick, double scale)
{
    if (!(tick.depth_m > 0)) return; // no texture was evaluated
    minimum_m = std::min(minimum_m, tick.height_m / scale);
    maximum_m = std::max(maximum_m, tick.height_m / scale);
}

void UnfeltContact::add(const runtime::TickRecord& tick, double scale)
{
    const bool is_unfelt = tick.contact > 0 && tick.depth_m > 0 && tick.force_n == glm::dvec3(0) && !tick.waiting &&
                           tick.degradation == 0 && !tick.interrupted;
    run_ticks_ = is_unfelt ? run_ticks_ + 1 : 0;
    run_depth_m_ = is_unfelt ? std::max(run_depth_m_, tick.depth_m / scale) : 0;
    if (run_ticks_ <= ticks) return;
    ticks = run_ticks_;
    depth_m = run_depth_m_;
}

bool HandOutcome::hides_texture() const
{
    return heights.width_m() > 0 && heights.width_m() < 2 * device.position_resolution_m;
}

Json to_json(const ExploreOutcome& outcome)
{
    Json json;
    json["scene"] = outcome.scene;
    json["clock"] = outcome.clock;
    add(json, outcome.hands.front());
    json["textures_compiled"] = outcome.textures_compiled;
    json["devices"] = Json::array();
    for (const HandOutcome& hand : outcome.hands) {
        Json device;
        add(device, hand);
        json["devices"].push_back(std::move(device));
    }
    return json;
}

std::string to_lines(const ExploreOutcome& outcome)
{
    std::string text;
    for (const HandOutcome& hand : outcome.hands) text += lines_of(hand, outcome);
    return text;
}

} // namespace haptel::tools
