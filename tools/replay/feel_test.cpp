#include "tools/replay/feel_test.h"

#include "input/regular_file.h"
#include "runtime/servo/trace_log.h"
#include "tools/output/replace_file.h"
#include "tools/replay/replay_run.h"
#include "tools/replay/traced_files.h"

#include <chrono>
#include <filesystem>
#include <fmt/format.h>

namespace haptel::tools {

namespace {

struct FeltNow {
    runtime::TraceResult recorded;
    std::filesystem::path scene;
    Replayed now;
    std::string fault;
};

FeltNow feel_again(const std::string& recording)
{
    FeltNow felt{runtime::read_trace(recording), {}, {}, {}};
    felt.fault = felt.recorded.error.empty() ? felt.recorded.note : felt.recorded.error;
    if (!felt.fault.empty()) return felt;
    felt.scene = scene_of(recording, felt.recorded);
    if (felt.scene.empty()) {
        felt.fault =
            "it does not say of which scene it is: record it again, haptel record SCENE.toml --out " + recording;
        return felt;
    }
    felt.now = replay_run(felt.scene, recording, felt.recorded);
    felt.fault = felt.now.fault;
    if (!felt.fault.empty()) felt.fault += "\n" + felt.now.diagnostics;
    return felt;
}

} // namespace

TestedFeel test_feel(const std::string& recording, double tolerance)
{
    TestedFeel tested;
    tested.file = recording;
    const auto start = std::chrono::steady_clock::now();
    FeltNow felt = feel_again(recording);
    tested.fault = std::move(felt.fault);
    if (tested.fault.empty()) {
        tested.difference = compare_felt(felt.recorded.records, felt.now.ticks, tolerance);
        tested.objects = std::move(felt.now.objects);
        tested.changed = changed_files(*felt.recorded.origin, felt.scene);
    }
    tested.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return tested;
}

bool update_feel(const std::string& recording, std::string& said)
{
    FeltNow felt = feel_again(recording);
    if (felt.fault.empty() && felt.now.ticks.size() != felt.recorded.records.size())
        felt.fault = "the replay ended early";
    if (felt.fault.empty() && felt.recorded.records.back().tick + 1 != felt.recorded.records.size())
        felt.fault = "ticks are missing in it: record it again";
    said = recording + ": not rewritten: " + felt.fault;
    if (!felt.fault.empty()) return false;
    const FeltDifference difference = compare_felt(felt.recorded.records, felt.now.ticks, 0);
    runtime::TraceOrigin origin = *felt.recorded.origin;
    origin.haptel = HAPTEL_VERSION;
    origin.files = std::move(felt.now.files);
    const std::string bytes = runtime::trace_log_bytes(origin, felt.now.ticks);
    if (input::read_regular_file(recording, runtime::trace_bytes_max).bytes == bytes) {
        said = recording + ": as it was";
        return true;
    }
    if (const std::string why = replace_file(recording, bytes); !why.empty()) {
        said = recording + ": not rewritten: " + why;
        return false;
    }
    said = fmt::format("{}: rewritten, {} of {} ticks feel otherwise", recording, difference.differing,
                       difference.recorded);
    return true;
}

} // namespace haptel::tools
