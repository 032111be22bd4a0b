#include "device/guard/force_guard.h"

#include "runtime/process/fork_server.h"
#include "runtime/servo/real_time.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <linux/usbdevice_fs.h>
#include <poll.h>
#include <sched.h>
#include <string>
#include <sys/ioctl.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace haptel::device {

namespace {

constexpr int64_t ns_per_ms = 1'000'000;
constexpr unsigned word_timeout_ms = 100;

enum class Said : uint8_t { word, alive, done };

// The first byte of a message; all but the word are no more. With the word comes the device's file descriptor.
struct Told {
    Said said = Said::done;
    uint8_t endpoint = 0;
    uint16_t size = 0;
    std::array<uint8_t, ForceGuard::last_word_bytes_max> bytes{};
};

struct Letter {
    Told told;
    iovec part{&told, sizeof told};
    alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(int))> control{};
    msghdr header{};

    Letter()
    {
        header.msg_iov = &part;
        header.msg_iovlen = 1;
    }
    Letter(const Letter&) = delete;
    Letter& operator=(const Letter&) = delete;

    cmsghdr* with_descriptor() noexcept
    {
        header.msg_control = control.data();
        header.msg_controllen = control.size();
        return CMSG_FIRSTHDR(&header);
    }
};

bool send_device(int socket, const Told& told, int file_descriptor) noexcept
{
    Letter letter;
    letter.told = told;
    cmsghdr* rights = letter.with_descriptor();
    rights->cmsg_level = SOL_SOCKET;
    rights->cmsg_type = SCM_RIGHTS;
    rights->cmsg_len = CMSG_LEN(sizeof file_descriptor);
    std::memcpy(CMSG_DATA(rights), &file_descriptor, sizeof file_descriptor);
    return sendmsg(socket, &letter.header, MSG_NOSIGNAL) >= 0;
}

void tell(int socket, Said said) noexcept
{
    (void)!send(socket, &said, sizeof said, MSG_DONTWAIT | MSG_NOSIGNAL);
}

// False: the program has ended.
bool receive(int socket, Told& told, int& device) noexcept
{
    Letter letter;
    letter.with_descriptor();
    ssize_t received;
    while ((received = recvmsg(socket, &letter.header, 0)) < 0 && errno == EINTR) {
    }
    if (received <= 0) return false;
    told = letter.told;
    if (const cmsghdr* rights = CMSG_FIRSTHDR(&letter.header)) std::memcpy(&device, CMSG_DATA(rights), sizeof device);
    return true;
}

// The kernel takes a transfer on behalf of whoever claimed the interface by this descriptor, be it stopped or dead.
void say(Told word, int device) noexcept
{
    if (word.endpoint == 0) {
        const ssize_t sent = send(device, word.bytes.data(), word.size, MSG_DONTWAIT | MSG_NOSIGNAL);
        if (sent < 0 && errno == ENOTSOCK) (void)!write(device, word.bytes.data(), word.size);
        return;
    }
    usbdevfs_bulktransfer transfer{word.endpoint, word.size, word_timeout_ms, word.bytes.data()};
    syscall(SYS_ioctl, device, USBDEVFS_BULK, &transfer);
}

void guard(int program)
{
    prctl(PR_SET_NAME, guard_process_name);
    const sched_param first{sched_get_priority_min(SCHED_FIFO)}; // before all that is ordinary, where that is allowed
    if (sched_setscheduler(0, SCHED_FIFO, &first) != 0) runtime::use_exact_timers();
    Told word;
    int device = -1;
    for (bool silenced = false;;) {
        pollfd heard{program, POLLIN, 0};
        if (poll(&heard, 1, silenced ? -1 : guard_silence_ms) == 0) {
            if (device >= 0) say(word, device);
            silenced = true;
            continue;
        }
        Told told;
        if (!receive(program, told, device)) break;
        if (told.said == Said::done) return;
        if (told.said == Said::word) word = told;
        silenced = false;
    }
    if (device >= 0) say(word, device);
} // and lets go of the device

} // namespace

ForceGuard::ForceGuard(int file_descriptor, uint8_t endpoint, std::span<const uint8_t> last_word) noexcept
{
    if (file_descriptor < 0 || last_word.empty() || last_word.size() > last_word_bytes_max) return;
    Told word{Said::word, endpoint, static_cast<uint16_t>(last_word.size())};
    std::copy(last_word.begin(), last_word.end(), word.bytes.begin());
    std::string without_a_guard;
    guard_ = runtime::start_companion(guard, without_a_guard);
    told_ns_ = runtime::monotonic_ns();
    if (guard_ < 0 || send_device(guard_, word, file_descriptor)) return;
    close(guard_);
    guard_ = -1;
}

ForceGuard::~ForceGuard()
{
    if (guard_ < 0) return;
    tell(guard_, Said::done);
    close(guard_);
}

bool ForceGuard::hear() noexcept
{
    if (guard_ < 0) return false;
    const int64_t now_ns = runtime::monotonic_ns();
    const int64_t silent_ns = now_ns - told_ns_;
    if (silent_ns < ns_per_ms * guard_hears_ms) return false;
    told_ns_ = now_ns;
    tell(guard_, Said::alive);
    // Sooner than the guard finds it long, so that no word is said that this does not know of.
    return silent_ns >= ns_per_ms * (guard_silence_ms - guard_hears_ms);
}

} // namespace haptel::device
