// What a recording says of itself: which scene, device and files it was felt with. Lines of text at the head of a
// binary recording, a word and its value each, so that `head` shows them.
#pragma once

#include "input/checksum.h"
#include "runtime/hand/haptic_device.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace haptel::runtime {

// A file that the forces depend on.
struct TracedFile {
    std::string kind; // "scene", "mesh", "texture", "picture"
    std::string path; // of the scene: seen from the recording's folder; of others: from the scene's
    input::Checksum sum;
    bool operator==(const TracedFile&) const = default;
};

struct TraceOrigin {
    std::string haptel; // the version that recorded
    DeviceInfo device;
    uint32_t hand = 1; // which device of the scene, from 1
    double rate_hz = 0;
    std::string clock; // "wall" | "virtual"
    std::vector<TracedFile> files;

    const TracedFile* scene() const; // null: not said
};

// Lines; no value can break out of its own.
std::string to_text(const TraceOrigin& origin);

// Takes a line of such a text apart, without its end. Words that are not known, and values that are none, change
// nothing: a later version may say more.
void read_line(std::string_view line, TraceOrigin& origin);

} // namespace haptel::runtime
