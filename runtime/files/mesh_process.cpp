#include "runtime/files/mesh_process.h"

#include "input/regular_file.h"
#include "runtime/process/fork_server.h"

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstring>
#include <exception>
#include <fstream>
#include <new>
#include <optional>
#include <sstream>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

namespace haptel::runtime {

namespace {

constexpr int exit_sent = 0, exit_memory = 1, exit_failed = 2;

// What comes before the reader's argument.
struct Job {
    MeshReader read;
    MeshReadLimits limits;
};

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

// Both ways.
template <class Result, class Pass>
bool pass_each(Result& result, Pass&& pass)
{
    auto& mesh = result.mesh;
    return pass(result.error) && pass(result.warning) && pass(mesh.positions_m) && pass(mesh.triangles) &&
           pass(mesh.uv) && pass(mesh.smoothing_groups) && pass(result.other_files);
}

bool receive_result(int pipe, MeshFileResult& result)
{
    const Mesh& mesh = result.mesh;
    const auto fits = [](std::size_t count, std::size_t all) { return count == 0 || count == all; };
    return pass_each(result, [&](auto& values) { return receive_values(pipe, values); }) &&
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
void limit_memory(std::uintmax_t memory_bytes)
{
    const auto page = static_cast<rlim_t>(sysconf(_SC_PAGESIZE));
    rlim_t pages_now = 0;
    const rlim_t half = static_cast<rlim_t>(sysconf(_SC_PHYS_PAGES)) / 2 * page;
    if (std::ifstream("/proc/self/statm") >> pages_now)
        lower(RLIMIT_AS, pages_now * page + std::min<rlim_t>(half, memory_bytes));
}

// Leaves no core, and is what goes first where memory ends.
void limit(const MeshReadLimits& limits)
{
    std::ofstream("/proc/self/oom_score_adj") << 1000;
    prctl(PR_SET_DUMPABLE, 0);
    limit_memory(limits.memory_bytes);
    start_timer(ITIMER_PROF, limits.processor_s);
    start_timer(ITIMER_REAL, limits.wall_s);
}

void be_the_reader(const std::string& request, int pipe)
try {
    Job job;
    std::memcpy(&job, request.data(), sizeof job);
    limit(job.limits);
    const MeshFileResult result = job.read(request.substr(sizeof job));
    _exit(pass_each(result, [&](const auto& values) { return send_values(pipe, values); }) ? exit_sent : exit_failed);
} catch (const std::bad_alloc&) {
    _exit(exit_memory);
} catch (...) {
    _exit(exit_failed);
}

std::string seconds(double number)
{
    std::ostringstream text;
    text.precision(3);
    text << number << " s";
    return text.str();
}

std::string why_it_ended(int status, const MeshReadLimits& limits)
{
    if (WIFEXITED(status))
        return WEXITSTATUS(status) != exit_memory ? "it ended early"
               : limits.memory_bytes > std::uintmax_t{1} << 40
                   ? "it asked for more memory than half of what this machine has"
                   : "it asked for more memory than " + input::size_in_words(limits.memory_bytes) +
                         ", or half of what this machine has";
    if (WTERMSIG(status) == SIGPROF)
        return "it came to no end in " + seconds(limits.processor_s) + " of processor time";
    if (WTERMSIG(status) == SIGALRM) return "it came to no end in " + seconds(limits.wall_s);
    if (WTERMSIG(status) == SIGKILL) return "it was killed, perhaps because memory ran out";
    return std::string("it crashed (") + strsignal(WTERMSIG(status)) + ")";
}

} // namespace

MeshReading read_in_own_process(MeshReader read, const std::string& argument, const MeshReadLimits& limits,
                                const Loading* loading)
{
    const auto failed = [](const std::string& why) { return MeshReading{{{}, why}, {}}; };
    const Job job{read, limits};
    std::string request(reinterpret_cast<const char*>(&job), sizeof job);
    request += argument;
    ForkedProcess reader(be_the_reader, request);
    if (!reader.error().empty()) return failed(reader.error());
    while (loading && !reader.answers_within(std::chrono::milliseconds(50))) {
        if (loading->stopped()) return failed(std::string(loading_was_stopped)); // and so is the reader
        if (loading->tell) loading->tell("reading it");
    }
    MeshReading reading;
    bool received = false;
    try {
        received = receive_result(reader.answer(), reading.result);
    } catch (const std::exception& problem) {
        reading = failed(problem.what());
        received = true;
    }
    const std::optional<int> status = reader.wait();
    if (received) return reading;
    if (!reader.error().empty()) return failed(reader.error());
    return {{}, status ? why_it_ended(*status, limits) : "it ended early"};
}

} // namespace haptel::runtime
