// What is said to a person: on standard error, coloured only if a person is there to see it.
#pragma once

#include <chrono>
#include <string>
#include <string_view>

namespace haptel::tools {

// Standard error is a terminal: progress and live status may rewrite their line.
bool stderr_is_terminal();

// ... and colour is welcome on it (NO_COLOR unset, TERM not "dumb").
bool stderr_has_color();

// A line that says how much is done, where a person is there to see it and the work is long; gone at the end.
class Progress {
public:
    Progress() = default;
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;
    ~Progress() { hide(); }
    void show(double share); // 0 .. 1
    void hide();             // before anything else is printed

private:
    std::chrono::steady_clock::time_point next = std::chrono::steady_clock::now() + std::chrono::milliseconds(500);
    bool is_shown = false;
};

// What is being done, for who waits: a line each time that it changes, from half a second on.
class Steps {
public:
    void show(std::string_view doing); // often

private:
    std::chrono::steady_clock::time_point next = std::chrono::steady_clock::now() + std::chrono::milliseconds(500);
    std::string shown;
};

// "haptel: error: text" and "haptel: warning: text", each on a line of its own.
void say_error(std::string_view text);
void say_warning(std::string_view text);

} // namespace haptel::tools
