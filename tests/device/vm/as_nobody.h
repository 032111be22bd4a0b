// What a function says that runs as a user who may do nothing. Only root can ask that.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <sys/wait.h>
#include <unistd.h>

namespace haptel::device {

inline std::string as_nobody(const std::function<std::string()>& words)
{
    constexpr uid_t nobody = 65534;
    std::array<int, 2> ends{};
    if (pipe(ends.data()) != 0) return "no pipe";
    const pid_t child = fork();
    if (child == 0) {
        const bool became = setgid(nobody) == 0 && setuid(nobody) == 0;
        const std::string said = became ? words() : "cannot become another user";
        _exit(write(ends[1], said.data(), said.size()) == static_cast<ssize_t>(said.size()) ? 0 : 1);
    }
    close(ends[1]);
    std::string said;
    std::array<char, 256> part{};
    for (ssize_t size = 0; (size = read(ends[0], part.data(), part.size())) > 0;)
        said.append(part.data(), static_cast<std::size_t>(size));
    close(ends[0]);
    waitpid(child, nullptr, 0);
    return said;
}

} // namespace haptel::device
