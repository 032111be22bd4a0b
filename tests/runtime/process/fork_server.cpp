// Meshes are read in processes that this one does not fork: what the servo feels of that, and what is left behind.
#include "runtime/process/fork_server.h"
#include "runtime/files/mesh_process.h"
#include "tests/support/catch.h"
#include "tests/support/folder.h"

#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>
#include <vector>

using namespace haptel;
using namespace haptel::runtime;
using namespace std::chrono_literals;

namespace {

constexpr MeshReadLimits patient = {60, 60};

MeshFileResult answer(const std::string& text)
{
    return {{}, text};
}

// Of what the reader says.
std::string said(MeshReader read, const std::string& argument = "")
{
    const MeshReading reading = read_in_own_process(read, argument, patient);
    return reading.result.error + reading.gave_up;
}

// In a program of its own, which has started no server yet.
bool in_a_copy(const std::function<bool()>& check)
{
    const pid_t copy = fork();
    if (copy == 0) _exit(check() ? 0 : 1);
    int status = 0;
    return copy > 0 && waitpid(copy, &status, 0) == copy && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

bool within(std::chrono::seconds time, const std::function<bool()>& reached)
{
    const auto end = std::chrono::steady_clock::now() + time;
    while (!reached()) {
        if (std::chrono::steady_clock::now() > end) return false;
        std::this_thread::sleep_for(1ms);
    }
    return true;
}

pid_t parent_of(pid_t process)
{
    std::string number, name, state;
    pid_t parent = 0;
    std::ifstream("/proc/" + std::to_string(process) + "/stat") >> number >> name >> state >> parent;
    return parent;
}

long faults_of_this_thread()
{
    rusage usage;
    getrusage(RUSAGE_THREAD, &usage);
    return usage.ru_minflt + usage.ru_majflt;
}

} // namespace

TEST_CASE("meshes that are read while a servo ticks do not make its pages fault")
{
    constexpr int pages = 256, reads = 20;
    const auto page_bytes = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
    std::vector<std::atomic<char>> memory(pages * page_bytes);
    std::atomic<int> ticks = 0;
    std::atomic<bool> over = false;
    long faults = 0;
    start_fork_server();
    std::thread servo([&] {
        const auto tick = [&] {
            for (std::size_t at = 0; at < memory.size(); at += page_bytes) memory[at].store(1);
            ticks.fetch_add(1);
        };
        tick();
        const long before = faults_of_this_thread();
        while (!over) tick();
        faults = faults_of_this_thread() - before;
    });
    for (int i = 0; i < reads; ++i) {
        const int now = ticks;
        while (ticks < now + 2) std::this_thread::yield();
        CHECK(said(answer, "arrived") == "arrived");
    }
    over = true;
    servo.join();
    CHECK(faults < pages); // of pages * reads, were this process forked every time
}

TEST_CASE("a reader has neither the files nor the terminal nor the signal handlers nor the folder of the program")
{
    const test::Folder folder;
    CHECK(in_a_copy([&] {
        static volatile std::sig_atomic_t handled = 0;
        std::signal(SIGSEGV, [](int) { handled = 1; });
        int ends[2];
        const int file = 100; // a number that no file of the reader has by chance
        if (pipe(ends) != 0 || dup2(ends[1], file) != file || chdir(folder.path.c_str()) != 0) return false;
        const std::string alone = said(
            [](const std::string& number) -> MeshFileResult {
                const bool wrote = write(std::stoi(number), "x", 1) == 1;
                std::puts("on the terminal");
                std::fflush(stdout);
                const std::filesystem::directory_iterator files("/proc/self/fd"); // 0 to 2, the answer, this one
                const bool more = std::distance(begin(files), end(files)) > 5;
                if (wrote || isatty(0) || more || std::filesystem::current_path() != "/") return {{}, "not alone"};
                std::raise(SIGSEGV);
                return {{}, "handled"};
            },
            std::to_string(file));
        return alone == "it crashed (Segmentation fault)" && handled == 0;
    }));
}

TEST_CASE("a program that is killed leaves no process behind")
{
    const test::Folder folder;
    const std::string sign = folder.file("sign");
    prctl(PR_SET_CHILD_SUBREAPER, 1); // orphans become children of this process
    const pid_t program = fork();
    if (program == 0) {
        said(
            [](const std::string& file) -> MeshFileResult {
                std::ofstream(file) << "reading\n";
                for (;;) pause();
            },
            sign);
        _exit(0);
    }
    CHECK(within(20s, [&] { return std::filesystem::exists(sign); }));
    kill(program, SIGKILL);
    CHECK(within(20s, [] {
        while (waitpid(-1, nullptr, WNOHANG) > 0) {
        }
        return errno == ECHILD;
    }));
    prctl(PR_SET_CHILD_SUBREAPER, 0);
}

TEST_CASE("Ctrl-C is not for who reads meshes; a server that somebody ended is started anew")
{
    const auto server = [](const std::string&) { return answer(std::to_string(parent_of(getppid()))); };
    CHECK(in_a_copy([&] {
        prctl(PR_SET_CHILD_SUBREAPER, 1);
        setpgid(0, 0);
        std::signal(SIGINT, SIG_IGN);
        const std::string first = said(server);
        kill(0, SIGINT);
        if (said(server) != first) return false;
        const pid_t ended = std::stoi(first);
        kill(ended, SIGKILL);
        if (waitpid(ended, nullptr, 0) != ended) return false;
        const std::string second = said(server);
        return second != first && said(server) == second;
    }));
}

TEST_CASE("a signal is no answer: who waits may look whether it is to stop")
{
    const auto before = std::signal(SIGUSR1, [](int) {});
    const ForkedProcess silent([](const std::string&, int) { pause(); }, "");
    std::atomic<bool> is_heard = false;
    std::thread sender([&, waiting = pthread_self()] {
        while (!is_heard) { // until it falls into the wait
            pthread_kill(waiting, SIGUSR1);
            std::this_thread::sleep_for(1ms);
        }
    });
    CHECK_FALSE(silent.answers_within(60s));
    is_heard = true;
    sender.join();
    std::signal(SIGUSR1, before);
}

TEST_CASE("a program that ignores the ends of its children still reads meshes, and hears of a crash")
{
    CHECK(in_a_copy([] {
        std::signal(SIGCHLD, SIG_IGN);
        return said(answer, "arrived") == "arrived" &&
               said([](const std::string&) -> MeshFileResult { std::abort(); }) == "it crashed (Aborted)";
    }));
}

TEST_CASE("a copy of a program that reads meshes has a server of its own")
{
    const auto server = [](const std::string&) { return answer(std::to_string(parent_of(getppid()))); };
    const std::string here = said(server);
    CHECK(said(server) == here);
    CHECK(in_a_copy([&] { return said(server) != here; }));
    CHECK(said(server) == here);
}

TEST_CASE("where no process can be started that is told, with what helps")
{
    CHECK(in_a_copy([] {
        if (geteuid() == 0 && setresuid(65534, 65534, 65534) != 0) return false; // root has no limit
        const rlimit none = {0, 0};
        setrlimit(RLIMIT_NPROC, &none);
        const MeshReading reading = read_in_own_process(answer, "", patient);
        return reading.gave_up.empty() &&
               reading.result.error ==
                   "no process could be started: Resource temporarily unavailable (raise `ulimit -u`)";
    }));
}
