// Code on disk through the command: whatever becomes of the folder, the answers are the same.
#include "tests/support/catch.h"
#include "tests/support/tries.h"
#include "tests/tools/commands/run_command.h"
#include "tools/output/json.h"

#include <thread>

using namespace haptel::test;
using haptel::tools::Json;
namespace fs = std::filesystem;

namespace {

const std::string texture =
    "texture t(float depth = 1mm) { return depth * (fbm(p / 3mm, 5) + noise(p / 1mm) * perlin(p / 2mm)); }\n";

std::vector<fs::path> objects_in(const fs::path& folder)
{
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(folder)) files.push_back(entry.path());
    return files;
}

Json status_of(const std::string& cache)
{
    const Ran ran = run_command("cache --json", "HAPTEL_CACHE='" + cache + "'");
    REQUIRE(ran.code == 0);
    return Json::parse(ran.out);
}

} // namespace

TEST_CASE("cache: shows, primes and empties; switched off or not to be used it says so")
{
    if (is_sanitized) return; // which takes long to compile all of the library
    const Folder folder;
    const std::string cache = folder.file("cache"), use = "HAPTEL_CACHE='" + cache + "'";
    CHECK(status_of(cache)["objects"] == 0);
    Ran ran = run_command("cache --prime --json", use);
    REQUIRE(ran.code == 0);
    const Json primed = Json::parse(ran.out);
    CHECK(primed["folder"] == cache);
    CHECK(primed["fault"].is_null());
    CHECK(primed["kernels_primed"].get<int>() > 50);
    CHECK(primed["objects"].get<int>() >= primed["kernels_primed"].get<int>());
    CHECK(primed["bytes"].get<uint64_t>() < primed["limit_bytes"].get<uint64_t>());
    CHECK(contains(run_command("cache", use).out, cache));
    ran = run_command("cache --clear", use);
    CHECK(contains(ran.out, primed["objects"].dump() + " objects removed, 0 surfaces"));
    CHECK(status_of(cache)["objects"] == 0);

    CHECK(contains(run_command("cache", "HAPTEL_CACHE=off").out, "switched off"));
    fs::permissions(cache, fs::perms::all);
    CHECK(status_of(cache)["fault"] == "others can write there");
    CHECK(contains(run_command("cache", use).err, "others can write there"));
    CHECK(contains(run_command("cache", "HAPTEL_CACHE='" + folder.write("file", "") + "'").err, "not a folder"));
    CHECK(run_command("cache", "HAPTEL_CACHE='" + folder.file("none") + "'").err.empty()); // made when it is needed
    CHECK(run_command("cache --empty", use).code == 2);
}

TEST_CASE("cache: XDG_CACHE_HOME, then HOME, where HAPTEL_CACHE says nothing; relative ones are none")
{
    const Folder folder;
    const auto folder_with = [&](const std::string& environment) {
        const Ran ran = run_command("cache --json", "env -u HAPTEL_CACHE -u XDG_CACHE_HOME -u HOME " + environment);
        REQUIRE(ran.code == 0);
        return Json::parse(ran.out)["folder"].get<std::string>();
    };
    CHECK(folder_with("XDG_CACHE_HOME=/x HOME=/h") == "/x/haptel");
    CHECK(folder_with("HOME=/h") == "/h/.cache/haptel");
    CHECK(folder_with("XDG_CACHE_HOME=x HOME=/h") == "/h/.cache/haptel");
    CHECK(folder_with("HOME=h").empty());
    CHECK(folder_with("HAPTEL_CACHE=/c XDG_CACHE_HOME=/x") == "/c");
    CHECK(folder_with("HAPTEL_CACHE=off XDG_CACHE_HOME=/x").empty());
}

TEST_CASE("cache: the same numbers with an empty folder, a full one, a damaged one and none")
{
    const Folder folder;
    const std::string cache = folder.file("cache");
    const std::string ask = "eval '" + folder.write("t.haptel", texture) + ":t' --at 1mm,2mm,3mm --json";
    const Ran none = run_command(ask, "HAPTEL_CACHE=off");
    REQUIRE(none.code == 0);
    const auto check_same = [&](const std::string& environment) {
        const Ran ran = run_command(ask, environment);
        INFO(environment << ": " << ran.err);
        CHECK(ran.code == 0);
        CHECK(ran.out == none.out);
        CHECK(ran.err == none.err);
    };
    const std::string use = "HAPTEL_CACHE='" + cache + "'";
    check_same(use);
    std::vector<fs::path> objects = objects_in(cache);
    // Kernels: the program's own, which has a slot for better code, is kept only where it took long.
    std::erase_if(objects, [](const fs::path& object) { return contains(read_file(object), "slot of entry"); });
    REQUIRE(objects.size() >= 3);
    std::vector<std::string> good;
    for (const fs::path& object : objects) good.push_back(read_file(object));
    check_same(use);

    for (int kind = 0; kind < 6; ++kind) {
        for (size_t i = 0; i < objects.size(); ++i) {
            std::string bytes = good[i];
            if (kind == 0) bytes.clear();
            if (kind == 1) bytes.resize(bytes.size() / 2);
            if (kind == 2) bytes[bytes.size() - 100] ^= 1;
            if (kind == 3) bytes = good[(i + 1) % good.size()]; // another one's
            if (kind == 4) bytes[0] = 'H';
            if (kind == 5) bytes += "more";
            std::ofstream(objects[i], std::ios::binary) << bytes;
        }
        INFO("damage of kind " << kind);
        check_same(use);
        for (size_t i = 0; i < objects.size(); ++i) CHECK(read_file(objects[i]) == good[i]); // mended
    }
    check_same("HAPTEL_ISA=baseline " + use);
    CHECK(objects_in(cache).size() > objects.size()); // code for another processor has other names
    for (size_t i = 0; i < objects.size(); ++i) CHECK(read_file(objects[i]) == good[i]);

    check_same("HAPTEL_CACHE=/proc/none");
    check_same("HAPTEL_CACHE='" + folder.file("t.haptel") + "'"); // a file
    check_same("HAPTEL_CACHE='" + folder.file("new") +
               "' sh -c 'trap \"\" XFSZ; ulimit -f 0; \"$0\" \"$@\"'"); // no byte can be written
}

TEST_CASE("cache: processes that begin at once share a folder")
{
    const Folder folder;
    const std::string ask = "eval '" + folder.write("t.haptel", texture) + ":t' --at 1mm,2mm,3mm";
    const std::string expected = run_command(ask, "HAPTEL_CACHE=off").out;
    const int rounds = is_sanitized ? 1 : 3; // four of what takes long to compile then
    for (int round = 0; round < rounds; ++round) {
        const std::string use = "HAPTEL_CACHE='" + folder.file("cache" + std::to_string(round)) + "'";
        std::vector<Ran> ran(4);
        std::vector<std::thread> threads;
        for (Ran& one : ran) threads.emplace_back([&] { one = run_command(ask, use); });
        for (std::thread& thread : threads) thread.join();
        for (const Ran& one : ran) {
            CHECK(one.code == 0);
            CHECK(one.out == expected);
        }
        for (const fs::path& object : objects_in(folder.file("cache" + std::to_string(round))))
            CHECK(object.extension() == ".object");
    }
}
