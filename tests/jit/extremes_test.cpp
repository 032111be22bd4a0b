// Bounds against what can be found: dense sampling and climbing from the best points, for every texture of the library.
// What is found never leaves the bounds, and at the default parameters the bounds are not far from it.
#include "jit/texture.h"
#include "tests/jit/samples.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

using namespace haptel;

namespace {

using Point = std::array<double, 3>;
constexpr double side_m = 0.05;

struct Extremes {
    double lowest = INFINITY, highest = -INFINITY, steepest = 0;
};

class Search {
public:
    Search(const TextureBinding& texture, uint32_t seed) : binding(texture), random(seed) {}

    Extremes run(int samples, int climbs)
    {
        for (auto goal : {&Search::height, &Search::depth, &Search::slope}) {
            std::vector<std::pair<double, Point>> best;
            for (int i = 0; i < samples; ++i) {
                const Point at = anywhere();
                best.emplace_back((this->*goal)(at), at);
            }
            const auto better = [](const auto& a, const auto& b) { return a.first > b.first; };
            const auto count = std::min<std::ptrdiff_t>(climbs, samples);
            std::partial_sort(best.begin(), best.begin() + count, best.end(), better);
            for (std::ptrdiff_t i = 0; i < count; ++i) climb(goal, best[static_cast<size_t>(i)].second);
        }
        return found;
    }

private:
    const TextureBinding& binding;
    std::mt19937 random;
    Extremes found;

    haptel_sample touch(const Point& at)
    {
        haptel_point point{};
        std::copy(at.begin(), at.end(), point.p);
        point.n[2] = 1;
        haptel_sample sample{};
        binding.texture->height_gradient(&point, binding.block, &sample);
        if (sample.faults) return {};
        found.lowest = std::min(found.lowest, sample.height_m);
        found.highest = std::max(found.highest, sample.height_m);
        found.steepest =
            std::max(found.steepest, std::hypot(sample.gradient[0], sample.gradient[1], sample.gradient[2]));
        return sample;
    }
    double height(const Point& at) { return touch(at).height_m; }
    double depth(const Point& at) { return -touch(at).height_m; }
    double slope(const Point& at)
    {
        const haptel_sample sample = touch(at);
        return std::hypot(sample.gradient[0], sample.gradient[1], sample.gradient[2]);
    }
    Point anywhere()
    {
        std::uniform_real_distribution inside(-side_m / 2, side_m / 2);
        return {inside(random), inside(random), inside(random)};
    }
    // Steps in random directions, shorter after each that does not lead up.
    void climb(double (Search::*goal)(const Point&), Point at)
    {
        std::normal_distribution<double> normal;
        double value = (this->*goal)(at);
        for (double step = 0.5e-3; step > 1e-8;) {
            Point next = at;
            for (double& part : next) part = std::clamp(part + step * normal(random), -side_m / 2, side_m / 2);
            const double there = (this->*goal)(next);
            if (there > value)
                at = next, value = there;
            else
                step *= 0.9;
        }
    }
};

// Compositions whose parts cannot be extreme in one place.
bool is_warped_or_hybrid(const std::string& name)
{
    for (const char* word : {"hybrid", "warp", "dperlin", "dnoise", "footprint", "mapped", "triplanar"})
        if (name.find(word) != std::string::npos) return true;
    return false;
}

// Maps round a centre turn ever faster towards it, and jump behind it; what is mapped by the normal is as steep as the
// mesh turns its normals. In a solid cube there is no bound of their slope, and none is claimed.
bool is_without_slope(const std::string& name)
{
    return name == "sphere_mapped" || name == "cylinder_mapped" || name == "cube_mapped" || name == "triplanar_mapped";
}

std::string with_value(const haptel_parameter& parameter, double value)
{
    char text[40];
    std::snprintf(text, sizeof text, parameter.type == HAPTEL_FLOAT ? "%.17g" : "%.0f", value);
    if (parameter.type == HAPTEL_BOOL) return value != 0 ? "true" : "false";
    return text + std::string(parameter.unit);
}

std::vector<std::string> library_files()
{
    std::vector<std::string> files;
    for (const auto& entry : std::filesystem::directory_iterator(HAPTEL_SOURCE_DIR "/stdlib/tests"))
        if (entry.path().extension() == ".haptel") files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

} // namespace

TEST_CASE("bounds of every library texture hold, and are near what is found")
{
    std::printf("%-28s %23s %23s %6s %10s %10s %6s  %s\n", "texture", "found height (um)", "bound", "ratio",
                "found slope", "bound", "ratio", "class");
    size_t tried = 0;
    for (const std::string& file : library_files()) {
        const jit::CompiledTextures compiled = jit::compile_texture_file(file);
        INFO(compiled.rendered());
        REQUIRE(compiled.program);
        for (const haptel_texture& texture : compiled.program->textures()) {
            const std::string name = texture.name;
            CAPTURE(name);
            const TextureResult made = jit::make_binding(compiled.program, name, test::request_over(side_m));
            REQUIRE(made.binding);
            const haptel_facts& facts = made.binding->facts;
            const Extremes found = Search(*made.binding, 1).run(4000, 12);
            const double rounding = 1e-12 * (facts.height_max_m - facts.height_min_m);
            CHECK(found.lowest >= facts.height_min_m - rounding);
            CHECK(found.highest <= facts.height_max_m + rounding);
            CHECK(found.steepest <= facts.slope_max * (1 + 1e-12));
            const double height_ratio = (facts.height_max_m - facts.height_min_m) / (found.highest - found.lowest);
            const double slope_ratio = facts.slope_max / found.steepest;
            const char* classes[] = {"-", "jump", "C0", "C1"};
            std::printf("%-28s %10.3g .. %9.3g %10.3g .. %9.3g %6.2f %10.3g %10.3g %6.2f  %s\n", name.c_str(),
                        1e6 * found.lowest, 1e6 * found.highest, 1e6 * facts.height_min_m, 1e6 * facts.height_max_m,
                        height_ratio, found.steepest, facts.slope_max, slope_ratio, classes[facts.continuity]);
            const bool is_loose = is_warped_or_hybrid(name);
            CHECK(height_ratio <= (is_loose ? 12 : 3));
            if (is_without_slope(name))
                CHECK(facts.slope_max > 1e9);
            else
                CHECK(slope_ratio <= (is_loose ? 12 : 4));

            // over the parameters' box: the bounds of each choice of values hold as well
            std::mt19937 random(static_cast<uint32_t>(tried++));
            for (int choice = 0; choice < 4; ++choice) {
                TextureRequest request = test::request_over(side_m);
                for (uint32_t i = 0; i < texture.parameter_count; ++i) {
                    const haptel_parameter& parameter = texture.parameters[i];
                    if (!std::isfinite(parameter.minimum)) continue;
                    double value = std::uniform_real_distribution(parameter.minimum, parameter.maximum)(random);
                    if (parameter.type != HAPTEL_FLOAT) value = std::round(value);
                    request.parameters.emplace_back(parameter.name, with_value(parameter, value));
                }
                const TextureResult other = jit::make_binding(compiled.program, name, request);
                INFO(other.diagnostics);
                REQUIRE(other.binding);
                const haptel_facts& bounds = other.binding->facts;
                const Extremes there = Search(*other.binding, 2).run(400, 3);
                const double slack = 1e-12 * (bounds.height_max_m - bounds.height_min_m);
                CHECK(there.lowest >= bounds.height_min_m - slack);
                CHECK(there.highest <= bounds.height_max_m + slack);
                CHECK(there.steepest <= bounds.slope_max * (1 + 1e-12));
            }
        }
    }
    CHECK(tried > 50);
}
