// What a command tells a script when it ends.
#pragma once

namespace haptel::tools {

// A promise to scripts. Warnings never change it.
enum class ExitCode : int {
    fine = 0,
    findings = 1, // errors in the input, a failed check
    misuse = 2,   // the command line itself
};

} // namespace haptel::tools
