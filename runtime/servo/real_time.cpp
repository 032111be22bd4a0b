#include "runtime/servo/real_time.h"

#include <cerrno>
#include <cfenv>
#include <cstddef>

#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <time.h>

namespace haptel::runtime {

namespace {

constexpr int64_t ns_per_s = 1'000'000'000;

// Below the threads of the kernel's interrupts (50 and more where those are threads would be above: 80 is what
// cyclictest and audio servers use).
constexpr int fifo_priority = 80;

// Locking what is mapped later too is safe only without a limit: with one, a later allocation would fail.
bool may_lock_everything()
{
    rlimit limit = {};
    return getrlimit(RLIMIT_MEMLOCK, &limit) == 0 && limit.rlim_cur == RLIM_INFINITY;
}

void touch_stack()
{
    volatile std::byte stack[64 * 1024];
    for (std::size_t i = 0; i < sizeof(stack); i += 1024) stack[i] = std::byte{0};
}

int64_t read_ns(clockid_t clock) noexcept
{
    timespec now = {};
    clock_gettime(clock, &now);
    return int64_t{now.tv_sec} * ns_per_s + now.tv_nsec;
}

} // namespace

int64_t monotonic_ns() noexcept
{
    return read_ns(CLOCK_MONOTONIC);
}

int64_t processor_ns() noexcept
{
    return read_ns(CLOCK_THREAD_CPUTIME_ID);
}

void set_exact_floating_point() noexcept
{
    std::fesetenv(FE_DFL_ENV);
}

void use_exact_timers() noexcept
{
    prctl(PR_SET_TIMERSLACK, 1UL);
}

RealTime ask_for_real_time()
{
    RealTime result;
    touch_stack();
    if (mlockall(may_lock_everything() ? MCL_CURRENT | MCL_FUTURE : MCL_CURRENT) != 0)
        result.note = "memory could not be locked (raise `ulimit -l`)";
    sched_param priority = {};
    priority.sched_priority = fifo_priority;
    if (pthread_setschedparam(pthread_self(), SCHED_FIFO, &priority) != 0) {
        use_exact_timers();
        result.note += result.note.empty() ? "" : "; ";
        result.note += "real-time scheduling was refused (raise `ulimit -r` or run with CAP_SYS_NICE)";
    }
    result.granted = result.note.empty();
    return result;
}

std::string bind_to_core(unsigned core)
{
    cpu_set_t set;
    CPU_ZERO(&set);
    if (core < CPU_SETSIZE) CPU_SET(core, &set); // else it is empty, and refused
    if (pthread_setaffinity_np(pthread_self(), sizeof(set), &set) == 0) return {};
    return "the servo was not bound to processor " + std::to_string(core) +
           ": there is none of that number, or this process may not use it (see `taskset -p $$`)";
}

int64_t wait_until(int64_t deadline_ns, int64_t spin_ns) noexcept
{
    const int64_t wake_ns = deadline_ns - spin_ns;
    const timespec wake = {static_cast<time_t>(wake_ns / ns_per_s), static_cast<long>(wake_ns % ns_per_s)};
    if (monotonic_ns() < wake_ns)
        while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &wake, nullptr) == EINTR) {
        }
    int64_t now = monotonic_ns();
    while (now < deadline_ns) now = monotonic_ns();
    return now;
}

} // namespace haptel::runtime
