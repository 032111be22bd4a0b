#include "device/device_factory.h"
#include "runtime/render/renderer.h"
#include "runtime/servo/trace_csv.h"
#include "tests/support/catch.h"
#include "tests/support/folder.h"
#include "tests/support/touch_scenes.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sys/stat.h>
#include <unistd.h>
#include <vector>

using namespace haptel;
using namespace haptel::device;
using namespace haptel::runtime;

namespace {

// A file that is gone when the test is over.
struct TraceFile {
    std::filesystem::path path =
        std::filesystem::temp_directory_path() / ("haptel-replay-test-" + std::to_string(getpid()) + ".csv");
    ~TraceFile() { std::filesystem::remove(path); }

    void write(const std::vector<TickRecord>& records) const
    {
        std::ofstream out(path);
        write_trace_header(out);
        for (const TickRecord& record : records) write_trace_row(out, record);
    }
    DeviceResult open(double rate_hz = 1000) const
    {
        DeviceRequest request;
        request.name = "replay:" + path.string();
        request.rate_hz = rate_hz;
        return open_device(request);
    }
};

std::vector<TickRecord> spiral(std::size_t count)
{
    std::vector<TickRecord> records(count);
    for (std::size_t i = 0; i < count; ++i) {
        const double t = static_cast<double>(i);
        records[i].tick = i;
        records[i].time_s = t * 1e-3;
        records[i].tip_m = {std::sin(t) / 3, std::cos(t) * 1e-300, -0.0};
        records[i].tail_m = records[i].tip_m + glm::dvec3(0, 1.0 / 3, std::exp(-t));
    }
    return records;
}

} // namespace

TEST_CASE("a replay gives the recorded poses bit for bit and then has finished")
{
    const TraceFile file;
    const auto records = spiral(500);
    file.write(records);
    const DeviceResult opened = file.open();
    INFO(opened.error);
    REQUIRE(opened.device);
    DevicePose pose;
    for (const TickRecord& record : records) {
        REQUIRE(opened.device->read(pose) == DeviceStatus::ok);
        REQUIRE(opened.device->write({1, 2, 3}, {}) == DeviceStatus::ok); // which changes nothing
        REQUIRE(pose.tip_m == record.tip_m);
        REQUIRE(std::signbit(pose.tip_m.z));
        REQUIRE(pose.tail_m == record.tail_m);
    }
    CHECK(opened.device->read(pose) == DeviceStatus::finished);
    CHECK(opened.device->read(pose) == DeviceStatus::finished);
    CHECK(pose.tip_m == records.back().tip_m);
}

TEST_CASE("a replay repeats the forces after missed deadlines and interruptions")
{
    // A hand that presses through the plane at changing speed; the servo that felt it was late and interrupted.
    runtime::Scene scene = tests::bare_scene(tests::plane_mesh());
    scene.objects[0].material = {1000, 5, 0.3, 0.2};
    scene.servo.force_rise_s = 0.02;
    const auto touched = tests::shared(std::move(scene));
    Renderer felt(touched), repeated(touched);
    std::vector<TickRecord> records;
    double time = 0;
    for (uint64_t i = 0; i < 300; ++i) {
        DevicePose pose = tests::at(1e-4 * std::sin(time / 9), 0, 1e-3 * std::cos(time / 30));
        pose.periods = i % 7 == 0 ? 1 + i % 5 : 1;
        pose.interrupted = i % 90 == 89;
        time += static_cast<double>(pose.periods);
        const TickResult result = felt.tick(pose);
        TickRecord record;
        record.tick = i;
        record.time_s = result.time_s;
        record.tip_m = record.tail_m = pose.tip_m;
        record.force_n = result.force_n;
        record.interrupted = result.interrupted;
        records.push_back(record);
    }
    const TraceFile file;
    file.write(records);
    const DeviceResult opened = file.open();
    INFO(opened.error);
    REQUIRE(opened.device);
    DevicePose pose;
    for (const TickRecord& record : records) {
        REQUIRE(opened.device->read(pose) == DeviceStatus::ok);
        const TickResult result = repeated.tick(pose);
        REQUIRE(result.force_n == record.force_n);
        REQUIRE(result.time_s == record.time_s);
    }
}

TEST_CASE("a replay has the limit of the device that was recorded, and says which ticks are missing")
{
    const TraceFile file;
    auto records = spiral(20);
    for (TickRecord& record : records) record.device_force_max_n = 3.3;
    file.write(records);
    const DeviceResult whole = file.open();
    REQUIRE(whole.device);
    CHECK(whole.device->info().force_max_n == 3.3);
    CHECK(whole.warning.empty());

    records.erase(records.begin() + 7, records.begin() + 9);
    records.erase(records.begin() + 12);
    file.write(records);
    const DeviceResult gaps = file.open();
    REQUIRE(gaps.device);
    CHECK(gaps.warning.find("3 of 20 ticks are missing, the first of them tick 7:") != std::string::npos);

    records.erase(records.begin(), records.begin() + 2);
    file.write(records);
    CHECK(file.open().warning.find("5 of 20 ticks are missing, the first of them tick 0:") != std::string::npos);
}

TEST_CASE("a trace that cannot be replayed is refused with the reason")
{
    const TraceFile file;
    CHECK(file.open().error.find(file.path.string()) != std::string::npos); // missing

    file.write({});
    CHECK(file.open().error.find("no tick") != std::string::npos);

    auto records = spiral(10);
    file.write(records);
    CHECK(file.open(2000).error.find("recorded at 1000 Hz") != std::string::npos);

    records[5].time_s = 0.001;
    file.write(records);
    CHECK(file.open().error.find("tick 5 at 0.001 s follows tick 4 at 0.004 s") != std::string::npos);
    records[5].time_s = 0.005;

    records[4].tail_m.y = std::numeric_limits<double>::quiet_NaN();
    file.write(records);
    CHECK(file.open().error.find("tick 4 is not finite") != std::string::npos);

    std::ofstream(file.path) << "a,b,c\n1,2,3\n";
    CHECK(!file.open().device);
}

TEST_CASE("a replay of what is no regular file, or of a line without end, is refused by what it is")
{
    const test::Folder folder;
    const auto error = [](const std::string& file) {
        DeviceRequest request;
        request.name = "replay:" + file;
        const DeviceResult opened = open_device(request);
        CHECK(!opened.device);
        return opened.error.substr(std::min(file.size(), opened.error.size()));
    };
    const std::string expected = ":1: expected a trace (a CSV file as `haptel explore --out` writes it), but ";
    const std::string pipe = folder.file("pipe"), sparse = folder.write("sparse.csv", "");
    REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
    std::filesystem::resize_file(sparse, std::uintmax_t{1} << 35); // zeros, and no end of a line in them
    CHECK(error(pipe) == expected + "the trace is a pipe, not a regular file");
    CHECK(error("/dev/zero") == expected + "the trace is a device, not a regular file");
    CHECK(error(folder.path.string()) == expected + "the trace is a folder");
    CHECK(error(folder.file("none")) == expected + "the trace does not exist");
    CHECK(error(sparse) == expected + "a line of more than 16384 bytes is none of a trace");
    const std::string torn =
        folder.write("torn.csv", "tick,time_s,x_m,y_m,z_m,tail_x_m,tail_y_m,tail_z_m,fx_n,fy_n,fz_n,"
                                 "contact,depth_m,height_m,compute_ns,binding\n" +
                                     std::string(100'000, '1'));
    CHECK(error(torn) == ":2: a line of more than 16384 bytes is none of a trace");
}
