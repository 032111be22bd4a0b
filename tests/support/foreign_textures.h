// Textures of shared libraries that no Haptel process has made its code for, and what to ask them: points and blocks at
// random, and at the edges of what numbers can be.
#pragma once

#include "lang/abi/abi.h"
#include "lang/abi/outputs.h"
#include "tests/support/catch.h"
#include "tests/support/folder.h"

#include <bit>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <dlfcn.h>
#include <random>
#include <string>
#include <vector>

namespace haptel::test {

// Compiled or linked by the shell's command, in which %o stands for the library and %d for its folder.
class ForeignTextures {
public:
    // A file that the command reads.
    void write(const std::string& name, std::string_view bytes) const { folder.write(name, bytes); }
    void open(std::string command)
    {
        for (const auto& [mark, text] : {std::pair{"%o", folder.file("library.so")}, {"%d", folder.path.string()}})
            for (size_t at; (at = command.find(mark)) != command.npos;) command.replace(at, 2, text);
        INFO(command);
        REQUIRE(std::system((command + " 2>'" + folder.file("said") + "'").c_str()) == 0);
        REQUIRE(std::filesystem::file_size(folder.path / "said") == 0); // no warning either
        library = dlopen(folder.file("library.so").c_str(), RTLD_NOW | RTLD_LOCAL);
        INFO((library ? "" : dlerror()));
        REQUIRE(library);
    }
    ~ForeignTextures()
    {
        if (library) dlclose(library);
    }
    const haptel_texture* texture(const std::string& name) const
    {
        return static_cast<const haptel_texture*>(dlsym(library, ("haptel_texture_" + name).c_str()));
    }
    const void* defaults(const std::string& name) const { return dlsym(library, ("haptel_defaults_" + name).c_str()); }

private:
    Folder folder;
    void* library = nullptr;
};

// Some texels of noise, with channels and levels of the same.
class NoisePicture {
public:
    explicit NoisePicture(uint32_t seed)
    {
        std::mt19937 random(seed);
        for (double& texel : texels) texel = std::uniform_real_distribution(-1.0, 1.0)(random);
        for (int32_t i = 0; i < channels * levels; ++i) parts.push_back(image(i / levels, i % levels));
        whole = image(0, 0);
    }
    const haptel_image* picture() const { return &whole; }

private:
    static constexpr int32_t width = 6, height = 5, channels = 5, levels = 3;
    double texels[(width + 2) * (height + 2)] = {};
    std::vector<haptel_image> parts;
    haptel_image whole = {};

    haptel_image image(int32_t channel, int32_t level)
    {
        if (parts.capacity() == 0) parts.reserve(channels * levels);
        return {
            {texels, texels, texels}, width >> level, height >> level, parts.data(), channels, levels, channel, level};
    }
};

class Stimuli {
public:
    explicit Stimuli(uint32_t seed) : random(seed), picture(seed) {}

    haptel_point point()
    {
        haptel_point made{};
        double numbers[sizeof made / sizeof(double)];
        const double scale = std::pow(10, between(-6, 3));
        for (double& number : numbers) number = scale * between(-1, 1);
        constexpr double edges[] = {0, -0.0, 0.5, 1, 1e-310, 1e6, 1e22, -1e300, HUGE_VAL, -HUGE_VAL, NAN};
        if (random() % 3 == 0) numbers[random() % 3] = edges[random() % std::size(edges)];
        std::memcpy(&made, numbers, sizeof made);
        return made;
    }

    // Parameters within their ranges, all of the box.
    std::vector<double> block(const haptel_texture& texture)
    {
        std::vector<double> made(texture.block_size / sizeof(double));
        for (size_t i = 0; i < sizeof(haptel_block_head) / sizeof(double); ++i) made[i] = between(0, 0.2);
        if (random() % 2 == 0) made[6] = 0; // no footprint
        for (uint32_t i = 0; i < texture.parameter_count; ++i) {
            const haptel_parameter& parameter = texture.parameters[i];
            char* const place = reinterpret_cast<char*>(made.data()) + parameter.offset;
            const bool has_range = std::isfinite(parameter.minimum);
            const double value = has_range && parameter.type == HAPTEL_FLOAT
                                     ? between(parameter.minimum, parameter.maximum)
                                     : parameter.value;
            const auto whole = static_cast<int64_t>(
                has_range ? std::round(between(parameter.minimum, parameter.maximum)) : parameter.value);
            const haptel_image* const image = random() % 4 == 0 ? nullptr : picture.picture();
            if (parameter.type == HAPTEL_FLOAT)
                std::memcpy(place, &value, sizeof value);
            else if (parameter.type == HAPTEL_IMAGE)
                std::memcpy(place, &image, sizeof image);
            else if (parameter.type == HAPTEL_BOOL)
                put(place, static_cast<uint32_t>(random() % 2));
            else
                put(place, static_cast<uint32_t>(whole));
        }
        return made;
    }

private:
    std::mt19937 random;
    NoisePicture picture;

    double between(double least, double most) { return std::uniform_real_distribution(least, most)(random); }
    static void put(char* place, uint32_t word) { std::memcpy(place, &word, sizeof word); }
};

// Bit for bit.
inline bool same_samples(const haptel_sample& a, const haptel_sample& b)
{
    return std::memcmp(&a, &b, offsetof(haptel_sample, faults)) == 0 && a.faults == b.faults &&
           std::memcmp(&a.static_friction_scale, &b.static_friction_scale,
                       sizeof a - offsetof(haptel_sample, static_friction_scale)) == 0;
}

} // namespace haptel::test
