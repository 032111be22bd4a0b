// Processes of their own, without a fork of this one.
//
// fork() copies the page tables of all that a program holds while nobody may map or fault, and makes each of its pages
// fault at the next write: a servo that ticks meanwhile stands still, for milliseconds where there are hundreds of
// megabytes. So a small process is forked once, early, and forks for the program from then on. It ends with the
// program, however that ends, and is not its child: there is nothing to wait for, and no signal.
#pragma once

#include <chrono>
#include <optional>
#include <string>

namespace haptel::runtime {

// What a process does: gets the request, sends its answer into the pipe and calls _exit(). It has this thread alone and
// of the program only its code and what its memory held when the server was started: no file, no terminal, no handler
// of signals, no real-time priority; its folder is the root.
using ForkedMain = void (*)(const std::string& request, int answer);

// Nothing if it runs already. To be called before a servo starts and while the program is small: the pages that are
// there now are kept for the server's sake when the program writes to them. Without it, the first process starts it.
void start_fork_server() noexcept;

class ForkedProcess {
public:
    // A request is a path and some numbers, at most 8 KiB.
    ForkedProcess(ForkedMain main, const std::string& request);
    ~ForkedProcess(); // and ends it
    ForkedProcess(const ForkedProcess&) = delete;
    ForkedProcess& operator=(const ForkedProcess&) = delete;

    // Why there is no process; empty: there was one. Known for certain after wait().
    const std::string& error() const { return error_; }

    int answer() const { return answer_; } // to read from
    // Waits so long for something to read, or the end of it.
    bool answers_within(std::chrono::milliseconds time) const;

    // Reads no more: a process that still sends ends by that. How it ended, as waitpid() tells; nothing: nobody knows.
    std::optional<int> wait();

private:
    std::string error_;
    int answer_ = -1, ending_ = -1;
};

// What a companion does: it has its end of two connected sockets (SOCK_SEQPACKET), by which it learns of the program's
// end, and what else a process that is forked here has.
using CompanionMain = void (*)(int program);

// A process that nobody ends: it outlives the program for as long as it needs to. Returns the program's end of the
// sockets, or -1 and why. To close it is to the companion the end of the program.
int start_companion(CompanionMain main, std::string& error);

// All of it, or false.
bool send_bytes(int pipe, const void* bytes, std::size_t size);
bool receive_bytes(int pipe, void* bytes, std::size_t size);

} // namespace haptel::runtime
