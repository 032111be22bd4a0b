// Two runs of one hand compared tick by tick: the forces that a recording holds, and those of its replay.
#pragma once

#include "runtime/servo/telemetry.h"
#include "tools/output/json.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace haptel::tools {

// A tick that felt otherwise.
struct FeltTick {
    runtime::TickRecord then, now;

    // How far the forces are apart: the force on the hand, N; the torque, N m; what pushes fingers apart, N. The
    // largest of the three numbers, and infinity where one is not finite.
    double apart() const;
};

struct FeltDifference {
    uint64_t recorded = 0, replayed = 0; // ticks
    uint64_t differing = 0;              // of those that both have
    std::optional<FeltTick> first, largest;

    bool is_equal() const { return differing == 0 && recorded == replayed; }
};

// Forces that are at most `tolerance` apart, N and N m, are equal; 0: the same numbers.
FeltDifference compare_felt(std::span<const runtime::TickRecord> recorded,
                            std::span<const runtime::TickRecord> replayed, double tolerance);

// A file that is not what it was when the recording was made.
struct ChangedFile {
    std::string kind, path;
    bool is_gone = false;
};

// `objects`: their names, in the order of the scene.
Json to_json(const FeltDifference& difference, const std::vector<std::string>& objects);
Json to_json(const std::vector<ChangedFile>& changed);

// What is not equal, a line each without its end; none: all is.
std::vector<std::string> lines_of(const FeltDifference& difference, const std::vector<std::string>& objects);
std::vector<std::string> lines_of(const std::vector<ChangedFile>& changed);

} // namespace haptel::tools
