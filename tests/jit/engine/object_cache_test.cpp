// Objects on disk: whole or absent, whatever lies in the folder and whoever else is at work there.
#include "jit/engine/object_cache.h"
#include "tests/support/catch.h"
#include "tests/support/folder.h"

#include <chrono>
#include <fstream>
#include <iterator>
#include <sys/stat.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>
#include <vector>

using namespace haptel;
using jit::ObjectCache;
namespace fs = std::filesystem;

namespace {

const jit::ContentHash key = jit::content_hash("what it is made of"), other_key = jit::content_hash("something else");
const std::string object = std::string("\177ELF\0 and what follows", 21) + std::string(5000, '\x5a');

std::string bytes_of(const fs::path& path)
{
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

std::vector<fs::path> files_in(const fs::path& folder)
{
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(folder)) files.push_back(entry.path());
    return files;
}

} // namespace

TEST_CASE("what is stored is found by its key and by no other, in this process and in the next")
{
    const test::Folder folder;
    ObjectCache cache(folder.path / "made" / "here");
    CHECK_FALSE(cache.load(key));
    cache.store(key, object);
    CHECK(cache.load(key) == object);
    CHECK_FALSE(cache.load(other_key));
    CHECK(ObjectCache(folder.path / "made" / "here").load(key) == object);
    CHECK((cache.status().files == 1 && cache.status().fault.empty() && cache.status().bytes > object.size()));
    cache.store(key, "another");
    CHECK(cache.load(key) == "another");
    CHECK(files_in(folder.path / "made" / "here").size() == 1);
    CHECK(cache.clear() == 1);
    CHECK_FALSE(cache.load(key));

    ObjectCache off("");
    off.store(key, object);
    CHECK_FALSE(off.load(key));
    CHECK(off.status().fault == "switched off");
}

TEST_CASE("a damaged file is as good as none, and is replaced")
{
    const test::Folder folder;
    ObjectCache cache(folder.path / "cache");
    cache.store(key, object);
    const fs::path path = files_in(folder.path / "cache").at(0);
    const std::string good = bytes_of(path);
    std::vector<std::string> damaged{"", "\n", "haptel object 1\n", std::string(good.size(), '\0'), good + "x"};
    for (size_t length : {size_t{1}, size_t{20}, size_t{48}, good.size() / 2, good.size() - 1})
        damaged.push_back(good.substr(0, length));
    for (size_t at = 0; at < good.size(); at += at < 80 ? 1 : 97) { // every part of the head, some of the object
        damaged.push_back(good);
        damaged.back()[at] ^= 4;
    }
    for (const std::string& bytes : damaged) {
        std::ofstream(path, std::ios::binary) << bytes;
        REQUIRE_FALSE(cache.load(key));
        cache.store(key, object);
        REQUIRE(cache.load(key) == object);
    }
    // A whole object, under the name of another.
    cache.store(other_key, "another");
    fs::path other_path;
    for (const fs::path& file : files_in(folder.path / "cache"))
        if (file != path) other_path = file;
    fs::copy_file(other_path, path, fs::copy_options::overwrite_existing);
    CHECK_FALSE(cache.load(key));
}

TEST_CASE("what is no file of ours is not read, and nothing waits for it")
{
    const test::Folder folder;
    ObjectCache cache(folder.path / "cache");
    cache.store(key, object);
    const fs::path path = files_in(folder.path / "cache").at(0), kept = folder.path / "kept";
    fs::rename(path, kept);
    fs::create_symlink(kept, path);
    CHECK_FALSE(cache.load(key));
    fs::remove(path);
    REQUIRE(mkfifo(path.c_str(), 0600) == 0);
    CHECK_FALSE(cache.load(key));
    fs::remove(path);
    fs::create_directory(path);
    CHECK_FALSE(cache.load(key));
    cache.store(key, object); // cannot be; and leaves nothing behind
    CHECK_FALSE(cache.load(key));
    CHECK(files_in(folder.path / "cache").size() == 1);
}

TEST_CASE("a folder that others can write, or that cannot be, is not used")
{
    const test::Folder folder;
    ObjectCache cache(folder.path / "cache");
    cache.store(key, object);
    REQUIRE(cache.load(key));
    for (mode_t mode : {0777u, 0770u, 0702u}) {
        chmod((folder.path / "cache").c_str(), mode);
        CHECK_FALSE(cache.load(key));
        CHECK(cache.status().fault == "others can write there");
        cache.store(other_key, object);
        CHECK(cache.status().files == 1);
    }
    chmod((folder.path / "cache").c_str(), 0755);
    CHECK(cache.load(key) == object);

    folder.write("file", "no folder");
    for (const fs::path& path : {folder.path / "file", folder.path / "file" / "below", fs::path("/proc/none/of/it"),
                                 folder.path / std::string(300, 'x')}) {
        ObjectCache impossible(path);
        impossible.store(key, object);
        CHECK_FALSE(impossible.load(key));
        CHECK_FALSE(impossible.status().fault.empty());
        CHECK(impossible.clear() == 0);
    }
    CHECK(bytes_of(folder.path / "file") == "no folder");

    if (geteuid() != 0) { // root may write everywhere
        chmod((folder.path / "cache").c_str(), 0500);
        cache.store(other_key, object);
        CHECK_FALSE(cache.load(other_key));
        chmod((folder.path / "cache").c_str(), 0700);
    }
}

// Only root can give a file away. What lies in a folder of one's own may still be another's: it was open to others
// once, or one's own name was another's.
TEST_CASE("code that belongs to somebody else is not run, nor what lies in a folder of somebody else")
{
    if (geteuid() != 0) return;
    const test::Folder folder;
    const fs::path path = folder.path / "cache";
    constexpr uid_t somebody = 65534;
    ObjectCache cache(path);
    cache.store(key, object);
    const fs::path file = files_in(path).at(0);
    REQUIRE(cache.load(key) == object);
    REQUIRE(chown(file.c_str(), somebody, 0) == 0);
    CHECK_FALSE(cache.load(key));
    cache.store(key, object); // in its place, as one's own
    CHECK(cache.load(key) == object);
    REQUIRE(chown(path.c_str(), somebody, 0) == 0);
    CHECK_FALSE(cache.load(key));
    CHECK(cache.status().fault == "it belongs to somebody else");
    REQUIRE(chown(path.c_str(), 0, 0) == 0);
    CHECK(cache.load(key) == object);
}

TEST_CASE("beyond the limit what was used least lately goes, and what a dead process left behind")
{
    const test::Folder folder;
    const fs::path path = folder.path / "cache";
    const auto key_of = [](int i) { return jit::content_hash(std::to_string(i)); };
    {
        ObjectCache cache(path);
        for (int i = 0; i < 20; ++i) cache.store(key_of(i), object);
    }
    const auto now = fs::file_time_type::clock::now();
    for (int i = 0; i < 20; ++i) // the last one is the oldest
        fs::last_write_time(path / (jit::to_text(key_of(i)) + ".object"), now - std::chrono::minutes(10 + i));
    CHECK(ObjectCache(path).load(key_of(19))); // used now
    folder.write("cache/unfinished-old", "?");
    fs::last_write_time(path / "unfinished-old", now - std::chrono::hours(2));
    folder.write("cache/unfinished-new", "?");
    folder.write("cache/notes.txt", "not ours");

    ObjectCache small(path, 10 * 5100);
    small.store(key_of(20), object);
    CHECK(small.status().bytes <= 10 * 5100 / 4 * 3);
    CHECK(small.status().files == 7);
    for (int kept : {20, 19, 0, 1, 4}) CHECK(small.load(key_of(kept)));
    for (int gone : {18, 17, 10, 5}) CHECK_FALSE(small.load(key_of(gone)));
    CHECK_FALSE(fs::exists(path / "unfinished-old"));
    CHECK(fs::exists(path / "unfinished-new"));
    small.clear();
    CHECK(fs::exists(path / "notes.txt"));
}

TEST_CASE("processes and threads that store and load at once see whole objects only")
{
    const test::Folder folder;
    constexpr int writers = 3, rounds = 300;
    std::vector<pid_t> children;
    const auto work = [&](int seed) {
        ObjectCache cache(folder.path / "cache", 60'000); // so small that all of them remove, too
        size_t wrong = 0;
        for (int i = 0; i < rounds; ++i) {
            const std::string name = std::to_string((i * 7 + seed) % 20);
            const std::string content = name + std::string(4000, name[0]);
            if (i % 3 == 0) cache.store(jit::content_hash(name), content);
            const auto found = cache.load(jit::content_hash(name));
            wrong += found && *found != content;
        }
        return wrong;
    };
    for (int i = 0; i < writers; ++i)
        if (const pid_t child = fork(); child == 0)
            _exit(work(i) == 0 ? 0 : 1);
        else
            children.push_back(child);
    size_t wrong = 0;
    std::thread other([&] { wrong += work(11); });
    const size_t here = work(5);
    other.join();
    CHECK((wrong == 0 && here == 0));
    for (pid_t child : children) {
        int status = 0;
        REQUIRE(waitpid(child, &status, 0) == child);
        CHECK(status == 0);
    }
    for (const fs::path& file : files_in(folder.path / "cache")) CHECK(file.extension() == ".object");
}
