#include "tools/output/terminal.h"

#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <unistd.h>

namespace haptel::tools {

bool stderr_is_terminal()
{
    return isatty(STDERR_FILENO) == 1;
}

bool stderr_has_color()
{
    const char* term = std::getenv("TERM");
    const char* no_color = std::getenv("NO_COLOR");
    return stderr_is_terminal() && !(no_color && *no_color) && !(term && std::string_view(term) == "dumb");
}

void Progress::show(double share)
{
    const auto now = std::chrono::steady_clock::now();
    if (now < next || !stderr_is_terminal()) return;
    next = now + std::chrono::milliseconds(100);
    is_shown = true;
    constexpr int width = 30;
    const int done = static_cast<int>(share * width);
    fmt::print(stderr, "\r[{:=<{}}{: <{}}] {:3.0f} %", "", done, "", width - done, 100 * share);
}

void Progress::hide()
{
    if (is_shown) fmt::print(stderr, "\r{:40}\r", "");
    is_shown = false;
}

void Steps::show(std::string_view doing)
{
    const auto now = std::chrono::steady_clock::now();
    if (now < next || doing == shown || !stderr_is_terminal()) return;
    next = now + std::chrono::milliseconds(500);
    shown = doing;
    fmt::print(stderr, "haptel: loading: {}\n", doing);
}

namespace {

void say(std::string_view kind, const char* color, std::string_view text)
{
    if (stderr_has_color())
        fmt::print(stderr, "haptel: \x1b[1;{}m{}:\x1b[0m {}\n", color, kind, text);
    else
        fmt::print(stderr, "haptel: {}: {}\n", kind, text);
}

} // namespace

void say_error(std::string_view text)
{
    say("error", "31", text);
}
void say_warning(std::string_view text)
{
    say("warning", "33", text);
}

} // namespace haptel::tools
