// What haptel render writes, against the mechanics of the hand in closed form.
//
// A hand presses a stylus with P on a floor of stiffness K and slides it at v over ridges A sin(q x). The force of the
// model `displaced` is F = K (d + h - A) (along the normal) and -F h' (along the floor); d is the depth, and A the most
// of h. The hand is a spring k, a damper b and a mass m, which the force moves:
//
//   in the mean    F0 = P - k d0,  F0 = K (d0 - A)           so F0 = K (P - k A) / (K + k)
//   along normal   |F1| = K A |Z / (Z + K)|,  Z = k - m w^2 + i b w,  w = q v
//   along floor    F0 A q, and beside it only what is twice as fast
#include "tests/tools/commands/heard.h"
#include "tools/output/json.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

using namespace haptel::test;
using haptel::tools::Json;

namespace {

constexpr double pi = std::numbers::pi, rate_hz = 48'000;
constexpr double speed_m_per_s = 0.1, press_n = 1;
constexpr double stiffness = 800, hand_stiffness = 500;
constexpr double mass_kg = 0.075 + 0.15;
// Dry friction of 0.04 N acts against the motion, which is along x: across, so much of it for each m/s.
constexpr double damping = 0.1 + 5 + 0.04 / speed_m_per_s;

double amplitude(const std::vector<double>& samples, double frequency_hz)
{
    std::complex<double> sum = 0;
    for (std::size_t i = 0; i < samples.size(); ++i)
        sum += samples[i] * std::polar(1.0, -2 * pi * frequency_hz * static_cast<double>(i) / rate_hz);
    return 2 * std::abs(sum) / static_cast<double>(samples.size());
}

double high_pass_gain(double frequency_hz)
{
    return 1 / std::sqrt(1 + std::pow(std::tan(pi * 20 / rate_hz) / std::tan(pi * frequency_hz / rate_hz), 4));
}

double mean_n(double depth_m)
{
    return stiffness * (press_n - hand_stiffness * depth_m) / (stiffness + hand_stiffness);
}

// In newtons: the second from 1.5 s on, each bin of its spectrum 1 Hz wide.
std::vector<double> second_of(const std::vector<double>& samples, double newton_per_unit)
{
    REQUIRE(samples.size() == 3 * 48'000);
    std::vector<double> second(samples.begin() + 72'000, samples.begin() + 120'000);
    for (double& sample : second) sample *= newton_per_unit;
    return second;
}

} // namespace

TEST_CASE("ridges are heard at the speed over their pitch, as loud as the hand's mechanics say")
{
    struct Case {
        const char *pitch, *depth;
        double depth_m, expected_hz;
    };
    for (const Case& c :
         {Case{"1mm", "20um", 20e-6, 100}, Case{"0.25mm", "5um", 5e-6, 400}, Case{"20um", "0.2um", 0.2e-6, 5'000}}) {
        CAPTURE(c.pitch);
        const RidgedFloor floor(c.pitch, c.depth);
        const Ran ran = floor.render("f.wav", "--seconds 3 --channels along,normal --format float --json");
        INFO(ran.err);
        REQUIRE(ran.code == 0);
        const double newton_per_unit = Json::parse(ran.out)["newton_per_unit"];
        const Heard sound = heard(floor.folder.file("f.wav"));
        REQUIRE(sound.rate_hz == 48'000);
        const std::vector<double> along = second_of(sound.channel(0), newton_per_unit),
                                  normal = second_of(sound.channel(1), newton_per_unit);

        double loudest_hz = 0, loudest_n = 0;
        const auto look = [&](double hz) {
            if (const double found_n = amplitude(along, hz); found_n > loudest_n) loudest_n = found_n, loudest_hz = hz;
        };
        for (int hz = 20; hz < 12'000; hz += 20) look(hz);
        for (int away = -10; away <= 10; ++away) look(c.expected_hz + away);
        CHECK(std::abs(loudest_hz - c.expected_hz) <= 1);

        const double w = 2 * pi * c.expected_hz, q = w / speed_m_per_s;
        const std::complex<double> hand(hand_stiffness - mass_kg * w * w, damping * w);
        const double gain = high_pass_gain(c.expected_hz);
        const double along_n = mean_n(c.depth_m) * c.depth_m * q * gain;
        const double normal_n = stiffness * c.depth_m * std::abs(hand / (hand + stiffness)) * gain;
        CAPTURE(loudest_n, along_n, amplitude(normal, c.expected_hz), normal_n);
        CHECK(std::abs(amplitude(along, c.expected_hz) / along_n - 1) < 2e-4);
        CHECK(std::abs(amplitude(normal, c.expected_hz) / normal_n - 1) < 2e-4);
    }
}

TEST_CASE("a constant force is in the sound only where the high-pass is off")
{
    const RidgedFloor floor;
    const auto mean = [&](const std::string& options) {
        const Ran ran =
            floor.render("m.wav", "--seconds 3 --channels normal --format float --full-scale 10N " + options);
        REQUIRE(ran.code == 0);
        double sum = 0;
        for (const double sample : second_of(heard(floor.folder.file("m.wav")).samples, 10)) sum += sample;
        return sum / 48'000;
    };
    CHECK(std::abs(mean("--high-pass off") - mean_n(20e-6)) < 0.005);
    CHECK(std::abs(mean("")) < 1e-4);
}

TEST_CASE("the scale that is told is that of the file, in every format")
{
    const RidgedFloor floor;
    REQUIRE(floor.render("true.wav", "--seconds 1 --format float --full-scale 8N").code == 0);
    const std::vector<double> in_eighths = heard(floor.folder.file("true.wav")).samples;
    double peak_n = 0;
    for (const double sample : in_eighths) peak_n = std::max(peak_n, std::abs(8 * sample));
    for (const auto& [format, step] :
         {std::pair("16", 1.0 / 32'768), std::pair("24", 1.0 / 8'388'608), std::pair("float", 1e-7)}) {
        CAPTURE(format);
        const Ran ran = floor.render("f.wav", std::string("--seconds 1 --json --format ") + format);
        REQUIRE(ran.code == 0);
        const Json json = Json::parse(ran.out);
        const double newton_per_unit = json["newton_per_unit"];
        CHECK(std::abs(json["peak_n"].get<double>() - peak_n) < 1e-6);
        CHECK(std::abs(20 * std::log10(newton_per_unit / peak_n) - 1) < 1e-5); // 1 dB below full scale
        const std::vector<double> samples = heard(floor.folder.file("f.wav")).samples;
        REQUIRE(samples.size() == in_eighths.size());
        double furthest = 0;
        for (std::size_t i = 0; i < samples.size(); ++i)
            furthest = std::max(furthest, std::abs(samples[i] - 8 * in_eighths[i] / newton_per_unit));
        CHECK(furthest < 2 * step); // a rounding, and 32767 for 32768
    }
}

TEST_CASE("what is rendered is the force that explore records at that rate")
{
    const RidgedFloor floor("1mm", "20um", "probe = { kind = \"point\" }\n[servo]\nrate_hz = 48000");
    const Ran explored = run_command("explore '" + floor.scene + "' --clock virtual --seconds 0.8 --out '" +
                                     floor.folder.file("run") + "'");
    REQUIRE(explored.code == 0);
    REQUIRE(floor
                .render("f.wav", "--device 'replay:" + floor.folder.file("run/trace.csv") +
                                     "' --channels x,y,z --high-pass off --format float --full-scale 1N")
                .code == 0);
    const Heard sound = heard(floor.folder.file("f.wav"));
    std::istringstream trace(read_file(floor.folder.file("run/trace.csv")));
    std::string line;
    std::getline(trace, line);
    REQUIRE(line.find("tick,time_s,x_m,y_m,z_m,tail_x_m,tail_y_m,tail_z_m,fx_n,fy_n,fz_n,") == 0);
    std::size_t at = 0;
    int different = 0, felt = 0;
    for (; std::getline(trace, line); at += 3) {
        std::istringstream cells(line);
        std::string cell;
        for (int column = 0; std::getline(cells, cell, ','); ++column)
            if (column >= 8 && column <= 10) {
                const double force_n = std::stod(cell);
                different += std::abs(sound.samples.at(at + column - 8) - std::clamp(force_n, -1.0, 1.0)) > 1e-7;
                felt += force_n != 0;
            }
    }
    CHECK(at == sound.samples.size()); // and ends where the recording does
    CHECK(felt > 10'000);
    CHECK(different == 0);
}
