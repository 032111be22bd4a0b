// Parameters of textures that follow their files: kept by a reload, and set while they are felt.
#include "tests/jit/live/follower.h"
#include "tests/jit/texture/idioms.h"

#include <fstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

using namespace haptel;
using namespace std::chrono_literals;
using test::constant;
using test::Follower;

TEST_CASE("values survive a reload by name and type, and sliders need no compiler")
{
    const test::Folder folder;
    folder.write("t.haptel", constant("1"));
    Follower follower(folder, {{"depth", "40um"}});
    folder.write("t.haptel", constant("2") + " // new");
    CHECK(follower.comes_to(40));
    follower.texture->set_parameter("depth", "41um");
    CHECK(follower.comes_to(41));
    folder.write("t.haptel", "texture t(int depth = 3 in 1 .. 5) { return float(depth) * 1um; }");
    CHECK(follower.comes_to(3));
    CHECK(follower.says("41um of 'depth' is set aside"));
    folder.write("t.haptel", constant("1"));
    CHECK(follower.comes_to(41)); // it fits again
    folder.write("t.haptel", "broken");
    CHECK(follower.says("error"));
    follower.texture->set_parameter("depth", "42um");
    CHECK(follower.comes_to(42)); // of the last texture that compiled
}

TEST_CASE("a value waits for no file that is being written, but for a picture of its texture")
{
    const auto are_watched = [](Follower& follower) { // the files: at the latest when the second value is felt
        for (const int publications : {1, 2}) {
            follower.texture->set_parameter("depth", std::to_string(20 + publications) + "um");
            CHECK(follower.comes_to_publications(publications));
        }
    };
    const test::Folder folder;
    SECTION("source")
    {
        folder.write("t.haptel", constant("1"));
        Follower follower(folder, {{"depth", "40um"}});
        are_watched(follower);
        std::ofstream open(folder.file("t.haptel"));
        open << "texture t(float depth = 1um in 0um .. 1mm) { return depth + 1um; }" << std::flush;
        follower.texture->set_parameter("depth", "41um");
        for (int i = 0; i < 50 && follower.publications() == 2; ++i) {
            open << ' ' << std::flush;
            std::this_thread::sleep_for(10ms);
        }
        open.close();
        CHECK(follower.comes_to(42)); // nobody writes on
        const auto felt = follower.ranges_so_far();
        REQUIRE(felt.size() == 4);
        CHECK(felt[2].first == Approx(41e-6)); // of the text that was there
    }
    SECTION("picture")
    {
        folder.write("t.haptel", "texture t(image relief, float depth = 1um in 0um .. 1mm) { return depth * "
                                 "sample(relief, vec2(0.5)); }");
        for (bool was_soon = false; !was_soon;) { // a file is thought complete when nobody has written for 150 ms
            folder.write("relief.pgm", "P5 2 1 255\n" + std::string(2, '\x33'));
            Follower follower(folder, {{"relief", folder.file("relief.pgm")}});
            are_watched(follower);
            const auto start = std::chrono::steady_clock::now();
            std::ofstream open(folder.file("relief.pgm"));
            open << "P5 2 1 255\n" << std::flush;
            follower.texture->set_parameter("depth", "12.5um");
            std::this_thread::sleep_for(30ms);
            open << std::string(2, '\x66') << std::flush;
            open.close();
            was_soon = std::chrono::steady_clock::now() - start < 100ms;
            if (!was_soon) continue;
            CHECK(follower.comes_to(5)); // 12.5 um x 0.4
            CHECK(follower.publications() == 3);
            CHECK_FALSE(contains(follower.said(), "error")); // of a picture that was read too early
        }
    }
}

TEST_CASE("a vector is set as a whole and by its components, a choice by its name, as long as they are there")
{
    const test::Folder folder;
    folder.write("t.haptel", constant("1"));
    Follower follower(folder);
    const std::string shown = " { return bond == stack ? size.y : size.x; }";
    folder.write("t.haptel", "texture t(int bond = running in {running, stack}, vec2 size = vec2(7um, 8um))" + shown);
    CHECK(follower.comes_to(7));
    follower.texture->set_parameter("size", "9um, 10um");
    CHECK(follower.comes_to(9));
    follower.texture->set_parameter("bond", "stack");
    CHECK(follower.comes_to(10));
    follower.texture->set_parameter("size.y", "11um");
    CHECK(follower.comes_to(11));
    folder.write("t.haptel", "texture t(int bond = none in {none, stack}, vec3 size = vec3(5um, 6um, 7um))" + shown);
    CHECK(follower.says("9um, 10um of 'size' is set aside: expected 3 numbers"));
    CHECK(follower.comes_to(11));
    folder.write("t.haptel", "texture t(int bond = running in {running, english}, vec2 size = vec2(7um, 8um)) { return "
                             "bond == english ? size.y : size.x; }");
    CHECK(follower.comes_to(9));
    CHECK(follower.says("stack of 'bond' is set aside: expected running or english"));
}

TEST_CASE("a value that is refused does not keep the next one from being felt; several at once are one binding")
{
    const test::Folder folder;
    folder.write("t.haptel", "texture t(int n = 1 in 1 .. 20000, float depth = 1um, float more = 0um) { float h = 0.0; "
                             "for (int i = 0; i < n; ++i) h += sin(p.x / 1mm + float(i)); return depth + more + 0.0 * "
                             "clamp(h, -1.0, 1.0) * 1um; }");
    Follower follower(folder, {}, 1e-4); // a call may take 20 us
    follower.texture->set_parameter("n", "20000");
    CHECK(follower.says("per call (median), more than the 20 us"));
    CHECK(follower.publications() == 0);
    follower.texture->set_parameters({{"depth", "5um"}, {"more", "2um"}});
    CHECK(follower.comes_to(7));
    CHECK(follower.publications() == 1);
}

TEST_CASE(
    "a knob is felt by a range that is known at once, and by the one found with patience when it has come to rest")
{
    const std::string text =
        std::string(test::idioms) +
        "texture t(float depth = 50um, float size = 3mm) { return depth * simplex_plane(p.xy / size); }";
    const auto program = test::compiled(text);
    using Values = std::vector<std::pair<std::string, std::string>>;
    const auto request_of = [](Values values) {
        TextureRequest request = test::request_over(0.05);
        request.servo_period_s = 1e-3;
        request.parameters = std::move(values);
        return request;
    };
    const auto complete = [&](const Values& values) {
        return jit::make_binding(program, "t", request_of(values)).binding.value();
    };
    const Values first = {{"size", "4mm"}}, second = {{"size", "5mm"}};
    const auto once = Follower::range_of(
                   jit::make_binding_at_once(program, "t", request_of(second), complete(first)).binding.value()),
               patient = Follower::range_of(complete(second));
    REQUIRE(once != patient);

    const test::Folder folder;
    folder.write("t.haptel", text);
    Follower follower(folder);
    follower.texture->set_parameter("size", "4mm");
    REQUIRE(follower.comes_to_range(Follower::range_of(complete(first))));
    follower.texture->set_parameter("size", "5mm");
    CHECK(follower.comes_to_range(patient));
    const auto ranges = follower.ranges_so_far();
    REQUIRE(ranges.size() >= 3);
    CHECK(ranges[ranges.size() - 2] == once);
    for (int um = 20; um < 70; ++um) {
        follower.texture->set_parameter("depth", std::to_string(um) + "um");
        std::this_thread::sleep_for(1ms);
    }
    CHECK(follower.comes_to_range(Follower::range_of(complete({{"size", "5mm"}, {"depth", "69um"}}))));
    const auto published = static_cast<size_t>(follower.publications());
    std::this_thread::sleep_for(300ms);
    CHECK(static_cast<size_t>(follower.publications()) == published);
}

TEST_CASE("a value that is refused leaves the range of the one before to be found")
{
    const std::string text =
        std::string(test::idioms) +
        "texture t(float size = 3mm, int n = 1 in 1 .. 20000) { float h = 0.0; for (int i = 0; i < n; ++i) h += "
        "sin(p.x / 1mm + float(i)); return 50um * simplex_plane(p.xy / size) + 0.0 * clamp(h, -1.0, 1.0) * 1um; }";
    const auto program = test::compiled(text);
    const auto request_of = [](const char* size) {
        TextureRequest request = test::request_over(0.05);
        request.parameters = {{"size", size}};
        return request;
    };
    const TextureBinding before = jit::make_binding(program, "t", request_of("4mm")).binding.value();
    const auto once = Follower::range_of(
                   jit::make_binding_at_once(program, "t", request_of("5mm"), before).binding.value()),
               patient = Follower::range_of(jit::make_binding(program, "t", request_of("5mm")).binding.value());
    REQUIRE(once != patient);

    const test::Folder folder;
    folder.write("t.haptel", text);
    Follower follower(folder, {}, 1e-4); // a call may take 20 us
    follower.texture->set_parameter("size", "4mm");
    REQUIRE(follower.comes_to_range(Follower::range_of(before)));
    follower.texture->set_parameter("size", "5mm");
    REQUIRE(follower.comes_to_range(once));
    follower.texture->set_parameter("n", "20000");
    CHECK(follower.says("per call (median), more than the 20 us"));
    CHECK(follower.comes_to_range(patient));
}
