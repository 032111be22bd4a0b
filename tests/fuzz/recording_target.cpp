// Recorded runs, binary and as text: whatever the bytes, they are read or refused, and what is read is written and read
// again to the same bits.
#include "device/replay_device.h"
#include "runtime/servo/trace_csv.h"
#include "runtime/servo/trace_log.h"
#include "runtime/servo/trace_log_layout.h"
#include "tests/fuzz/target.h"
#include "tests/support/folder.h"

#include <algorithm>
#include <cstring>
#include <sstream>

namespace haptel::fuzz {

namespace {

using namespace haptel::runtime;

std::vector<TickRecord> few_ticks()
{
    std::vector<TickRecord> ticks(4);
    for (std::size_t i = 0; i < ticks.size(); ++i) {
        ticks[i].tick = i;
        ticks[i].time_s = static_cast<double>(i) * 1e-3;
        ticks[i].tip_m = {1e-3, -2e-3, 0.5 / static_cast<double>(i + 1)};
        ticks[i].tail_m = ticks[i].tip_m + glm::dvec3(0, 0, 0.1);
        ticks[i].force_n = {0, 0, static_cast<double>(i)};
        ticks[i].contact = i > 1;
    }
    return ticks;
}

TraceOrigin few_words()
{
    TraceOrigin origin;
    origin.haptel = "0.1.0";
    origin.device.name = "simulated:premium";
    origin.device.force_max_n = 8.5;
    origin.rate_hz = 1000;
    origin.clock = "virtual";
    origin.files = {{"scene", "scene.toml", {1, 2}}, {"texture", "100%.haptel", {3, 4}}};
    return origin;
}

// Puts the checksums right, so that what lies behind them is tried as well.
void mend(std::string& bytes)
{
    if (bytes.size() < log_fixed_bytes) return;
    uint32_t text_bytes = 0, tick_bytes = 0;
    std::memcpy(&text_bytes, bytes.data() + log_fixed_bytes - 2 * sizeof text_bytes, sizeof text_bytes);
    std::memcpy(&tick_bytes, bytes.data() + log_fixed_bytes - sizeof tick_bytes, sizeof tick_bytes);
    uint64_t sum = 0;
    std::size_t at = log_fixed_bytes + text_bytes;
    if (bytes.size() < at + sizeof sum) return;
    sum = log_sum(std::string_view(bytes).substr(0, at), 0);
    std::memcpy(bytes.data() + at, &sum, sizeof sum);
    at += sizeof sum;
    if (tick_bytes < sizeof sum) return;
    for (; bytes.size() - at >= tick_bytes; at += tick_bytes) {
        sum = log_sum(std::string_view(bytes).substr(at, tick_bytes - sizeof sum), sum);
        std::memcpy(bytes.data() + at + tick_bytes - sizeof sum, &sum, sizeof sum);
    }
}

} // namespace

// The first byte: M, the checksums are mended; another, they are left as they are.
void read_recording(std::string_view bytes)
{
    static const test::Folder folder;
    std::string text(bytes.substr(std::min<std::size_t>(1, bytes.size())));
    if (bytes.starts_with('M')) mend(text);
    const std::string file = folder.write("run", text);
    const TraceResult read = read_trace(file);
    count(read.error.empty() ? "read" : "refused");
    count("ticks", read.records.size());
    const DeviceResult device = device::replay_of("replay", file, read, 1000);
    if ((device.device == nullptr) == device.error.empty()) fail("neither a device nor a reason, or both");
    if (read.records.empty()) return;
    const TraceOrigin origin = read.origin.value_or(TraceOrigin{});
    const std::string again = trace_log_bytes(origin, read.records);
    const TraceResult twice = read_trace(folder.write("again", again));
    if (!twice.error.empty() || !twice.note.empty()) fail("what was written is refused: " + twice.error + twice.note);
    if (trace_log_bytes(*twice.origin, twice.records) != again) fail("what was written is read otherwise");
}

std::vector<std::string> recording_corpus()
{
    std::ostringstream csv;
    write_trace_header(csv);
    for (const TickRecord& tick : few_ticks()) write_trace_row(csv, tick);
    const std::string log = trace_log_bytes(few_words(), few_ticks());
    return {"-" + csv.str(), "-" + log, "M" + log};
}

} // namespace haptel::fuzz
