#include "tools/explore/explore_status.h"

#include "runtime/hand/degradation.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fmt/format.h>
#include <string>

namespace haptel::tools {

namespace {

constexpr std::chrono::milliseconds terminal_interval{100};
constexpr std::chrono::seconds log_interval{10};

// Twelve cells up to 3 N, which is a firm press.
std::string force_bar(double force_n)
{
    constexpr int cells = 12;
    static constexpr const char* eighths[] = {" ", "▏", "▎", "▍", "▌", "▋", "▊", "▉"};
    const int filled = static_cast<int>(std::lround(std::clamp(force_n / 3, 0.0, 1.0) * cells * 8));
    std::string bar;
    for (int i = 0; i < cells; ++i) bar += filled >= 8 * (i + 1) ? "█" : eighths[std::max(filled - 8 * i, 0)];
    return bar;
}

const char* state_of(const runtime::TickRecord& tick)
{
    switch (static_cast<runtime::Degradation>(tick.degradation)) {
    case runtime::Degradation::none: break;
    case runtime::Degradation::no_effects: return "late: no effects";
    case runtime::Degradation::no_textures: return "late: no effects, no textures";
    case runtime::Degradation::no_force: return "late: no force, stops";
    }
    return tick.waiting ? "waits for a small force" : tick.contact ? "touch" : "free ";
}

} // namespace

void ExploreStatus::show(std::span<const runtime::TickRecord> hands)
{
    const Clock::time_point now = Clock::now();
    if (now - last_ < (on_terminal_ ? Clock::duration(terminal_interval) : Clock::duration(log_interval))) return;
    last_ = now;
    std::string text;
    if (hands.size() == 1) {
        const runtime::TickRecord& tick = hands.front();
        const double force_n = glm::length(tick.force_n);
        text = fmt::format("{:7.1f} s  {}  force {:5.2f} N {} depth {:6.3f} mm  texture {:+7.1f} um #{}", tick.time_s,
                           state_of(tick), force_n, on_terminal_ ? "|" + force_bar(force_n) + "| " : "",
                           tick.depth_m * 1e3, tick.height_m * 1e6, tick.binding);
    } else { // a line has room for their forces
        text = fmt::format("{:7.1f} s", hands.front().time_s);
        for (std::size_t i = 0; i < hands.size(); ++i)
            text += fmt::format("  hand {}: {} {:5.2f} N", i + 1, state_of(hands[i]), glm::length(hands[i].force_n));
    }
    if (on_terminal_)
        fmt::print(stderr, "\r\x1b[K{}", text);
    else
        fmt::print(stderr, "{}\n", text);
    std::fflush(stderr);
    shown_ = on_terminal_;
}

void ExploreStatus::say(std::string_view text)
{
    clear();
    if (text.empty()) return;
    fmt::print(stderr, "{}{}", text, text.ends_with('\n') ? "" : "\n");
}

void ExploreStatus::clear()
{
    if (shown_) fmt::print(stderr, "\r\x1b[K");
    std::fflush(stderr);
    shown_ = false;
}

} // namespace haptel::tools
