// How who waits for a scene hears what takes so long, and ends it.
#pragma once

#include <atomic>
#include <functional>
#include <string_view>

namespace haptel::runtime {

struct Loading {
    // Called from the thread that loads, at each step and again and again while it lasts: "mesh `bunny.obj`: reading
    // it". Empty: nobody listens.
    std::function<void(std::string_view doing)> tell;
    // Becomes true, in whatever thread: loading ends as soon as it sees that, with an error. Null: it never does.
    const std::atomic<bool>* stop = nullptr;

    // Processors to build surfaces on: 0, all of them; 1 where a servo runs, which is not to be kept from one.
    unsigned threads = 0;

    bool stopped() const { return stop && stop->load(std::memory_order_relaxed); }
};

inline constexpr std::string_view loading_was_stopped = "loading was stopped";

} // namespace haptel::runtime
