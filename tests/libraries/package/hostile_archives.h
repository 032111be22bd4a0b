// Archives that nobody means well with, or that came to harm on their way.
#pragma once

#include <string>
#include <vector>

namespace haptel::test {

struct HostileArchive {
    std::string what, bytes;
    std::string said; // what the refusal says, among other things
};
std::vector<HostileArchive> hostile_archives();

// The library wood 1.0.0, which they are made of, and which is right.
std::string sound_archive();

} // namespace haptel::test
