// A machine that costs a servo fewer deadlines of itself, so that what a test does shows: its processors do not sleep,
// as they wake late, and files are in memory, as a host may stop a virtual machine for the work of its disk.
#pragma once

#include "tests/support/catch.h"
#include "tests/support/folder.h"

#include <atomic>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <sched.h>
#include <string>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>
#include <utility>
#include <vector>

namespace haptel::test {

// On each processor that this process may use, a process that gives way to all other work and ends with this one.
class ProcessorsAwake {
public:
    ProcessorsAwake()
    {
        cpu_set_t usable;
        REQUIRE(sched_getaffinity(0, sizeof usable, &usable) == 0);
        for (int processor = 0; processor < CPU_SETSIZE; ++processor)
            if (CPU_ISSET(processor, &usable)) keep_awake(processor);
    }
    ~ProcessorsAwake()
    {
        for (const pid_t process : processes_) kill(process, SIGKILL), waitpid(process, nullptr, 0);
    }
    ProcessorsAwake(const ProcessorsAwake&) = delete;
    ProcessorsAwake& operator=(const ProcessorsAwake&) = delete;

private:
    void keep_awake(int processor)
    {
        const pid_t process = fork();
        REQUIRE(process >= 0);
        if (process > 0) return processes_.push_back(process);
        cpu_set_t own;
        CPU_ZERO(&own);
        CPU_SET(processor, &own);
        const sched_param lowest = {};
        prctl(PR_SET_PDEATHSIG, SIGKILL);
        if (sched_setaffinity(0, sizeof own, &own) != 0 || sched_setscheduler(0, SCHED_IDLE, &lowest) != 0) _exit(1);
        for (std::atomic<unsigned> turns = 0;; ++turns) {
        }
    }

    std::vector<pid_t> processes_;
};

// What is made meanwhile in temporary folders, and kept of compiled code, where the system has a folder in memory.
class FilesInMemory {
public:
    FilesInMemory()
    {
        if (access("/dev/shm", W_OK | X_OK) != 0) return;
        set("TMPDIR", "/dev/shm");
        folder_.emplace();
        set("HAPTEL_CACHE", folder_->file("cache"));
    }
    ~FilesInMemory()
    {
        for (const auto& [name, value] : before_)
            value ? setenv(name.c_str(), value->c_str(), 1) : unsetenv(name.c_str());
    }
    FilesInMemory(const FilesInMemory&) = delete;
    FilesInMemory& operator=(const FilesInMemory&) = delete;

private:
    void set(const std::string& name, const std::string& value)
    {
        const char* const was = getenv(name.c_str());
        before_.emplace_back(name, was ? std::optional<std::string>(was) : std::nullopt);
        setenv(name.c_str(), value.c_str(), 1);
    }

    std::optional<Folder> folder_;
    std::vector<std::pair<std::string, std::optional<std::string>>> before_;
};

} // namespace haptel::test
