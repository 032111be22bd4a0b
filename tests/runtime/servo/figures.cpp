// What the servo measures and writes down: histogram, ring, trace, allocations.
#include "runtime/servo/allocation_count.h"
#include "runtime/servo/histogram.h"
#include "runtime/servo/telemetry.h"
#include "runtime/servo/trace_csv.h"
#include "tests/support/catch.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <memory>
#include <random>
#include <sstream>
#include <thread>
#include <vector>

using namespace haptel::runtime;

namespace {

std::filesystem::path scratch_file(const std::string& name)
{
    return std::filesystem::temp_directory_path() /
           ("haptel_" + std::to_string(std::hash<std::thread::id>()(std::this_thread::get_id())) + "_" + name);
}

TraceResult read_text(const std::string& text)
{
    const auto file = scratch_file("trace.csv");
    std::ofstream(file) << text;
    TraceResult result = read_trace(file);
    std::filesystem::remove(file);
    const std::string name = file.string();
    if (const auto at = result.error.find(name); at != std::string::npos) result.error.replace(at, name.size(), "FILE");
    return result;
}

} // namespace

TEST_CASE("percentiles are within a bucket of those of the sorted values")
{
    std::mt19937_64 random(5);
    std::lognormal_distribution<double> spread(7, 2);
    Histogram histogram;
    std::vector<uint64_t> values;
    for (int i = 0; i < 20000; ++i) {
        values.push_back(static_cast<uint64_t>(spread(random)));
        histogram.add(values.back());
    }
    std::sort(values.begin(), values.end());
    for (const double fraction : {0.001, 0.1, 0.5, 0.9, 0.99, 0.999, 1.0}) {
        const auto rank = static_cast<std::size_t>(std::ceil(fraction * 20000)) - 1;
        const auto exact = static_cast<double>(values[rank]);
        CAPTURE(fraction, exact);
        CHECK(static_cast<double>(histogram.percentile(fraction)) >= exact);
        CHECK(static_cast<double>(histogram.percentile(fraction)) <= exact * (1 + 1.0 / 31) + 1);
    }
    CHECK(histogram.maximum() == values.back());
    CHECK(histogram.percentile(1) == values.back());
}

TEST_CASE("a histogram holds every value there is, and its buckets join without gaps")
{
    Histogram histogram;
    CHECK(histogram.percentile(0.5) == 0);
    for (int bit = 0; bit < 64; ++bit)
        for (const uint64_t value : {uint64_t{1} << bit, (uint64_t{1} << bit) - 1}) histogram.add(value);
    histogram.add(std::numeric_limits<uint64_t>::max());
    uint64_t total = 0, next = 0;
    histogram.for_each([&](uint64_t first, uint64_t last, uint64_t count) {
        CHECK(first >= next);
        CHECK(last >= first);
        next = last == std::numeric_limits<uint64_t>::max() ? last : last + 1;
        total += count;
    });
    CHECK(total == 129);
}

TEST_CASE("the ring keeps order, counts what it drops, and never waits")
{
    SpscRing<int> ring(4);
    for (int i = 0; i < 6; ++i) CHECK(ring.push(i) == (i < 4));
    CHECK(ring.dropped() == 2);
    CHECK(ring.full());
    int value = -1;
    for (int i = 0; i < 4; ++i) {
        REQUIRE(ring.pop(value));
        CHECK(value == i);
    }
    CHECK_FALSE(ring.pop(value));
}

TEST_CASE("two threads: what comes out of the ring is what went in")
{
    SpscRing<uint64_t> ring(64);
    constexpr uint64_t count = 50000;
    std::thread writer([&] {
        for (uint64_t i = 0; i < count;)
            if (ring.push(i))
                ++i;
            else
                std::this_thread::yield();
    });
    uint64_t expected = 0, value = 0;
    bool in_order = true;
    while (expected < count)
        if (ring.pop(value))
            in_order = in_order && value == expected++;
        else
            std::this_thread::yield();
    writer.join();
    CHECK(in_order);
}

TEST_CASE("a trace comes back bit for bit")
{
    std::mt19937_64 random(11);
    std::ostringstream out;
    write_trace_header(out);
    std::vector<TickRecord> written;
    for (uint64_t i = 0; i < 200; ++i) {
        TickRecord r;
        r.tick = i;
        const auto any = [&] {
            double value = std::bit_cast<double>(random());
            return std::isfinite(value) ? value : 0.1;
        };
        r.time_s = any();
        r.tip_m = {any(), any(), any()};
        r.tail_m = {any(), -0.0, std::numeric_limits<double>::denorm_min()};
        r.force_n = {any(), any(), any()};
        r.contact = static_cast<uint32_t>(random());
        r.depth_m = any();
        r.height_m = any();
        r.compute_ns = random();
        r.binding = random();
        r.torque_n_m = {any(), any(), any()};
        r.grip_force_n = any();
        written.push_back(r);
        write_trace_row(out, r);
    }
    const TraceResult read = read_text(out.str());
    REQUIRE(read.error == "");
    REQUIRE(read.records.size() == written.size());
    const auto bits = [](double v) { return std::bit_cast<uint64_t>(v); };
    for (std::size_t i = 0; i < written.size(); ++i) {
        const TickRecord &a = written[i], &b = read.records[i];
        for (int axis = 0; axis < 3; ++axis) {
            CHECK(bits(a.tip_m[axis]) == bits(b.tip_m[axis]));
            CHECK(bits(a.tail_m[axis]) == bits(b.tail_m[axis]));
            CHECK(bits(a.force_n[axis]) == bits(b.force_n[axis]));
            CHECK(bits(a.torque_n_m[axis]) == bits(b.torque_n_m[axis]));
        }
        CHECK(bits(a.time_s) == bits(b.time_s));
        CHECK(bits(a.depth_m) == bits(b.depth_m));
        CHECK(bits(a.height_m) == bits(b.height_m));
        CHECK(bits(a.grip_force_n) == bits(b.grip_force_n));
        CHECK((a.tick == b.tick && a.contact == b.contact && a.compute_ns == b.compute_ns && a.binding == b.binding));
    }
}

TEST_CASE("a trace may have its columns in another order and more of them")
{
    const std::string text = "note,binding,compute_ns,height_m,depth_m,contact,fz_n,fy_n,fx_n,tail_z_m,tail_y_m,"
                             "tail_x_m,z_m,y_m,x_m,time_s,tick\r\nhello,1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16\r\n";
    const TraceResult read = read_text(text);
    REQUIRE(read.error == "");
    REQUIRE(read.records.size() == 1);
    CHECK(read.records[0].tick == 16);
    CHECK(read.records[0].tip_m == glm::dvec3(14, 13, 12));
    CHECK(read.records[0].force_n == glm::dvec3(8, 7, 6));
}

TEST_CASE("what is wrong with a trace is said with its line")
{
    std::ostringstream header_line;
    write_trace_header(header_line);
    const std::string header = header_line.str();
    CHECK(read_text("").error ==
          "FILE:1: expected a trace (a CSV file as `haptel explore --out` writes it), but the file is empty");
    CHECK(read_text("tick,time_s\n").error == "FILE:1: the trace has no column `x_m`");
    CHECK(read_text(header + "1,2\n").error == "FILE:2: expected 28 values, found 2");
    CHECK(
        read_text(header +
                  "1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16,0,7,0,1,2,3,4,0,0,0,0,0\n1,2,abc,4,5,6,7,8,9,10,11,12,13,14,"
                  "15,16,0,7,0,1,2,3,4,0,0,0,0,0\n")
            .error == "FILE:3: expected a number in column `x_m`, found `abc`");
    CHECK(read_text(std::string("\0\xff\x80garbage", 10)).error.starts_with("FILE:1: "));
}

TEST_CASE("allocations are counted, of this thread only, however they are made")
{
    const auto made = [](const auto& action) {
        const uint64_t before = allocations_of_this_thread();
        action();
        return allocations_of_this_thread() - before;
    };
    CHECK(made([] {}) == 0);
    void* volatile memory = nullptr; // volatile: the compiler may not remove the pair
    CHECK(made([&] {
              memory = std::malloc(8);
              std::free(memory);
          }) == 1);
    CHECK(made([&] {
              memory = ::operator new(8);
              ::operator delete(memory);
          }) == 1);
#if !defined(__SANITIZE_THREAD__) // its hook does not see this one
    CHECK(made([&] {
              memory = std::aligned_alloc(64, 64);
              std::free(memory);
          }) == 1);
#endif
    struct alignas(64) Wide {
        double values[8];
    };
    CHECK(made([&] {
              auto* wide = new Wide();
              memory = wide;
              delete wide;
          }) == 1);
    std::thread other;
    const uint64_t by_start = made([&] {
        other = std::thread([&] {
            for (int i = 0; i < 100; ++i) {
                memory = std::malloc(8);
                std::free(memory);
            }
        });
        other.join();
    });
    CHECK(by_start < 10);
}
