// What is said to a person: on standard error, coloured only if a person is there to see it.
#pragma once

#include <string_view>

namespace haptel::tools {

// Standard error is a terminal: progress and live status may rewrite their line.
bool stderr_is_terminal();

// ... and colour is welcome on it (NO_COLOR unset, TERM not "dumb").
bool stderr_has_color();

// "haptel: error: text" and "haptel: warning: text", each on a line of its own.
void say_error(std::string_view text);
void say_warning(std::string_view text);

} // namespace haptel::tools
