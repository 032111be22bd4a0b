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

} // namespace

int64_t monotonic_ns() noexcept
{
    timespec now = {};
    clock_gettime(CLOCK_MONOTONIC, &now);
    return int64_t{now.tv_sec} * ns_per_s + now.tv_nsec;
}

void set_exact_floating_point() noexcept
{
    std::fesetenv(FE_DFL_ENV);
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
        prctl(PR_SET_TIMERSLACK, 1UL);
        result.note += result.note.empty() ? "" : "; ";
        result.note += "real-time scheduling was refused (raise `ulimit -r` or run with CAP_SYS_NICE)";
    }
    result.granted = result.note.empty();
    return result;
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
