#include "tests/support/catch.h"
#include "tests/tools/commands/run_command.h"
#include "tools/sound/channels.h"
#include "tools/sound/level.h"

#include <cmath>

using namespace haptel::tools::sound;
using haptel::test::contains;

namespace {

// What the channels hold when a hand has gone one way for half a second.
std::vector<float> mixed(std::string_view channels, const Stroked& stroked)
{
    const Channels parsed = parse_channels(channels);
    REQUIRE(parsed.error == "");
    Mixer mixer(parsed.components, 0, 48'000);
    std::vector<float> frame(parsed.components.size());
    for (int i = 0; i < 24'000; ++i) mixer.frame(stroked, frame);
    return frame;
}

} // namespace

TEST_CASE("channels are named by the part of the force that they carry")
{
    CHECK(parse_channels("along").components == std::vector{Component::along});
    CHECK(parse_channels("none,none,along,along").components ==
          std::vector{Component::none, Component::none, Component::along, Component::along});
    CHECK(contains(parse_channels("allong").error, "did you mean 'along'?"));
    CHECK(contains(parse_channels("x,,z").error, "'' is no part of a force: expected along"));
    CHECK(contains(parse_channels("").error, "is no part of a force"));
    CHECK(contains(parse_channels("x,y,z,x,y").error, "1 to 4 channels"));
    CHECK(contains(parse_channels("none,none").error, "all channels are silent"));
    CHECK(contains(parse_channels("x,").error, "is no part of a force"));
    CHECK(parse_channels(std::string(100'000, 'q')).error.size() < 200);
}

TEST_CASE("each channel has its part of the force")
{
    // Over a floor in the direction (3, 4): along it (-0.6, -0.8) . is the force's part.
    const Stroked stroked{{-0.3, -0.4, 2}, {0.06, 0.08, 0.01}, {0, 0, 1}};
    const std::vector<float> frame = mixed("along,normal,z,none", stroked);
    // The hand goes at 0.1 m/s: of its direction 1 / sqrt(1 + 1e-4) is left.
    CHECK(std::abs(frame[0] - -0.5 / std::sqrt(1 + 1e-4)) < 1e-6);
    CHECK(frame[1] == 2);
    CHECK(frame[2] == 2);
    CHECK(frame[3] == 0);
    CHECK(mixed("x,y", stroked) == std::vector{-0.3f, -0.4f});
}

TEST_CASE("a hand at rest has no direction, and in the air the force has no normal")
{
    const std::vector<float> frame = mixed("along,normal", {{1, 2, 3}, {0, 0, 0}, {0, 0, 0}});
    CHECK(frame == std::vector{0.0f, 0.0f});
}

TEST_CASE("the scale is 1 dB above the peak, and what is beyond full scale is cut off and counted")
{
    std::vector<float> samples = {0.5f, -2.0f, 1.0f, -1.0f};
    Level level;
    level.add(samples);
    CHECK(level.peak_n() == 2);
    CHECK(level.rms_n() == 1.25);
    CHECK(std::abs(20 * std::log10(full_scale_n(2.0) / 2) - 1) < 1e-12);
    CHECK(full_scale_n(0) == 1); // of silence
    CHECK(to_full_scale(samples, 1.0) == 1);
    CHECK(samples == std::vector{0.5f, -1.0f, 1.0f, -1.0f});
}
