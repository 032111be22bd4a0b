// haptel render as a command: files, channels, clipping, cards, and what is refused.
#include "tests/tools/commands/heard.h"
#include "tools/output/json.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sys/stat.h>

using namespace haptel::test;
using haptel::tools::Json;

namespace {

std::size_t files_in(const Folder& folder)
{
    const std::filesystem::directory_iterator files(std::filesystem::path(folder.file("x")).parent_path());
    return static_cast<std::size_t>(std::distance(begin(files), end(files)));
}

} // namespace

TEST_CASE("render writes the same bytes on every run, and nothing beside the file")
{
    const RidgedFloor floor;
    for (const std::string options : {"", "--format 24 --channels x,y,z", "--format float --channels normal"}) {
        CAPTURE(options);
        REQUIRE(floor.render("a.wav", "--seconds 1 " + options).code == 0);
        REQUIRE(floor.render("b.wav", "--seconds 1 " + options).code == 0);
        CHECK(read_file(floor.folder.file("a.wav")) == read_file(floor.folder.file("b.wav")));
    }
    CHECK(files_in(floor.folder) == 4); // scene, texture and two sounds
    const Heard sound = heard(floor.folder.file("a.wav"));
    CHECK(sound.channels == 1);
    CHECK(sound.format == (SF_FORMAT_WAV | SF_FORMAT_FLOAT));
    CHECK(sound.samples.size() == 48'000);
}

TEST_CASE("a file that is there is replaced whole, and keeps its permissions")
{
    const RidgedFloor floor;
    const std::string file = floor.folder.write("a.wav", std::string(1'000'000, 'x'));
    chmod(file.c_str(), 0600);
    REQUIRE(floor.render("a.wav", "--seconds 0.1").code == 0);
    CHECK(heard(file).samples.size() == 4'800);
    struct stat now = {};
    REQUIRE(stat(file.c_str(), &now) == 0);
    CHECK((now.st_mode & 0777) == 0600);
}

TEST_CASE("the haptic channels of a game controller are the last two of four")
{
    const RidgedFloor floor;
    REQUIRE(floor.render("four.wav", "--seconds 1 --channels none,none,along,along").code == 0);
    REQUIRE(floor.render("one.wav", "--seconds 1").code == 0);
    const Heard four = heard(floor.folder.file("four.wav")), one = heard(floor.folder.file("one.wav"));
    REQUIRE(four.channels == 4);
    CHECK(four.channel(0) == std::vector<double>(48'000));
    CHECK(four.channel(1) == std::vector<double>(48'000));
    CHECK(four.channel(2) == one.samples);
    CHECK(four.channel(3) == one.samples);
}

TEST_CASE("what is beyond full scale is cut off, counted and told")
{
    const RidgedFloor floor;
    REQUIRE(floor.render("true.wav", "--seconds 1 --format float --full-scale 100N").code == 0);
    std::size_t beyond = 0;
    for (const double sample : heard(floor.folder.file("true.wav")).samples) beyond += std::abs(100 * sample) > 0.05;
    const Ran ran = floor.render("cut.wav", "--seconds 1 --json --full-scale 50mN");
    REQUIRE(ran.code == 0);
    CHECK(beyond > 1'000);
    CHECK(Json::parse(ran.out)["clipped_samples"] == beyond);
    CHECK(contains(ran.err, std::to_string(beyond) + " samples are beyond full scale and cut off: give --full-scale "));
    double peak = 0;
    for (const double sample : heard(floor.folder.file("cut.wav")).samples) peak = std::max(peak, std::abs(sample));
    CHECK(std::abs(peak - 1) < 1e-4);
}

TEST_CASE("where nothing is touched there is silence, and a word about it")
{
    const RidgedFloor floor;
    const Ran ran = floor.render("silent.wav", "--seconds 0.4 --json");
    CHECK(ran.code == 0);
    CHECK(contains(ran.err, "the hand touched nothing, and the sound is silent"));
    CHECK(heard(floor.folder.file("silent.wav")).samples == std::vector<double>(19'200));
    const Json json = Json::parse(ran.out);
    CHECK(json["peak_n"] == 0);
    CHECK(json["contact_ticks"] == 0);
}

TEST_CASE("the report tells what the file holds")
{
    const RidgedFloor floor;
    const Ran ran = floor.render("a.wav", "--seconds 1.5 --channels x,z --high-pass 40Hz --format 24");
    CHECK(ran.code == 0);
    CHECK(ran.err.empty());
    CHECK(contains(ran.out, "a.wav: 1.5 s of x, z at 48000 Hz, 24 bit\n  full scale   "));
    CHECK(contains(ran.out, " N, 1.0 dB below full scale; rms "));
    CHECK(contains(ran.out, "\n  high-pass    40 Hz\n  clipped      0 samples\n"));
    CHECK(contains(floor.render("a.wav", "--seconds 1 --high-pass off").out, "off: constant forces are in it"));
    const Json json = Json::parse(floor.render("a.wav", "--seconds 1 --json").out);
    for (const char* key : {"seconds", "rate_hz", "channels", "components", "format", "high_pass_hz", "newton_per_unit",
                            "peak_n", "rms_n", "clipped_samples", "contact_ticks", "faults", "underruns"})
        CHECK(json.contains(key));
    CHECK(json["underruns"].is_null());
    CHECK(json["channels"] == 1);
    CHECK(contains(read_file(floor.folder.file("a.wav")), "haptel: full scale is ")); // for who finds it later
}

TEST_CASE("a card is given what a file would hold")
{
    const RidgedFloor floor;
    const std::string raw = floor.folder.file("heard.raw");
    const Ran ran =
        run_command("render '" + floor.scene + "' --seconds 1 --channels along,z --json --play 'file:" + raw + ",raw'");
    INFO(ran.err);
    REQUIRE(ran.code == 0);
    CHECK(ran.err.empty());
    const Json json = Json::parse(ran.out);
    CHECK(json["underruns"] == 0);
    CHECK(json["format"].is_null());
    REQUIRE(floor.render("f.wav", "--seconds 1 --channels along,z --format float").code == 0);
    std::string expected;
    for (const double sample : heard(floor.folder.file("f.wav")).samples) {
        const float single = static_cast<float>(sample);
        expected.append(reinterpret_cast<const char*>(&single), sizeof single);
    }
    CHECK(read_file(raw) == expected);
}

TEST_CASE("playing ends cleanly on Ctrl-C")
{
    const RidgedFloor floor;
    // Interrupted once it listens (bit 1 of the signals that it catches), however long the scene took to load.
    const std::string interrupting =
        "timeout -s KILL 60 sh -c '\"$@\" & while kill -0 $! && ! grep -q \"^SigCgt.*[2367abef]$\" "
        "/proc/$!/status; do sleep 0.01; done; sleep 1; kill -INT $!; wait $!' sh";
    const Ran ran = run_command("render '" + floor.scene + "' --play null --full-scale 1N", interrupting);
    INFO(ran.err);
    CHECK(ran.code == 0);
    CHECK(contains(ran.out, "null: "));
    CHECK(contains(ran.out, "  gaps         0\n"));
}

TEST_CASE("render refuses what cannot be heard, and says why")
{
    const RidgedFloor floor;
    const auto misuse = [&](const std::string& options) {
        const Ran ran = run_command("render '" + floor.scene + "' " + options);
        CAPTURE(options, ran.err);
        CHECK(ran.code == 2);
        CHECK(ran.out.empty());
        return ran.err;
    };
    const std::string to = "--out '" + floor.folder.file("x.wav") + "' ";
    CHECK(contains(misuse(""), "say where the sound goes: --out FILE.wav, or --play"));
    CHECK(contains(misuse(to + "--play null"), "excludes"));
    CHECK(contains(misuse("--out '" + floor.folder.file("floor.toml") + "'"), "name it '"));
    CHECK(contains(misuse(to + "--channels alng"), "did you mean 'along'?"));
    CHECK(contains(misuse(to + "--channels x,y,z,x,y"), "1 to 4 channels"));
    CHECK(contains(misuse(to + "--full-scale 0"), "expected a force from 1e-9 N to 1000 N, such as 2N or 500mN"));
    CHECK(contains(misuse(to + "--full-scale -1N"), "expected a force"));
    CHECK(contains(misuse(to + "--full-scale nan"), "expected a force"));
    CHECK(contains(misuse(to + "--full-scale 2mm"), "expected a force"));
    CHECK(contains(misuse(to + "--high-pass 30kHz"), "`off`, or a frequency"));
    CHECK(contains(misuse(to + "--high-pass quiet"), "`off`, or a frequency"));
    CHECK(contains(misuse(to + "--format 32"), "--format"));
    CHECK(contains(misuse(to + "--seconds 0"), "no time"));
    CHECK(contains(misuse(to + "--seconds 1e-9"), "no time"));
    CHECK(contains(misuse(to + "--seconds inf"), "'inf'"));
    CHECK(contains(misuse(to + "--seconds 1e9"), "at most 600 s"));

    const auto finding = [&](const std::string& options) {
        const Ran ran = run_command("render '" + floor.scene + "' " + options);
        CAPTURE(options, ran.err);
        CHECK(ran.code == 1);
        CHECK(ran.out.empty());
        return ran.err;
    };
    CHECK(contains(finding("--out /no/such/folder/x.wav"), "there is no folder '/no/such/folder': make it first"));
    std::filesystem::create_directory(floor.folder.file("folder.wav"));
    CHECK(contains(finding("--out '" + floor.folder.file("folder.wav") + "'"), "it is a folder: name a file in it"));
    REQUIRE(mkfifo(floor.folder.file("pipe.wav").c_str(), 0600) == 0);
    CHECK(contains(finding("--out '" + floor.folder.file("pipe.wav") + "'"), "it is no regular file"));
    CHECK(contains(finding("--out '" + floor.scene + "/x.wav'"), "Not a directory"));
    CHECK(contains(finding("--play nosuch --full-scale 1N"), "there is no sound device 'nosuch'"));
    CHECK(contains(finding(to + "--device nosuch"), "unknown device 'nosuch'"));
    const std::string trace = floor.folder.write("trace.csv", "tick\n");
    CHECK(contains(finding(to + "--device 'replay:" + trace + "'"), "with `rate_hz = 48000`"));
    CHECK(run_command("render /no/such.toml " + to).code == 1);
    CHECK(files_in(floor.folder) == 5); // scene, texture, folder, pipe, trace: nothing that a refusal left behind
}
