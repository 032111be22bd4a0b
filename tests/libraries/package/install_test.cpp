#include "libraries/lock.h"
#include "libraries/package/install.h"
#include "tests/libraries/library_text.h"
#include "tests/support/catch.h"
#include "tests/support/folder.h"

#include <set>
#include <thread>

using namespace haptel;
using namespace haptel::libraries;
namespace fs = std::filesystem;

namespace {

std::set<std::string> all_in(const fs::path& folder)
{
    std::set<std::string> paths;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
        paths.insert(entry.path().lexically_relative(folder));
    return paths;
}

std::string text_of(const fs::path& file)
{
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

} // namespace

TEST_CASE("a library is installed whole, again without a change, and its versions side by side")
{
    const haptel::test::Folder folder;
    const fs::path root = folder.path / "data" / "libraries";
    const Installation first = install(test::library("wood", "1.0.0"), root);
    CHECK(first.why == "");
    CHECK(first.folder == root / "wood" / "1.0.0");
    CHECK(!first.was_there);
    CHECK(all_in(root) == std::set<std::string>{"wood", "wood/1.0.0", "wood/1.0.0/SHA256SUMS",
                                                "wood/1.0.0/library.toml", "wood/1.0.0/oak.haptel"});
    CHECK(install(test::library("wood", "1.0.0"), root).was_there);
    CHECK(install(test::library("wood", "2.0.0"), root).why == "");
    const std::vector<Installed> there = installed_in({{"user", root}});
    REQUIRE(there.size() == 2);
    CHECK(there[0].version == Version{2, 0, 0});
    CHECK(remove(there[1]) == "");
    CHECK(all_in(root / "wood").size() == 4);
    CHECK(remove(there[0]) == "");
    CHECK(all_in(root).empty());
}

TEST_CASE("a version that is there with other files is refused, and stays")
{
    const haptel::test::Folder folder;
    REQUIRE(install(test::library("wood", "1.0.0"), folder.path).why == "");
    const auto before = all_in(folder.path);
    const Installation other = install(test::library("wood", "1.0.0", "2mm"), folder.path);
    CHECK(other.folder.empty());
    CHECK(other.why.find("haptel remove wood@1.0.0") != std::string::npos);
    CHECK(all_in(folder.path) == before);
    CHECK(text_of(folder.path / "wood/1.0.0/oak.haptel") == test::library("wood", "1.0.0").contents.at("oak.haptel"));
}

TEST_CASE("where nothing can be written nothing is left behind")
{
    const haptel::test::Folder folder;
    folder.write("file", "");
    const Installation in_file = install(test::library("wood", "1.0.0"), folder.path / "file" / "libraries");
    CHECK(in_file.folder.empty());
    CHECK(in_file.why.find("cannot be written") != std::string::npos);
    folder.write("wood", ""); // where the folder of the library would be
    const Installation in_way = install(test::library("wood", "1.0.0"), folder.path);
    CHECK(in_way.folder.empty());
    CHECK(all_in(folder.path) == std::set<std::string>{"file", "wood"});
    const Installation made_for_nothing = install(test::library("wood", "1.0.0"), "/proc/none/libraries");
    CHECK(made_for_nothing.folder.empty());
}

TEST_CASE("many that install at once: one does, and the others find it")
{
    const haptel::test::Folder folder;
    const Package wood = test::library("wood", "1.0.0");
    std::vector<Installation> done(8);
    std::vector<std::thread> threads;
    for (Installation& one : done) threads.emplace_back([&] { one = install(wood, folder.path / "libraries"); });
    for (std::thread& thread : threads) thread.join();
    for (const Installation& one : done) {
        INFO(one.why);
        CHECK(one.folder == folder.path / "libraries" / "wood" / "1.0.0");
    }
    CHECK(all_in(folder.path / "libraries").size() == 5);
}

TEST_CASE("a project's lock names what was installed there, of each major version one")
{
    const haptel::test::Folder folder;
    const auto versions = [&] {
        haptel::input::FileMessages messages("haptel.lock");
        std::string list;
        const auto locked = read_lock(text_of(folder.path / lock_name), messages);
        for (const Locked& one : locked.value()) list += one.name + " " + to_text(one.version) + ", ";
        return list;
    };
    CHECK(lock(folder.path, test::library("wood", "1.0.0")) == "");
    CHECK(lock(folder.path, test::library("wood", "2.0.0")) == "");
    CHECK(lock(folder.path, test::library("stone", "1.0.0")) == "");
    CHECK(lock(folder.path, test::library("wood", "1.1.0")) == "");
    CHECK(versions() == "stone 1.0.0, wood 1.1.0, wood 2.0.0, ");
    CHECK(unlock(folder.path, {"wood", {2, 0, 0}, {}, {}}) == "");
    CHECK(unlock(folder.path, {"wood", {3, 0, 0}, {}, {}}) == "");
    CHECK(versions() == "stone 1.0.0, wood 1.1.0, ");
    folder.write(lock_name, "what\n");
    CHECK(lock(folder.path, test::library("wood", "1.2.0")).find("haptel.lock:1:") != std::string::npos);
    CHECK(text_of(folder.path / lock_name) == "what\n");
    CHECK(all_in(folder.path).size() == 1);
}

TEST_CASE("a library that needs another wants it first")
{
    const haptel::test::Folder folder;
    const std::vector<Place> places{{"user", folder.path}};
    const Manifest manifest = test::library("old", "1.0.0", "1mm", "[dependencies]\nwood = \"1.2\"\n").manifest;
    CHECK(missing_dependency(manifest, places) ==
          "it needs wood 1.2.0 or one that can take its place, and none is installed: install that first");
    install(test::library("wood", "2.0.0"), folder.path);
    CHECK(missing_dependency(manifest, places).find("there is 2.0.0 at most") != std::string::npos);
    install(test::library("wood", "1.3.0"), folder.path);
    CHECK(missing_dependency(manifest, places) == "");
}
