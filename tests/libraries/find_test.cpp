#include "libraries/find.h"
#include "libraries/lock.h"
#include "libraries/places.h"
#include "libraries/sha256.h"
#include "tests/libraries/library_text.h"
#include "tests/support/catch.h"
#include "tests/support/folder.h"

#include <cstdlib>

using namespace haptel;
using namespace haptel::libraries;
namespace fs = std::filesystem;

namespace {

// A home, a project in it and nothing of the machine's own: HAPTEL_PATH and the user's folder are inside.
struct Home {
    haptel::test::Folder folder;
    fs::path user = folder.path / "data" / "haptel" / "libraries", project = folder.path / "project";

    Home()
    {
        setenv("XDG_DATA_HOME", folder.file("data").c_str(), 1);
        unsetenv("HAPTEL_PATH");
        fs::create_directories(project / "textures");
    }
    ~Home()
    {
        unsetenv("XDG_DATA_HOME");
        unsetenv("HAPTEL_PATH");
    }

    static fs::path put(const Package& package, const fs::path& root)
    {
        const fs::path target = root / package.manifest.name / to_text(package.manifest.version);
        test::write_files(package.contents, target);
        return target;
    }
    // For a file of the project.
    FoundFile find(const std::string& name) const { return find_file(name, project / "textures"); }
};

} // namespace

TEST_CASE("a library's file is found in the project, HAPTEL_PATH and the user's folder; the highest version counts")
{
    const Home home;
    const fs::path one = Home::put(test::library("wood", "1.0.0"), home.user);
    CHECK(home.find("wood.oak").file == one / "oak.haptel");
    CHECK(path_named("wood.oak", home.project) == (one / "oak.haptel").string());
    setenv("HAPTEL_PATH", (home.folder.file("other") + ":" + home.folder.file("more")).c_str(), 1);
    const fs::path again = Home::put(test::library("wood", "1.0.0"), home.folder.path / "more");
    CHECK(home.find("wood.oak").file == again / "oak.haptel"); // of equal versions the nearer one
    const fs::path two = Home::put(test::library("wood", "2.0.0"), home.user);
    CHECK(home.find("wood.oak").file == two / "oak.haptel");
    const fs::path near = Home::put(test::library("wood", "2.0.0"), home.project / project_folder_name);
    CHECK(home.find("wood.oak").file == near / "oak.haptel");
    CHECK(find_file("wood.oak", home.folder.path).file == two / "oak.haptel"); // who is outside of the project
    const fs::path ten = Home::put(test::library("wood", "10.0.0"), home.user);
    CHECK(home.find("wood.oak").file == ten / "oak.haptel");
    fs::create_directories(home.user / "wood" / "11"); // no version
    CHECK(home.find("wood.oak").file == ten / "oak.haptel");
    test::write_files({{"board/pine.haptel", ""}}, ten);
    CHECK(home.find("wood.board.pine").file == ten / "board" / "pine.haptel");
}

TEST_CASE("what is not found is told, with what was searched or meant")
{
    const Home home;
    FoundFile found = home.find("wood.oak");
    CHECK(found.file.empty());
    CHECK(found.why == "library 'wood' is not installed");
    CHECK(test::says(found.hint, "haptel install wood.haptlib"));
    CHECK(test::says(found.hint, home.user.string()));
    CHECK(test::says(found.hint, (home.project / "textures" / project_folder_name).string()));
    CHECK(test::says(found.hint, "/usr/share/haptel/libraries"));
    CHECK(path_named("wood.oak", home.project) == "wood.oak");
    CHECK(path_named("oak.haptel", home.project) == "oak.haptel");

    Home::put(test::library("wood", "1.0.0"), home.user);
    CHECK(home.find("wod.oak").hint == "did you mean 'wood'?");
    found = home.find("wood.oka");
    CHECK(test::says(found.why, "has no file oka.haptel"));
    CHECK(found.hint == "did you mean 'oak'?");
    CHECK(home.find("wood.zzzzzz").hint == "it has oak");

    const fs::path broken = home.user / "wood" / "1.5.0";
    test::write_files({{manifest_name, "name = \"wood\"\n"}, {"oak.haptel", ""}}, broken);
    found = home.find("wood.oak");
    CHECK(found.file.empty());
    CHECK(test::says(found.why, "1.5.0 cannot be used: " + (broken / manifest_name).string() + ":1:1: error: "));
    test::write_files(test::library("wood", "1.4.0").contents, broken);
    CHECK(test::says(home.find("wood.oak").why, "is of wood 1.4.0"));
    test::write_files(test::library_files("wood", "1.5.0", "1mm", "haptel = \"99.0\"\n"), broken);
    CHECK(test::says(home.find("wood.oak").why, "it needs Haptel 99.0.0"));
}

TEST_CASE("a library's own dependencies choose the version: two majors stand side by side")
{
    const Home home;
    const fs::path one = Home::put(test::library("wood", "1.4.0"), home.user);
    const fs::path two = Home::put(test::library("wood", "2.1.0"), home.user);
    const auto needs = [](const std::string& name, const std::string& least) {
        return test::library(name, "1.0.0", "1mm", "[dependencies]\nwood = \"" + least + "\"\n");
    };
    const fs::path old = Home::put(needs("old", "1.2"), home.user), young = Home::put(needs("young", "2"), home.user);
    CHECK(find_file("wood.oak", old).file == one / "oak.haptel");
    CHECK(find_file("wood.oak", old / "deep").file == one / "oak.haptel");
    CHECK(find_file("wood.oak", young).file == two / "oak.haptel");
    CHECK(home.find("wood.oak").file == two / "oak.haptel");

    const fs::path future = Home::put(needs("future", "2.2"), home.user);
    const FoundFile conflict = find_file("wood.oak", future);
    CHECK(conflict.file.empty());
    CHECK(test::says(conflict.why,
                     "library 'future' needs wood 2.2.0 or one that can take its place, and there is 2.1.0 in "));
    CHECK(test::says(conflict.why, "1.4.0 in "));

    const FoundFile unnamed = find_file("stone.granite", old);
    CHECK(unnamed.why == "library 'stone' is not among the dependencies of library 'old'");
    CHECK(test::says(unnamed.hint, (old / manifest_name).string()));
    CHECK(find_file("old.oak", old).file == old / "oak.haptel"); // one's own, by its name
}

TEST_CASE("a lock holds a project to its version, and to the bytes")
{
    const Home home;
    const Package wood = test::library("wood", "1.4.0");
    const fs::path one = Home::put(wood, home.user);
    Home::put(test::library("wood", "1.5.0"), home.user);
    const auto lock = [&](const std::vector<Locked>& libraries) {
        test::write_files({{lock_name, lock_text(libraries)}}, home.project);
    };
    const std::string sum = sha256(wood.contents.at(sums_name));
    lock({{"wood", {1, 4, 0}, sum}});
    CHECK(home.find("wood.oak").file == one / "oak.haptel");
    test::write_files({{"oak.haptel", "texture board() { return 2mm; }\n"}}, one);
    CHECK(home.find("wood.oak").file == one / "oak.haptel"); // who works on an installed file may

    test::write_files({{sums_name, test::library("wood", "1.4.0", "3mm").contents.at(sums_name)}}, one);
    CHECK(test::says(home.find("wood.oak").why, "is not the wood 1.4.0 that "));
    lock({{"wood", {1, 3, 0}, sum}});
    const FoundFile missing = home.find("wood.oak");
    CHECK(test::says(missing.why, "wants wood 1.3.0, and there is 1.5.0 in "));
    CHECK(test::says(missing.hint, "haptel install --project wood.haptlib"));
    lock({{"stone", {1, 3, 0}, sum}}); // of another library
    CHECK(test::says(home.find("wood.oak").file.string(), "1.5.0"));
    test::write_files({{lock_name, "[[wood]]\n"}}, home.project);
    CHECK(test::says(home.find("wood.oak").why, "haptel.lock:1:"));
}
