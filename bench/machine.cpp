#include "bench/machine.h"

#include "jit/engine/engine.h"

#include <fstream>
#include <thread>

namespace haptel::bench {
namespace {

std::string cpu_name()
{
    std::ifstream info("/proc/cpuinfo");
    for (std::string line; std::getline(info, line);)
        if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
    return "unknown";
}

} // namespace

Machine this_machine()
{
#ifdef __clang__
    const char* const compiler = "clang " __clang_version__;
#else
    const char* const compiler = "g++ " __VERSION__;
#endif
    return {cpu_name(),   std::thread::hardware_concurrency(), jit::engine_info().isa, compiler, HAPTEL_FLAGS,
            HAPTEL_COMMIT};
}

} // namespace haptel::bench
