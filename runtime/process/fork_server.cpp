#include "runtime/process/fork_server.h"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <mutex>
#include <poll.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <tuple>
#include <unistd.h>

namespace haptel::runtime {

namespace {

constexpr std::size_t request_bytes_max = 8192;

// What comes with a request, in this order.
enum { answer_end, ending_end, end_count };

struct Mains { // one of them
    ForkedMain forked = nullptr;
    CompanionMain companion = nullptr;
};

struct Request {
    Mains main;
    std::string text;
    std::array<int, end_count> ends{-1, -1};
};

struct Ending {
    int status = 0, fork_error = 0;
};

// A message and room for the descriptors that go with it.
struct Message {
    std::array<iovec, 2> parts;
    alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(int) * end_count)> control{};
    msghdr header{};

    Message(Mains* main, void* text, std::size_t size) : parts{{{main, sizeof *main}, {text, size}}}
    {
        header.msg_iov = parts.data();
        header.msg_iovlen = parts.size();
        header.msg_control = control.data();
        header.msg_controllen = control.size();
    }
};

bool send_request(int socket, Request request)
{
    Message message(&request.main, request.text.data(), request.text.size());
    cmsghdr* rights = CMSG_FIRSTHDR(&message.header);
    rights->cmsg_level = SOL_SOCKET;
    rights->cmsg_type = SCM_RIGHTS;
    rights->cmsg_len = CMSG_LEN(sizeof request.ends);
    std::memcpy(CMSG_DATA(rights), request.ends.data(), sizeof request.ends);
    return TEMP_FAILURE_RETRY(sendmsg(socket, &message.header, MSG_NOSIGNAL)) >= 0;
}

// Nothing: the program has ended.
std::optional<Request> receive_request(int socket)
{
    Request request;
    request.text.resize(request_bytes_max);
    Message message(&request.main, request.text.data(), request.text.size());
    const ssize_t received = TEMP_FAILURE_RETRY(recvmsg(socket, &message.header, 0));
    const cmsghdr* rights = CMSG_FIRSTHDR(&message.header);
    if (received < static_cast<ssize_t>(sizeof request.main) || !rights) return std::nullopt;
    std::memcpy(request.ends.data(), CMSG_DATA(rights), sizeof request.ends);
    request.text.resize(static_cast<std::size_t>(received) - sizeof request.main);
    return request;
}

// Leaves of the program nothing but its memory. Returns what `kept` is called now.
int strip(int kept)
{
    for (int number = 1; number < NSIG; ++number) std::signal(number, SIG_DFL);
    sigset_t none;
    sigemptyset(&none);
    pthread_sigmask(SIG_SETMASK, &none, nullptr);
    const sched_param normal{};
    sched_setscheduler(0, SCHED_OTHER, &normal);
    prctl(PR_SET_NAME, "haptel-forks");
    (void)!chdir("/");

    const int nowhere = open("/dev/null", O_RDWR);
    constexpr int first = 3;
    const int safe = fcntl(kept, F_DUPFD, first + 1); // `nowhere` or `kept` may be what is about to be replaced
    for (int standard = 0; standard < first; ++standard) dup2(nowhere, standard);
    dup2(safe, first);
    close_range(first + 1, ~0U, 0);
    return first;
}

[[noreturn]] void accompany(const Request& request)
{
    close(request.ends[1]);
    request.main.companion(request.ends[0]);
    _exit(EXIT_SUCCESS);
}

// Forks the process, and waits for its end or for that of who asked, which is its end, too.
[[noreturn]] void supervise(const Request& request)
{
    const auto [answer, ending_pipe] = request.ends;
    std::signal(SIGCHLD, SIG_DFL);
    const pid_t process = fork();
    if (process == 0) {
        close(ending_pipe);
        prctl(PR_SET_PDEATHSIG, SIGKILL);
        request.main.forked(request.text, answer);
        _exit(EXIT_FAILURE);
    }
    Ending ending{0, process < 0 ? errno : 0};
    close(answer);
    if (process > 0) {
        const auto ended = static_cast<int>(syscall(SYS_pidfd_open, process, 0)); // -1: only its own limits end it
        pollfd watched[] = {{ended, POLLIN, 0}, {ending_pipe, 0, 0}}; // of a pipe that nobody reads: POLLERR
        if (ended >= 0) TEMP_FAILURE_RETRY(poll(watched, 2, -1));
        if (watched[1].revents != 0) kill(process, SIGKILL);
        TEMP_FAILURE_RETRY(waitpid(process, &ending.status, 0));
    }
    send_bytes(ending_pipe, &ending, sizeof ending);
    _exit(EXIT_SUCCESS);
}

[[noreturn]] void serve(int socket) noexcept
{
    socket = strip(socket);
    std::signal(SIGCHLD, SIG_IGN); // supervisors leave nothing behind
    while (const std::optional<Request> request = receive_request(socket)) {
        const pid_t forked = fork();
        if (forked == 0) {
            close(socket);
            request->main.companion ? accompany(*request) : supervise(*request);
        }
        if (forked < 0 && request->main.forked) {
            const Ending ending{0, errno};
            send_bytes(request->ends[ending_end], &ending, sizeof ending);
        }
        for (const int end : request->ends) close(end);
    }
    _exit(EXIT_SUCCESS);
}

std::string no_process(int error)
{
    return std::string("no process could be started: ") + std::strerror(error) +
           (error == EAGAIN ? " (raise `ulimit -u`)" : "");
}

class Server {
public:
    // False: there is none, and `error` tells why.
    bool start(std::string& error)
    {
        const std::lock_guard lock(mutex_);
        return started(error);
    }

    bool send(const Request& request, std::string& error)
    {
        const std::lock_guard lock(mutex_);
        for (int attempt = 0; attempt < 2; ++attempt) { // somebody may have ended it
            if (!started(error)) return false;
            if (send_request(socket_, request)) {
                error.clear();
                return true;
            }
            error = std::string("the process that starts others does not answer: ") + std::strerror(errno);
            close(socket_);
            socket_ = -1;
        }
        return false;
    }

private:
    using Owner = std::tuple<pid_t, uid_t, gid_t>;

    bool started(std::string& error)
    {
        // A forked copy of the program needs one of its own, and so does one that gave up its rights.
        const Owner now{getpid(), geteuid(), getegid()};
        if (socket_ >= 0 && owner_ == now) return true;
        if (socket_ >= 0) close(socket_);
        socket_ = -1;
        int ends[2];
        if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends) != 0) {
            error = std::string("no socket could be opened: ") + std::strerror(errno);
            return false;
        }
        // Twice, so that the server is nobody's child; in a session of its own, so that Ctrl-C is not for it.
        const pid_t between = fork();
        int fork_error = errno;
        if (between == 0) {
            setsid();
            const pid_t server = fork();
            if (server == 0) serve(ends[1]);
            _exit(server < 0 ? errno : EXIT_SUCCESS);
        }
        close(ends[1]);
        int status = 0;
        if (between > 0) {
            TEMP_FAILURE_RETRY(waitpid(between, &status, 0));
            fork_error = WIFEXITED(status) ? WEXITSTATUS(status) : 0;
        }
        if (fork_error != 0) {
            close(ends[0]);
            error = no_process(fork_error);
            return false;
        }
        socket_ = ends[0];
        owner_ = now;
        return true;
    }

    std::mutex mutex_;
    int socket_ = -1; // until the program ends: that is what ends the server
    Owner owner_;
};

Server& server()
{
    static Server one;
    return one;
}

} // namespace

bool send_bytes(int pipe, const void* bytes, std::size_t size)
{
    for (const char* at = static_cast<const char*>(bytes); size > 0;) {
        const ssize_t sent = TEMP_FAILURE_RETRY(write(pipe, at, size));
        if (sent <= 0) return false;
        at += sent;
        size -= static_cast<std::size_t>(sent);
    }
    return true;
}

bool receive_bytes(int pipe, void* bytes, std::size_t size)
{
    for (char* at = static_cast<char*>(bytes); size > 0;) {
        const ssize_t received = TEMP_FAILURE_RETRY(read(pipe, at, size));
        if (received <= 0) return false;
        at += received;
        size -= static_cast<std::size_t>(received);
    }
    return true;
}

void start_fork_server() noexcept
try {
    std::string told_by_the_first_process;
    server().start(told_by_the_first_process);
} catch (...) {
}

int start_companion(CompanionMain main, std::string& error)
{
    int ends[2];
    if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends) != 0) {
        error = std::string("no socket could be opened: ") + std::strerror(errno);
        return -1;
    }
    const bool sent = server().send({{nullptr, main}, "", {ends[1], ends[1]}}, error);
    close(ends[1]);
    if (sent) return ends[0];
    close(ends[0]);
    return -1;
}

ForkedProcess::ForkedProcess(ForkedMain main, const std::string& request)
{
    if (request.size() > request_bytes_max) {
        error_ = "the request is too long";
        return;
    }
    int answer[2] = {-1, -1}, ending[2] = {-1, -1};
    if (pipe2(answer, O_CLOEXEC) != 0 || pipe2(ending, O_CLOEXEC) != 0)
        error_ = std::string("no pipe could be opened: ") + std::strerror(errno);
    answer_ = answer[0], ending_ = ending[0];
    fcntl(answer[1], F_SETPIPE_SZ, 1 << 20); // fewer turns between the two, where it is granted
    if (error_.empty()) server().send({{main, nullptr}, request, {answer[1], ending[1]}}, error_);
    for (const int end : {answer[1], ending[1]})
        if (end >= 0) close(end);
}

ForkedProcess::~ForkedProcess()
{
    for (const int end : {answer_, ending_})
        if (end >= 0) close(end);
}

bool ForkedProcess::answers_within(std::chrono::milliseconds time) const
{
    pollfd end{answer_, POLLIN, 0};
    const int ready = poll(&end, 1, static_cast<int>(time.count()));
    return ready > 0 || (ready < 0 && errno != EINTR); // a signal is no answer: who waits may want to stop
}

std::optional<int> ForkedProcess::wait()
{
    if (answer_ >= 0) close(answer_);
    answer_ = -1;
    Ending ending;
    if (ending_ < 0 || !receive_bytes(ending_, &ending, sizeof ending)) return std::nullopt;
    if (ending.fork_error != 0) {
        error_ = no_process(ending.fork_error);
        return std::nullopt;
    }
    return ending.status;
}

} // namespace haptel::runtime
