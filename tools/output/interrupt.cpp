#include "tools/output/interrupt.h"

#include <atomic>
#include <csignal>

namespace haptel::tools {

namespace {

std::atomic<bool> was_interrupted = false;
static_assert(std::atomic<bool>::is_always_lock_free); // set by a signal

extern "C" void on_interrupt(int signal)
{
    was_interrupted = true;
    std::signal(signal, SIG_DFL);
}

} // namespace

void listen_for_interrupts()
{
    was_interrupted = false;
    std::signal(SIGINT, on_interrupt);
    std::signal(SIGTERM, on_interrupt);
    if (std::signal(SIGHUP, on_interrupt) == SIG_IGN) std::signal(SIGHUP, SIG_IGN); // nohup: the terminal may go
}

bool interrupted()
{
    return was_interrupted;
}

} // namespace haptel::tools
