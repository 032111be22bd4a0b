// A scene to render, and its sound as libsndfile reads it.
#pragma once

#include "tests/support/catch.h"
#include "tests/tools/commands/run_command.h"

#include <sndfile.h>

#include <string>
#include <vector>

namespace haptel::test {

struct Heard {
    int channels = 0, rate_hz = 0, format = 0;
    std::vector<double> samples; // channel beside channel; full scale is 1

    std::vector<double> channel(int number) const
    {
        std::vector<double> own;
        for (std::size_t i = static_cast<std::size_t>(number); i < samples.size(); i += channels)
            own.push_back(samples[i]);
        return own;
    }
};

inline Heard heard(const std::string& file)
{
    SF_INFO info{};
    SNDFILE* sound = sf_open(file.c_str(), SFM_READ, &info);
    INFO(file << ": " << sf_strerror(sound));
    REQUIRE(sound);
    Heard all{info.channels, info.samplerate, info.format, {}};
    all.samples.resize(static_cast<std::size_t>(info.frames) * info.channels);
    CHECK(sf_readf_double(sound, all.samples.data(), info.frames) == info.frames);
    sf_close(sound);
    return all;
}

// A hand that goes straight along x, at 100 mm/s, over ridges of a sine; after 0.7 s it has its speed.
struct RidgedFloor {
    Folder folder;
    std::string scene;

    explicit RidgedFloor(const std::string& pitch = "1mm", const std::string& depth = "20um",
                         const std::string& device = "")
    {
        folder.write("ridges.haptel", "texture ridges() { return " + depth + " * sinturn(p.x / " + pitch + "); }\n");
        scene = folder.write("floor.toml", "[device]\nstroke = \"scan\"\nspeed_m_per_s = 0.1\npress_n = 1\n" + device +
                                               "\n[[object]]\nshape = \"plane\"\nsize_m = 1\nstatic_friction = 0\n"
                                               "dynamic_friction = 0\ndamping_n_s_per_m = 0\n"
                                               "texture = \"ridges.haptel:ridges\"\n");
    }
    // Of `haptel render SCENE --out NAME OPTIONS`.
    Ran render(const std::string& name, const std::string& options = "") const
    {
        return run_command("render '" + scene + "' --out '" + folder.file(name) + "' " + options);
    }
};

} // namespace haptel::test
