// haptel check --explain: what a finding means, with an example.
#pragma once

#include "tools/output/exit_code.h"

#include <string>

namespace haptel::tools {

// Of one code, or of all, a line each, where `code` is empty. A code that does not exist is misuse.
ExitCode explain(const std::string& code, bool json);

} // namespace haptel::tools
