#include "runtime/files/mesh_process.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstring>
#include <exception>
#include <fcntl.h>
#include <fstream>
#include <new>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

namespace haptel::runtime {

namespace {

constexpr int exit_sent = 0, exit_memory = 1, exit_failed = 2;

// One end of a pipe: all of it, or false.
bool send_bytes(int pipe, const void* bytes, std::size_t size)
{
    for (const char* at = static_cast<const char*>(bytes); size > 0;) {
        const ssize_t sent = write(pipe, at, size);
        if (sent < 0 && errno == EINTR) continue;
        if (sent <= 0) return false;
        at += sent;
        size -= static_cast<std::size_t>(sent);
    }
    return true;
}

bool receive_bytes(int pipe, void* bytes, std::size_t size)
{
    for (char* at = static_cast<char*>(bytes); size > 0;) {
        const ssize_t received = read(pipe, at, size);
        if (received < 0 && errno == EINTR) continue;
        if (received <= 0) return false;
        at += received;
        size -= static_cast<std::size_t>(received);
    }
    return true;
}

template <typename Values>
bool send_values(int pipe, const Values& values)
{
    const uint64_t count = values.size();
    return send_bytes(pipe, &count, sizeof count) && send_bytes(pipe, values.data(), count * sizeof values[0]);
}

// In steps: a count that is wrong meets the end of the pipe before it takes memory.
template <typename Values>
bool receive_values(int pipe, Values& values)
{
    constexpr uint64_t step = 1 << 20;
    uint64_t count = 0;
    if (!receive_bytes(pipe, &count, sizeof count)) return false;
    while (values.size() < count) {
        const std::size_t begin = values.size(), size = std::min(step, count - begin);
        values.resize(begin + size);
        if (!receive_bytes(pipe, &values[begin], size * sizeof values[0])) return false;
    }
    return true;
}

bool send_result(int pipe, const MeshFileResult& result)
{
    const Mesh& mesh = result.mesh;
    return send_values(pipe, result.error) && send_values(pipe, result.warning) &&
           send_values(pipe, mesh.positions_m) && send_values(pipe, mesh.triangles) && send_values(pipe, mesh.uv) &&
           send_values(pipe, mesh.smoothing_groups);
}

bool receive_result(int pipe, MeshFileResult& result)
{
    Mesh& mesh = result.mesh;
    const auto fits = [](std::size_t count, std::size_t all) { return count == 0 || count == all; };
    return receive_values(pipe, result.error) && receive_values(pipe, result.warning) &&
           receive_values(pipe, mesh.positions_m) && receive_values(pipe, mesh.triangles) &&
           receive_values(pipe, mesh.uv) && receive_values(pipe, mesh.smoothing_groups) &&
           fits(mesh.uv.size(), mesh.positions_m.size()) && fits(mesh.smoothing_groups.size(), mesh.triangles.size());
}

void lower(__rlimit_resource_t what, rlim_t most)
{
    rlimit limit;
    if (getrlimit(what, &limit) != 0) return;
    limit.rlim_cur = std::min(limit.rlim_cur, most);
    setrlimit(what, &limit);
}

void start_timer(__itimer_which_t clock, double seconds)
{
    const double whole = std::floor(seconds);
    const itimerval timer{{0, 0}, {static_cast<time_t>(whole), static_cast<suseconds_t>((seconds - whole) * 1e6)}};
    setitimer(clock, &timer, nullptr);
}

// Its own memory beside what it was born with.
void limit_memory()
{
    const auto page = static_cast<rlim_t>(sysconf(_SC_PAGESIZE));
    rlim_t pages_now = 0;
    if (std::ifstream("/proc/self/statm") >> pages_now)
        lower(RLIMIT_AS, (pages_now + static_cast<rlim_t>(sysconf(_SC_PHYS_PAGES)) / 2) * page);
}

// Nothing of the program but its memory: not its handlers of signals, its terminal, its files or its devices. It ends
// with the thread that waits for it, leaves no core, and is what goes first where memory ends.
int strip(int pipe, const MeshReadLimits& limits)
{
    for (int number = 1; number < NSIG; ++number) std::signal(number, SIG_DFL);
    sigset_t none;
    sigemptyset(&none);
    pthread_sigmask(SIG_SETMASK, &none, nullptr);
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    std::ofstream("/proc/self/oom_score_adj") << 1000;
    prctl(PR_SET_DUMPABLE, 0);

    const int nowhere = open("/dev/null", O_RDWR);
    constexpr int kept = 3;
    const int safe = fcntl(pipe, F_DUPFD, kept + 1); // `nowhere` or the pipe may be what is about to be replaced
    for (int standard = 0; standard < kept; ++standard) dup2(nowhere, standard);
    dup2(safe, kept);
    close_range(kept + 1, ~0U, 0);

    limit_memory();
    start_timer(ITIMER_PROF, limits.processor_s);
    start_timer(ITIMER_REAL, limits.wall_s);
    return kept;
}

[[noreturn]] void be_the_reader(const std::function<MeshFileResult()>& read, int pipe, const MeshReadLimits& limits)
try {
    pipe = strip(pipe, limits);
    _exit(send_result(pipe, read()) ? exit_sent : exit_failed);
} catch (const std::bad_alloc&) {
    _exit(exit_memory);
} catch (...) {
    _exit(exit_failed);
}

std::string seconds(double number)
{
    std::string text = std::to_string(number);
    text.erase(text.find_last_not_of('0') + 1);
    if (text.ends_with('.')) text.pop_back();
    return text + " s";
}

std::string why_it_ended(int status, const MeshReadLimits& limits)
{
    if (WIFEXITED(status))
        return WEXITSTATUS(status) == exit_memory ? "it asked for more memory than half of what this machine has"
                                                  : "it ended early";
    if (WTERMSIG(status) == SIGPROF)
        return "it came to no end in " + seconds(limits.processor_s) + " of processor time";
    if (WTERMSIG(status) == SIGALRM) return "it came to no end in " + seconds(limits.wall_s);
    if (WTERMSIG(status) == SIGKILL) return "it was ended from outside, perhaps for want of memory";
    return std::string("it crashed (") + strsignal(WTERMSIG(status)) + ")";
}

} // namespace

MeshReading read_in_own_process(const std::function<MeshFileResult()>& read, const MeshReadLimits& limits)
{
    const auto failed = [](const std::string& why) { return MeshReading{{{}, why}, {}}; };
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) return failed(std::string("no pipe could be opened: ") + std::strerror(errno));
    const auto [from, to] = ends;
    fcntl(to, F_SETPIPE_SZ, 1 << 20); // fewer turns between the two, where it is granted
    const pid_t reader = fork();
    if (reader == 0) be_the_reader(read, to, limits);
    const int fork_error = errno;
    close(to);
    if (reader < 0) {
        close(from);
        return failed(std::string("no process could be started: ") + std::strerror(fork_error));
    }
    MeshReading reading;
    bool received = false;
    try {
        received = receive_result(from, reading.result);
    } catch (const std::exception& problem) {
        reading = failed(problem.what());
        received = true;
    }
    close(from); // a reader that still sends ends by that
    int status = 0;
    pid_t ended;
    while ((ended = waitpid(reader, &status, 0)) < 0 && errno == EINTR) {
    }
    if (received) return reading;
    // Where the program reaps its children itself, or has them ignored, nobody knows how this one ended.
    return {{}, ended == reader ? why_it_ended(status, limits) : "it ended early"};
}

} // namespace haptel::runtime
