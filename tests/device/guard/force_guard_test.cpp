// The last word to a device, here the other end of a socket: who says it, when, and when not.
#include "device/guard/force_guard.h"
#include "tests/support/catch.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <poll.h>
#include <string>
#include <string_view>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>
#include <vector>

using namespace haptel::device;

namespace {

using Clock = std::chrono::steady_clock;
constexpr int patience_ms = 20'000, moment_ms = 300;

struct GuardedDevice {
    std::array<int, 2> ends{-1, -1}; // ours, the device's

    GuardedDevice() { REQUIRE(socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) == 0); }
    ~GuardedDevice()
    {
        for (const int end : ends) close(end);
    }
    GuardedDevice(const GuardedDevice&) = delete;
    GuardedDevice& operator=(const GuardedDevice&) = delete;

    // What it hears within so many milliseconds.
    std::string hears(int within_ms) const
    {
        std::array<char, 64> bytes{};
        pollfd heard{ends[1], POLLIN, 0};
        if (poll(&heard, 1, within_ms) <= 0) return "";
        const ssize_t size = read(ends[1], bytes.data(), bytes.size());
        return {bytes.data(), static_cast<std::size_t>(std::max<ssize_t>(size, 0))};
    }
    static std::span<const uint8_t> last_word()
    {
        static constexpr std::string_view word = "no force";
        return {reinterpret_cast<const uint8_t*>(word.data()), word.size()};
    }
    ForceGuard guard() const { return {ends[0], 0, last_word()}; }
    // All until it has been silent for a moment: a program that is late by itself is silenced before its end, too.
    bool hears_words_alone() const
    {
        std::string all = hears(patience_ms);
        for (std::string more; !(more = hears(moment_ms)).empty();) all += more;
        const std::string word = "no force";
        for (std::size_t at = 0; at < all.size(); at += word.size())
            if (all.compare(at, word.size(), word) != 0) return false;
        return !all.empty();
    }
};

double milliseconds_since(Clock::time_point start)
{
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

// So short a time that no guard finds it long, whatever else the machine does.
template <typename Work>
bool is_for_a_moment(Work work)
{
    const auto start = Clock::now();
    work();
    return milliseconds_since(start) < guard_silence_ms / 2;
}

void pause_for(int ms)
{
    std::this_thread::sleep_for(std::chrono::milliseconds(ms));
}

// Of a program of its own, under a force for some milliseconds before its end.
template <typename End>
pid_t program_that_ends(const GuardedDevice& device, End end)
{
    const pid_t program = fork();
    if (program != 0) return program;
    const rlimit no_core{0, 0};
    setrlimit(RLIMIT_CORE, &no_core);
    for (const int number : {SIGABRT, SIGSEGV}) std::signal(number, SIG_DFL);
    ForceGuard guard = device.guard();
    for (int i = 0; i < 5; ++i) {
        guard.hear();
        pause_for(2);
    }
    end();
    _exit(0);
}

} // namespace

TEST_CASE("a guard takes the force away from a thread that is silent, and that is told once")
{
    const GuardedDevice device;
    ForceGuard guard = device.guard();
    pause_for(guard_hears_ms);
    std::vector<double> took_ms;
    for (int i = 0; i < 21; ++i) {
        const auto start = Clock::now();
        CHECK((guard.hear() || i == 0));
        CHECK(device.hears(patience_ms) == "no force");
        if (i > 0) took_ms.push_back(milliseconds_since(start)); // the first has to begin
    }
    std::sort(took_ms.begin(), took_ms.end());
    CHECK(took_ms.front() > guard_silence_ms - 1);
    WARN("the word came after " << took_ms[took_ms.size() / 2] << " ms in the median, the longest " << took_ms.back());
    CHECK(device.hears(moment_ms) == "");
    CHECK(guard.hear());
    CHECK(!guard.hear());
}

TEST_CASE("a guard writes its word to what is no socket")
{
    int ends[2];
    REQUIRE(pipe(ends) == 0);
    {
        const ForceGuard guard(ends[1], 0, GuardedDevice::last_word());
        std::array<char, 64> bytes{};
        pollfd heard{ends[0], POLLIN, 0};
        REQUIRE(poll(&heard, 1, patience_ms) == 1);
        const ssize_t size = read(ends[0], bytes.data(), bytes.size());
        CHECK(std::string(bytes.data(), static_cast<std::size_t>(std::max<ssize_t>(size, 0))) == "no force");
    }
    close(ends[0]);
    close(ends[1]);
}

TEST_CASE("a guard is silent while it hears of the stream, and after an end in order")
{
    const GuardedDevice device;
    const auto goes_on = [&] {
        ForceGuard guard = device.guard();
        bool in_time = true;
        for (int i = 0; i < 100; ++i)
            in_time = is_for_a_moment([&] {
                          pause_for(1);
                          guard.hear();
                      }) &&
                      in_time;
        return in_time;
    };
    const auto ends = [&] { return is_for_a_moment([&] { const ForceGuard guard = device.guard(); }); };
    int tried = 0; // a machine that is late by itself proves nothing
    for (int i = 0; i < 50 && tried < 6; ++i) {
        if (!(i % 2 == 0 ? goes_on() : ends())) {
            device.hears(moment_ms);
            continue;
        }
        ++tried;
        CHECK(device.hears(moment_ms) == "");
    }
    CHECK(tried > 0);
    const std::vector<uint8_t> long_word(ForceGuard::last_word_bytes_max + 1);
    ForceGuard nothing(device.ends[0], 0, {});
    nothing.hear();
    ForceGuard too_long(device.ends[0], 0, long_word);
    too_long.hear();
    CHECK(device.hears(moment_ms) == "");
}

TEST_CASE("however a program ends that holds a force, or is stopped, its device hears the last word")
{
    const GuardedDevice device;
    const auto null_pointer = [] {
        volatile int* volatile nowhere = nullptr;
        *nowhere = 1;
    };
    const auto says_its_word = [&](auto end) {
        const pid_t program = program_that_ends(device, end);
        return waitpid(program, nullptr, 0) == program && device.hears_words_alone();
    };
    CHECK(says_its_word([] { raise(SIGKILL); }));
    CHECK(says_its_word([] { std::abort(); }));
    CHECK(says_its_word(null_pointer));
    CHECK(says_its_word([] {})); // exit() without an end in order

    const pid_t stopped = program_that_ends(device, [] { raise(SIGSTOP); });
    CHECK(device.hears_words_alone());
    kill(stopped, SIGCONT); // it ends by _exit()
    CHECK(device.hears_words_alone());
    CHECK(waitpid(stopped, nullptr, 0) == stopped);
}
