// On what figures were taken.
#pragma once

#include <string>

namespace haptel::bench {

struct Machine {
    std::string cpu;    // as the system names it
    unsigned cores = 0; // hardware threads
    std::string isa;    // that our code is made for, as jit/codegen/isa.h names it
    std::string compiler, flags;
    std::string commit; // of the sources when the build was configured
};

Machine this_machine();

} // namespace haptel::bench
