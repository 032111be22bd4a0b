// Textures that follow their files, however the files are written. Times here are patience, not claims.
#include "jit/live/file_watch.h"
#include "jit/texture/resolver.h"
#include "tests/jit/live/follower.h"
#include "tests/support/folder.h"

#include <atomic>
#include <condition_variable>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <stdexcept>
#include <thread>

using namespace haptel;
using namespace std::chrono_literals;
using test::constant;
using test::contains;
using test::Follower;

TEST_CASE("an edit reaches the hand, however the file is saved")
{
    const test::Folder folder;
    folder.write("t.haptel", constant("1"));
    Follower follower(folder);
    SECTION("written in place")
    {
        folder.write("t.haptel", constant("2"));
        CHECK(follower.comes_to(2));
    }
    SECTION("replaced by rename")
    {
        folder.replace("t.haptel", constant("3"));
        CHECK(follower.comes_to(3));
        folder.replace("t.haptel", constant("4"));
        CHECK(follower.comes_to(4));
    }
    SECTION("deleted and made anew")
    {
        std::filesystem::remove(folder.path / "t.haptel");
        std::this_thread::sleep_for(50ms);
        folder.write("t.haptel", constant("5"));
        CHECK(follower.comes_to(5));
    }
    SECTION("written slowly, in pieces")
    {
        const std::string text = constant("6");
        std::ofstream file(folder.path / "t.haptel", std::ios::binary);
        for (char c : text) {
            file << c << std::flush;
            std::this_thread::sleep_for(2ms);
        }
        file.close();
        CHECK(follower.comes_to(6));
    }
    SECTION("behind a link")
    {
        std::filesystem::create_directory(folder.path / "elsewhere");
        folder.write("elsewhere/real.haptel", constant("7"));
        std::filesystem::remove(folder.path / "t.haptel");
        std::filesystem::create_symlink(folder.path / "elsewhere/real.haptel", folder.path / "t.haptel");
        CHECK(follower.comes_to(7));
        folder.write("elsewhere/real.haptel", constant("8"));
        CHECK(follower.comes_to(8));
    }
    SECTION("its folder made anew")
    {
        std::filesystem::remove_all(folder.path);
        std::this_thread::sleep_for(50ms);
        std::filesystem::create_directory(folder.path);
        folder.write("t.haptel", constant("9"));
        CHECK(follower.comes_to(9));
    }
}

TEST_CASE("a folder that is reached by two paths is watched for the files of both")
{
    const test::Folder folder;
    std::filesystem::create_directory(folder.path / "real");
    std::filesystem::create_directory_symlink(folder.path / "real", folder.path / "second"); // sorts after
    folder.write("real/a.haptel", constant("1"));
    folder.write("real/b.haptel", constant("1"));
    jit::FileWatch watch;
    REQUIRE(watch.descriptor() >= 0);
    watch.watch({folder.file("second/a.haptel"), folder.file("real/b.haptel")});
    CHECK(watch.take() == jit::FileWatch::Change::none);
    folder.write("real/a.haptel", constant("2"));
    CHECK(watch.take() == jit::FileWatch::Change::written);
    folder.write("real/b.haptel", constant("2"));
    CHECK(watch.take() == jit::FileWatch::Change::written);
}

TEST_CASE("nothing is published without a change")
{
    const test::Folder folder;
    folder.write("t.haptel", constant("1"));
    Follower follower(folder);
    // in one piece: whoever reads while a file is being written sees it cut short, and says so
    folder.replace("t.haptel", constant("1"));
    folder.write("other.haptel", constant("2"));
    std::this_thread::sleep_for(400ms);
    CHECK(follower.publications() == 0);
    CHECK(follower.said().empty());
}

TEST_CASE("a file that is broken or gone leaves the old texture and says why")
{
    const test::Folder folder;
    folder.write("t.haptel", constant("1"));
    Follower follower(folder);
    folder.write("t.haptel", "texture t() { return dept; }");
    CHECK(follower.says("t.haptel:1:22: error:"));
    folder.write("t.haptel", "texture u() { return 1mm; }");
    CHECK(follower.says("no texture 't'"));
    std::filesystem::remove(folder.path / "t.haptel");
    CHECK(follower.says("it does not exist"));
    CHECK(follower.publications() == 0);
    folder.write("t.haptel", constant("2"));
    CHECK(follower.comes_to(2));
}

TEST_CASE("what a scene is warned of is told when it is reloaded, too")
{
    const test::Folder folder;
    folder.write("t.haptel", constant("1"));
    Follower follower(folder);
    folder.replace("t.haptel", "texture t(image picture) { return 1mm * sample(picture, p.xy / 1mm); }");
    CHECK(follower.comes_to(0));
    CHECK(follower.says("t.haptel: warning: parameter 'picture' of texture 't' has no picture and is flat"));
}

TEST_CASE("an import is part of the texture")
{
    const test::Folder folder;
    folder.write("part.haptel", "float depth() { return 1um; }");
    folder.write("t.haptel", "import \"part.haptel\"; texture t() { return depth(); }");
    Follower follower(folder);
    folder.write("part.haptel", "float depth() { return 5um; }");
    CHECK(follower.comes_to(5));
    folder.write("t.haptel", "import \"late.haptel\"; texture t() { return depth(); }");
    CHECK(follower.says("late.haptel"));
    folder.write("late.haptel", "float depth() { return 6um; }");
    CHECK(follower.comes_to(6));
}

TEST_CASE("a picture is part of the texture")
{
    // 2 x 1 texels of one gray: flat, whatever is between them
    const auto gray = [](int value) { return "P5 2 1 255\n" + std::string(2, static_cast<char>(value)); };
    const test::Folder folder;
    folder.write("t.haptel", "texture t(image relief) { return 1um * sample(relief, vec2(0.5)); }");
    folder.write("relief.pgm", gray(51));
    Follower follower(folder, {{"relief", folder.file("relief.pgm")}});
    SECTION("changed in place")
    {
        folder.write("relief.pgm", gray(102));
        CHECK(follower.comes_to(0.4));
        CHECK(follower.publications() == 1);
    }
    SECTION("replaced by rename")
    {
        folder.write("new.pgm", gray(255));
        std::filesystem::rename(folder.file("new.pgm"), folder.file("relief.pgm"));
        CHECK(follower.comes_to(1));
    }
    SECTION("broken, then mended: the old picture stays meanwhile")
    {
        folder.write("relief.pgm", "no picture");
        CHECK(follower.says("is no picture that can be read"));
        CHECK(follower.publications() == 0);
        folder.write("relief.pgm", gray(204));
        CHECK(follower.comes_to(0.8));
    }
    SECTION("left alone")
    {
        std::this_thread::sleep_for(1500ms);
        CHECK(follower.publications() == 0);
    }
}

TEST_CASE("an exception in a client is told, and the compile thread goes on with it and the others")
{
    const test::Folder folder, other_folder;
    folder.write("t.haptel", constant("1"));
    other_folder.write("t.haptel", constant("1"));
    Follower follower(folder), other(other_folder);
    follower.refuses = true;
    folder.write("t.haptel", constant("2"));
    CHECK(follower.says("t.haptel: error: this edit could not be taken up: no room in the hand"));
    other_folder.write("t.haptel", constant("3"));
    CHECK(other.comes_to(3));
    follower.refuses = false;
    folder.write("t.haptel", constant("4"));
    CHECK(follower.comes_to(4));
}

TEST_CASE("a file that is saved all the time is felt all the same")
{
    const test::Folder folder;
    folder.write("t.haptel", constant("1"));
    Follower follower(folder);
    std::atomic<bool> enough{false};
    const auto keep_touching = [&] { // counts as saved: only the time of the file changes
        while (!enough) {
            std::filesystem::last_write_time(folder.file("t.haptel"), std::filesystem::file_time_type::clock::now());
            std::this_thread::sleep_for(200us);
        }
    };
    std::thread one(keep_touching), another(keep_touching);
    std::this_thread::sleep_for(50ms);
    folder.write("t.haptel", constant("2"));
    CHECK(follower.comes_to(2)); // while it is touched
    enough = true;
    one.join();
    another.join();
}

TEST_CASE("a texture too slow for the servo is refused with the figure")
{
    const test::Folder folder;
    folder.write("t.haptel", constant("1"));
    Follower follower(folder, {}, 1e-6); // a servo of 1 MHz
    folder.write("t.haptel", "texture t() { float h = 0.0; for (int i = 0; i < 2000; ++i)"
                             " h += sin(p.x / 1mm + float(i)); return clamp(1um * h, -1mm, 1mm); }");
    CHECK(follower.says("per call (median), more than the 0.2 us"));
    CHECK(follower.publications() == 0);
}

TEST_CASE("200 edits in a row, every fourth broken: the last good one is felt, and old code goes")
{
    REQUIRE(test::programs_fall_to(0)); // those of the tests before
    {
        const test::Folder folder;
        folder.write("t.haptel", constant("1"));
        Follower follower(folder);
        for (int i = 1; i <= 200; ++i) {
            const std::string text = i % 4 == 0 ? "texture t() { return" : constant(std::to_string(i));
            if (i % 3 == 0)
                folder.replace("t.haptel", text);
            else
                folder.write("t.haptel", text);
            std::this_thread::sleep_for(15ms);
        }
        folder.write("t.haptel", constant("199.5"));
        CHECK(follower.comes_to(199.5));
        CHECK(follower.publications() > 3);
        CHECK(test::programs_fall_to(2)); // a draft and its fast code
    }
    CHECK(test::programs_fall_to(0));
}

TEST_CASE("a callback may make another live texture, and destroy it")
{
    const test::Folder folder;
    folder.write("t.haptel", constant("1"));
    std::mutex mutex;
    std::condition_variable changed;
    int published = 0;
    bool is_gone = false;
    std::vector<std::unique_ptr<jit::LiveTexture>> others;
    const auto request = [&](const std::string& file) {
        folder.write(file, constant("2"));
        TextureRequest asked = test::request_over(0.05);
        asked.reference = folder.file(file + ":t");
        return asked;
    };
    const auto other = [&](const std::string& file) {
        const auto publish = [&](TextureBinding) {
            const std::lock_guard lock(mutex);
            ++published;
            changed.notify_all();
        };
        return std::make_unique<jit::LiveTexture>(request(file), jit::LiveCallbacks{publish, {}},
                                                  jit::LiveOptions{std::make_shared<jit::ProgramCache>()});
    };
    jit::LiveCallbacks callbacks;
    callbacks.publish = [&](TextureBinding) { others.push_back(other("published.haptel")); };
    callbacks.report = [&](std::string_view) {
        others.push_back(other("reported.haptel"));
        other("gone.haptel");
        const std::lock_guard lock(mutex);
        is_gone = true;
        changed.notify_all();
    };
    jit::LiveTexture first(request("first.haptel"), callbacks, jit::LiveOptions{std::make_shared<jit::ProgramCache>()});
    folder.write("first.haptel", "texture t() { return 1mm }"); // what is to be reported
    std::unique_lock lock(mutex);
    CHECK(changed.wait_for(lock, 20s, [&] { return published >= 1 && is_gone; }));
    lock.unlock();
    folder.write("first.haptel", constant("3"));
    lock.lock();
    CHECK(changed.wait_for(lock, 20s, [&] { return published >= 2; }));
}
