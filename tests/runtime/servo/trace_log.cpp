// The binary recording: every bit comes back, wherever the file is cut, and whichever byte is changed is found.
#include "runtime/servo/trace_log.h"
#include "runtime/servo/trace_csv.h"
#include "tests/support/catch.h"
#include "tests/support/folder.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <random>
#include <sstream>
#include <string>
#include <sys/stat.h>
#include <vector>

using namespace haptel;
using namespace haptel::runtime;

namespace {

std::string bytes_of(const std::string& file)
{
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

TraceOrigin some_origin()
{
    TraceOrigin origin;
    origin.haptel = "0.1.0";
    origin.device = {"simulated:premium", 8.5, 800, 0, 0, 30e-6};
    origin.hand = 2;
    origin.rate_hz = 1000;
    origin.clock = "wall";
    origin.files = {{"scene", "a scene.toml", {1, 2}}, {"picture", "100%\nrust\x7f.png", {~0ull, 0x123}}};
    return origin;
}

// Bit patterns without a rule, those of NaN, infinities and subnormals among them.
std::vector<TickRecord> any_ticks(std::size_t count, uint64_t seed)
{
    std::mt19937_64 random(seed);
    const double special[] = {std::numeric_limits<double>::quiet_NaN(), std::bit_cast<double>(0xfff4000000000123),
                              -std::numeric_limits<double>::infinity(), std::numeric_limits<double>::denorm_min(),
                              -0.0};
    const auto any = [&] {
        return random() % 4 ? std::bit_cast<double>(random()) : special[random() % std::size(special)];
    };
    const auto whole = [&] { return static_cast<uint32_t>(random()); };
    std::vector<TickRecord> ticks(count);
    for (TickRecord& r : ticks)
        r = {random(),
             any(),
             {any(), any(), any()},
             {any(), any(), any()},
             {any(), any(), any()},
             {any(), any(), any()},
             any(),
             whole(),
             any(),
             any(),
             whole(),
             random(),
             random(),
             random(),
             random(),
             whole(),
             any(),
             whole(),
             whole(),
             whole()};
    return ticks;
}

// Every number of a tick as bits, written out here by hand.
std::vector<uint64_t> bits_of(const TickRecord& r)
{
    const auto d = [](double value) { return std::bit_cast<uint64_t>(value); };
    return {r.tick,         d(r.time_s),       d(r.tip_m.x),      d(r.tip_m.y),      d(r.tip_m.z),
            d(r.tail_m.x),  d(r.tail_m.y),     d(r.tail_m.z),     d(r.force_n.x),    d(r.force_n.y),
            d(r.force_n.z), d(r.torque_n_m.x), d(r.torque_n_m.y), d(r.torque_n_m.z), d(r.grip_force_n),
            r.contact,      d(r.depth_m),      d(r.height_m),     r.object,          r.compute_ns,
            r.woken_ns,     r.wake_late_ns,    r.binding,         r.faults,          d(r.device_force_max_n),
            r.degradation,  r.waiting,         r.interrupted};
}

bool same_bits(const std::vector<TickRecord>& a, const std::vector<TickRecord>& b, std::size_t count)
{
    if (a.size() < count || b.size() < count) return false;
    for (std::size_t i = 0; i < count; ++i)
        if (bits_of(a[i]) != bits_of(b[i])) return false;
    return true;
}

void record_to(const std::string& file, const std::vector<TickRecord>& ticks)
{
    TraceLog log(file, some_origin());
    for (const TickRecord& tick : ticks) log.add(tick);
    log.hand_over();
    REQUIRE(log.error() == "");
}

// As the layout in trace_log.h has it, read by hand.
struct Layout {
    std::size_t header_bytes, tick_bytes;
    std::string text;

    explicit Layout(const std::string& bytes)
    {
        uint32_t words[4];
        std::memcpy(words, bytes.data() + 8, sizeof words);
        header_bytes = 24 + words[2] + 8;
        tick_bytes = words[3];
        text = bytes.substr(24, words[2]);
    }
    // Where the number of that column stands in a tick.
    std::size_t place_of(const std::string& name) const
    {
        std::istringstream lines(text);
        std::size_t place = 0;
        for (std::string word, type, column; lines >> word;) {
            if (word != "column") {
                std::getline(lines, column);
                continue;
            }
            lines >> type >> column;
            if (column == name) return place;
            place += type == "u32" ? 4 : 8;
        }
        FAIL("there is no column " << name);
        return 0;
    }
};

} // namespace

TEST_CASE("a recording comes back bit for bit, whatever the numbers, with what it says of itself")
{
    const test::Folder folder;
    const std::string file = folder.file("run.haptrace");
    const auto ticks = any_ticks(700, 3); // more than what is handed over at once
    record_to(file, ticks);
    const TraceResult read = read_trace(file);
    CHECK(read.error == "");
    CHECK(read.note == "");
    CHECK(read.records.size() == ticks.size());
    CHECK(same_bits(read.records, ticks, ticks.size()));
    REQUIRE(read.origin);
    const TraceOrigin origin = some_origin();
    CHECK(read.origin->haptel == "0.1.0");
    CHECK(read.origin->device.name == "simulated:premium");
    CHECK(read.origin->device.force_max_n == 8.5);
    CHECK(read.origin->device.stiffness_max_n_per_m == 800);
    CHECK(read.origin->device.position_resolution_m == 30e-6);
    CHECK(read.origin->hand == 2);
    CHECK(read.origin->rate_hz == 1000);
    CHECK(read.origin->clock == "wall");
    CHECK(read.origin->files == origin.files);
    CHECK(read.origin->scene()->path == "a scene.toml");
}

TEST_CASE("a recording is what its layout says, and `head` shows what it is of")
{
    const test::Folder folder;
    const std::string file = folder.file("run.haptrace");
    const auto ticks = any_ticks(20, 5);
    record_to(file, ticks);
    const std::string bytes = bytes_of(file);
    const Layout layout(bytes);
    CHECK(bytes.starts_with(std::string("HAPTRACE") + "\x04\x03\x02\x01" + std::string("\x01\0\0\0", 4)));
    CHECK(layout.text.find("device simulated:premium\n") != std::string::npos);
    CHECK(bytes.size() == layout.header_bytes + ticks.size() * layout.tick_bytes);
    for (std::size_t i = 0; i < ticks.size(); ++i) {
        const char* tick = bytes.data() + layout.header_bytes + i * layout.tick_bytes;
        CHECK(std::memcmp(tick + layout.place_of("tick"), &ticks[i].tick, 8) == 0);
        CHECK(std::memcmp(tick + layout.place_of("fy_n"), &ticks[i].force_n.y, 8) == 0);
        CHECK(std::memcmp(tick + layout.place_of("degraded"), &ticks[i].degradation, 4) == 0);
    }
}

TEST_CASE("a recording cut at any byte is read up to the last whole tick")
{
    const test::Folder folder;
    const std::string file = folder.file("run.haptrace"), cut = folder.file("cut.haptrace");
    const bool is_large = GENERATE(false, true);
    const auto ticks = any_ticks(is_large ? 20'000 : 6, 7);
    record_to(file, ticks);
    const std::string bytes = bytes_of(file);
    const Layout layout(bytes);
    std::filesystem::copy_file(file, cut);
    std::mt19937_64 random(8);
    std::vector<std::size_t> places;
    for (std::size_t i = 0; i < (is_large ? 40 : bytes.size()); ++i)
        places.push_back(is_large ? random() % bytes.size() : i);
    std::sort(places.rbegin(), places.rend());
    for (const std::size_t place : places) {
        std::filesystem::resize_file(cut, place);
        const TraceResult read = read_trace(cut);
        CAPTURE(place, read.error, read.note);
        if (place < layout.header_bytes) {
            REQUIRE(read.error != "");
            REQUIRE(read.records.empty());
            if (place > 0)
                REQUIRE(read.error.find("cut after " + std::to_string(place) + " bytes") != std::string::npos);
            continue;
        }
        const std::size_t whole = (place - layout.header_bytes) / layout.tick_bytes;
        REQUIRE(read.error == "");
        REQUIRE(read.records.size() == whole);
        REQUIRE(same_bits(read.records, ticks, whole));
        REQUIRE(read.note.empty() == ((place - layout.header_bytes) % layout.tick_bytes == 0));
    }
}

TEST_CASE("a byte of a recording that is changed is found, with the tick it belongs to")
{
    const test::Folder folder;
    const std::string file = folder.file("run.haptrace");
    const auto ticks = any_ticks(5, 9);
    record_to(file, ticks);
    const std::string bytes = bytes_of(file);
    const Layout layout(bytes);
    std::mt19937_64 random(10);
    for (std::size_t place = 0; place < bytes.size(); ++place) {
        std::string changed = bytes;
        // One bit, or any.
        changed[place] = static_cast<char>(changed[place] ^ (place % 2 ? 1 << random() % 8 : 1 + random() % 255));
        const TraceResult read = read_trace(folder.write("changed.haptrace", changed));
        CAPTURE(place, read.error);
        REQUIRE(read.error != "");
        if (place < layout.header_bytes) {
            REQUIRE(read.records.empty());
            continue;
        }
        const std::size_t tick = (place - layout.header_bytes) / layout.tick_bytes;
        REQUIRE(read.records.size() == tick);
        REQUIRE(same_bits(read.records, ticks, tick));
        REQUIRE(read.error.find("the tick after the first " + std::to_string(tick) + " is damaged") !=
                std::string::npos);
    }
}

TEST_CASE("a tick that is lost, doubled or out of its place in a recording is found")
{
    const test::Folder folder;
    const std::string file = folder.file("run.haptrace");
    record_to(file, any_ticks(6, 11));
    const std::string bytes = bytes_of(file);
    const Layout layout(bytes);
    const auto place = [&](std::size_t tick) { return layout.header_bytes + tick * layout.tick_bytes; };
    const std::string third = bytes.substr(place(2), layout.tick_bytes);
    std::string lost = bytes, doubled = bytes, swapped = bytes;
    lost.erase(place(2), layout.tick_bytes);
    doubled.insert(place(2), third);
    swapped.replace(place(2), 2 * layout.tick_bytes, bytes.substr(place(3), layout.tick_bytes) + third);
    CHECK(read_trace(folder.write("lost", lost)).records.size() == 2);
    CHECK(read_trace(folder.write("lost", lost)).error != "");
    CHECK(read_trace(folder.write("doubled", doubled)).records.size() == 3);
    CHECK(read_trace(folder.write("doubled", doubled)).error != "");
    CHECK(read_trace(folder.write("swapped", swapped)).records.size() == 2);
}

TEST_CASE("a recording without what says nothing is smaller, and the rest of it comes back bit for bit")
{
    const test::Folder folder;
    auto ticks = any_ticks(50, 13);
    for (TickRecord& tick : ticks) {
        tick.tail_m = {tick.tip_m.x, 7, tick.tip_m.z}; // one axis tells
        tick.degradation = tick.faults = 0;
        tick.torque_n_m = {0, 0, -0.0}; // another bit pattern than 0
    }
    const std::string bytes = trace_log_bytes(some_origin(), ticks);
    const Layout layout(bytes);
    CHECK(layout.text.find(" tail_x_m\n") == std::string::npos);
    CHECK(layout.text.find(" tail_y_m\n") != std::string::npos);
    CHECK(layout.text.find(" degraded\n") == std::string::npos);
    CHECK(layout.text.find(" tqy_n_m\n") == std::string::npos);
    CHECK(layout.text.find(" tqz_n_m\n") != std::string::npos);
    const TraceResult read = read_trace(folder.write("small.haptrace", bytes));
    REQUIRE(read.error == "");
    for (TickRecord& tick : ticks)
        tick.compute_ns = tick.woken_ns = tick.wake_late_ns = tick.binding = 0; // of the machine
    CHECK(read.records.size() == ticks.size());
    CHECK(same_bits(read.records, ticks, ticks.size()));
}

TEST_CASE("what is recorded is in the file within moments, and the rest when the recording ends")
{
    const test::Folder folder;
    const std::string file = folder.file("run.haptrace");
    const auto ticks = any_ticks(3, 15);
    {
        TraceLog log(file, some_origin());
        CHECK(read_trace(file).error == ""); // at once: a recording without a tick
        log.add(ticks[0]);
        const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
        while (read_trace(file).records.empty() && std::chrono::steady_clock::now() < deadline) log.keep_up();
        CHECK(read_trace(file).records.size() == 1);
        log.add(ticks[1]);
        log.hand_over();
        CHECK(read_trace(file).records.size() == 2);
        log.add(ticks[2]);
    }
    CHECK(read_trace(file).records.size() == 3);
    record_to(file, {}); // a recording takes the place of another
    CHECK(read_trace(file).records.empty());
}

TEST_CASE("what is no recording is not written over, and what cannot be written is said")
{
    const test::Folder folder;
    const std::string precious = folder.write("scene.toml", "[[object]]\n"), pipe = folder.file("pipe");
    REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
    const auto error_of = [](const std::string& file) { return TraceLog(file, some_origin()).error(); };
    CHECK(error_of(precious) == "cannot write the recording '" + precious +
                                    "': it is there already and is not a recording; remove it or choose another name");
    CHECK(bytes_of(precious) == "[[object]]\n");
    CHECK(error_of(pipe).ends_with("it is not a regular file"));
    CHECK(error_of(folder.path.string()).ends_with("Is a directory"));
    CHECK(error_of(folder.file("none/run.haptrace")).ends_with("No such file or directory"));
}

TEST_CASE("recordings of other versions, byte orders and columns are told apart from damage")
{
    const test::Folder folder;
    const std::string bytes = trace_log_bytes(some_origin(), any_ticks(2, 17));
    const auto error_of = [&](std::size_t place, const std::string& with) {
        std::string changed = bytes;
        changed.replace(place, with.size(), with);
        return read_trace(folder.write("other.haptrace", changed)).error;
    };
    CHECK(error_of(8, "\x01\x02\x03\x04").find("recorded on a machine with the other byte order") != std::string::npos);
    CHECK(error_of(12, "\x02").find("a recording of version 2, and this Haptel reads version 1") != std::string::npos);
    CHECK(error_of(19, "\xff").find("header of the recording is damaged") != std::string::npos); // 4 GiB of text
}
