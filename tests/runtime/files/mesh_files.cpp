// Mesh files as they should not be: cut off, damaged, and what reads them crashing or never ending.
#include "runtime/files/mesh_process.h"
#include "runtime/process/fork_server.h"
#include "tests/support/catch.h"
#include "tests/support/folder.h"
#include "tests/support/mesh_bytes.h"
#include "tests/support/tries.h"

#include <atomic>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <limits>
#include <random>
#include <stdexcept>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

using namespace haptel;
using namespace haptel::runtime;

namespace {

constexpr MeshReadLimits hasty = {1, 20}, in_time = {60, 60};

std::size_t open_files()
{
    const std::filesystem::directory_iterator all("/proc/self/fd");
    return static_cast<std::size_t>(std::distance(begin(all), end(all)));
}

bool has_children()
{
    return waitpid(-1, nullptr, WNOHANG) >= 0 || errno != ECHILD;
}

std::string gave_up(MeshReader read, const MeshReadLimits& limits = hasty)
{
    start_fork_server();
    const std::size_t files = open_files();
    const MeshReading reading = read_in_own_process(read, "", limits);
    CHECK(reading.result.error.empty());
    CHECK(reading.result.mesh.triangles.empty());
    CHECK(open_files() == files);
    CHECK(!has_children());
    return reading.gave_up;
}

[[noreturn]] void for_ever()
{
    for (volatile bool go_on = true; go_on;) {
    }
    std::abort();
}

MeshFileResult complaint(const std::string& text)
{
    return {{}, text};
}

// Numbers of every kind.
MeshFileResult random_mesh(const std::string& seed)
{
    std::mt19937_64 random(std::stoull(seed));
    MeshFileResult result;
    result.warning = "beware";
    for (int i = 0; i < 1'200'000; ++i) { // more than one step of it
        result.mesh.positions_m.emplace_back(std::ldexp(double(random()), int(random() % 2000) - 1060), -0.0,
                                             std::numeric_limits<double>::quiet_NaN());
        result.mesh.uv.emplace_back(double(random()), std::numeric_limits<double>::infinity());
        result.mesh.triangles.push_back({uint32_t(random()), uint32_t(random()), uint32_t(random())});
        result.mesh.smoothing_groups.push_back(uint32_t(random()));
    }
    return result;
}

} // namespace

TEST_CASE("what is read in a process of its own arrives bit for bit")
{
    const MeshFileResult sent = random_mesh("1");
    const MeshReading reading = read_in_own_process(random_mesh, "1", in_time);
    CHECK(reading.gave_up.empty());
    CHECK(reading.result.error.empty());
    CHECK(reading.result.warning == "beware");
    const auto same = [](const auto& a, const auto& b) {
        return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof a[0]) == 0;
    };
    const Mesh& mesh = reading.result.mesh;
    CHECK(same(mesh.positions_m, sent.mesh.positions_m));
    CHECK(same(mesh.uv, sent.mesh.uv));
    CHECK(same(mesh.triangles, sent.mesh.triangles));
    CHECK(same(mesh.smoothing_groups, sent.mesh.smoothing_groups));

    const MeshReading refused = read_in_own_process(complaint, "not a mesh", hasty);
    CHECK(refused.result.error == "not a mesh");
    CHECK(refused.gave_up.empty());
}

TEST_CASE("a reader that crashes, stops, never ends or takes all memory ends alone, and it is told why")
{
    CHECK(gave_up([](const std::string&) -> MeshFileResult { std::raise(SIGSEGV), for_ever(); }) ==
          "it crashed (Segmentation fault)");
    CHECK(gave_up([](const std::string&) -> MeshFileResult { std::abort(); }) == "it crashed (Aborted)");
    CHECK(gave_up([](const std::string&) -> MeshFileResult { _exit(0); }) == "it ended early");
    CHECK(gave_up([](const std::string&) -> MeshFileResult { throw std::runtime_error("no"); }) == "it ended early");
    CHECK(gave_up([](const std::string&) -> MeshFileResult { for_ever(); }, {0.05, 60}) ==
          "it came to no end in 0.05 s of processor time");
    CHECK(gave_up([](const std::string&)
                      -> MeshFileResult { std::this_thread::sleep_for(std::chrono::hours(1)), for_ever(); },
                  {60, 0.05}) == "it came to no end in 0.05 s");
    CHECK(gave_up([](const std::string&) -> MeshFileResult {
              std::raise(SIGKILL), for_ever();
          }).starts_with("it was killed"));
    CHECK(gave_up([](const std::string&) -> MeshFileResult {
              throw std::bad_alloc();
          }).starts_with("it asked for more memory"));
    CHECK(gave_up([](const std::string&) -> MeshFileResult { return {{}, std::string(1 << 26, 'x')}; },
                  {60, 60, 1 << 24}) == "it asked for more memory than 16 MiB, or half of what this machine has");
}

TEST_CASE("threads read meshes at once")
{
    const test::Folder folder;
    const std::vector<test::MeshBytes> files = test::octahedron_files();
    for (std::size_t i = 0; i < files.size(); ++i) folder.write(std::to_string(i) + files[i].extension, files[i].bytes);
    std::atomic<int> read = 0;
    std::vector<std::thread> threads;
    for (int thread = 0; thread < 4; ++thread)
        threads.emplace_back([&] {
            for (std::size_t i = 0; i < files.size(); ++i)
                read += load_mesh(folder.path / (std::to_string(i) + files[i].extension)).mesh.triangles.size() == 8;
        });
    for (std::thread& thread : threads) thread.join();
    CHECK(read == 4 * int(files.size()));
}

TEST_CASE("a mesh file of any format that is cut off or damaged gives a mesh or an error in words, soon")
{
    const test::Folder folder;
    std::mt19937 random(7);
    std::string told;
    const auto load = [&](const test::MeshBytes& file, const std::string& bytes) {
        const std::filesystem::path path = folder.write("mesh" + file.extension, bytes);
        const MeshFileResult read = load_mesh(path, MeshReadLimits{0.1, 20}); // some never end
        CHECK(read.error.empty() != read.mesh.triangles.empty());
        told += read.error + "\n";
        return read;
    };
    for (const test::MeshBytes& file : test::octahedron_files()) {
        CAPTURE(file.extension, file.bytes.size());
        const MeshFileResult whole = load_mesh(folder.write("mesh" + file.extension, file.bytes));
        CHECK(whole.error == "");
        CHECK(whole.mesh.triangles.size() == 8);
        CHECK(whole.mesh.positions_m.size() >= 6);
        for (std::size_t part = 0; part < 20; part += test::is_sanitized ? 5 : 1) { // each in a process of its own
            const std::size_t length = file.bytes.size() * part / 20;
            CAPTURE(length);
            load(file, file.bytes.substr(0, length));
        }
        for (int time = 0; time < test::tries(20); ++time) {
            std::string bytes = file.bytes;
            for (int changes = 1 + int(random() % 3); changes > 0; --changes) {
                const std::size_t at = random() % bytes.size();
                bytes[at] = char(random() % 256);
            }
            CAPTURE(time);
            load(file, bytes);
        }
    }
    CHECK(told.find(" files gave up: it ") != std::string::npos); // else this shows nothing
    CHECK(told.find("the file may be damaged or cut off: export it again, or as OBJ or STL") != std::string::npos);
    CHECK(!has_children());
}

TEST_CASE("a mesh far from its origin is told with the rounding of its coordinates, one at the origin is not")
{
    const test::Folder folder;
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> within(-0.025, 0.025);
    // Told from 1e-5 * 0.05 * 2^24 = 8.39 on. At a million numbers lie 0.0625 apart: the last is between two of them.
    for (const double away : {0.0, 0.03, 2.0, 8.0, 9.0, 1e4, 1'000'000.03}) {
        CAPTURE(away);
        std::vector<glm::dvec3> exact;
        std::string obj = "v 1e9 0 0\n"; // which no face has
        for (int i = 0; i < 300; ++i) {
            exact.emplace_back(within(random), away + within(random), within(random));
            std::ostringstream line;
            line.precision(17);
            line << "v " << exact.back().x << " " << exact.back().y << " " << exact.back().z << "\n";
            obj += line.str();
            if (i % 3 == 2)
                obj += "f " + std::to_string(i) + " " + std::to_string(i + 1) + " " + std::to_string(i + 2) + "\n";
        }
        const MeshFileResult read = load_mesh(folder.write("mesh.obj", obj));
        CHECK(read.error == "");
        REQUIRE(read.mesh.positions_m.size() == exact.size());
        double error = 0;
        for (std::size_t i = 0; i < exact.size(); ++i)
            error = std::max(error, std::fabs(read.mesh.positions_m[i].y - exact[i].y));
        CAPTURE(error, read.warning);
        CHECK(read.warning.empty() == (away < 8.39));
        if (read.warning.empty()) {
            CHECK(error <= 1e-5 * 0.05);
            continue;
        }
        const auto number_after = [&](const std::string& words) {
            return std::stod(read.warning.substr(read.warning.find(words) + words.size()));
        };
        CHECK(std::fabs(number_after("as far from the origin as ") / away - 1) < 0.01);
        const double told = number_after("rounded by up to ");
        CHECK(error <= told * 1.005); // three digits of it
        CHECK(error >= told / 2.1);   // a half at most is what the number's power of two can give away
        // Each end of it is rounded, too; and 300 points come near the whole range.
        CHECK(std::fabs(number_after("its size is only ") * told - 0.05) < 2 * told + 0.002);
    }
}
