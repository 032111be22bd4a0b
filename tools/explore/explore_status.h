// What is shown while an exploration runs: one line that rewrites itself on a terminal, a line now and then elsewhere.
#pragma once

#include "runtime/servo/telemetry.h"

#include <chrono>
#include <span>
#include <string_view>

namespace haptel::tools {

class ExploreStatus {
public:
    explicit ExploreStatus(bool on_terminal) : on_terminal_(on_terminal) {}
    ~ExploreStatus() { clear(); }

    // Often; shows the newest tick of each hand when it is time to.
    void show(std::span<const runtime::TickRecord> hands);

    // Prints a message of several lines without the status in its way.
    void say(std::string_view text);

    void clear();

private:
    using Clock = std::chrono::steady_clock;

    bool on_terminal_;
    bool shown_ = false;
    Clock::time_point last_ = Clock::now();
};

} // namespace haptel::tools
