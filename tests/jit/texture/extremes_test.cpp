// Bounds against what can be found: dense sampling and climbing from the best points, for every texture of the library.
// What is found never leaves the bounds, and at the default parameters the bounds are not far from it.
#include "jit/texture/texture.h"
#include "tests/jit/codegen/samples.h"
#include "tests/support/haptel_files.h"

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
constexpr double turn_per_m = 2 / side_m; // of normals: as on a ball that fills the box

// Where a texture is touched: on balls that pass through the point with that normal.
struct Touch {
    Point p_m, normal;
};

struct Extremes {
    double lowest = INFINITY, highest = -INFINITY, steepest = 0;
};

class Search {
public:
    Search(const TextureBinding& texture, uint32_t seed) : binding(texture), random(seed) {}

    Extremes run(int samples, int climbs)
    {
        for (auto goal : {&Search::height, &Search::depth, &Search::slope}) {
            std::vector<std::pair<double, Touch>> best;
            for (int i = 0; i < samples; ++i) {
                const Touch at = anywhere();
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

    haptel_sample touch(const Touch& at)
    {
        haptel_point point{};
        std::copy(at.p_m.begin(), at.p_m.end(), point.p);
        std::copy(at.normal.begin(), at.normal.end(), point.n);
        for (size_t i = 0; i < 3; ++i)
            for (size_t j = 0; j < 3; ++j)
                point.n_dp[i][j] = turn_per_m * ((i == j ? 1 : 0) - at.normal[i] * at.normal[j]);
        haptel_sample sample{};
        binding.texture->height_gradient(&point, binding.block, &sample);
        if (sample.faults) return {};
        found.lowest = std::min(found.lowest, sample.height_m);
        found.highest = std::max(found.highest, sample.height_m);
        found.steepest =
            std::max(found.steepest, std::hypot(sample.gradient[0], sample.gradient[1], sample.gradient[2]));
        return sample;
    }
    double height(const Touch& at) { return touch(at).height_m; }
    double depth(const Touch& at) { return -touch(at).height_m; }
    double slope(const Touch& at)
    {
        const haptel_sample sample = touch(at);
        return std::hypot(sample.gradient[0], sample.gradient[1], sample.gradient[2]);
    }
    static void make_unit(Point& normal)
    {
        const double length = std::hypot(normal[0], normal[1], normal[2]);
        for (double& part : normal) part /= length;
    }
    Touch anywhere()
    {
        std::uniform_real_distribution inside(-side_m / 2, side_m / 2);
        std::normal_distribution<double> gauss;
        Touch at{{inside(random), inside(random), inside(random)}, {gauss(random), gauss(random), gauss(random)}};
        make_unit(at.normal);
        return at;
    }
    // Steps in random directions, shorter after each that does not lead up.
    void climb(double (Search::*goal)(const Touch&), Touch at)
    {
        std::normal_distribution<double> normal;
        double value = (this->*goal)(at);
        for (double step = 0.5e-3; step > 1e-8;) {
            Touch next = at;
            for (double& part : next.p_m) part = std::clamp(part + step * normal(random), -side_m / 2, side_m / 2);
            for (double& part : next.normal) part += step / side_m * 10 * normal(random);
            make_unit(next.normal);
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
    for (const char* word : {"hybrid", "warp", "dperlin", "dnoise", "footprint"})
        if (name.find(word) != std::string::npos) return true;
    return false;
}

TextureRequest request()
{
    TextureRequest over = test::request_over(side_m);
    over.normal_turn_max_per_m = turn_per_m;
    return over;
}

std::string with_value(const haptel_parameter& parameter, double value)
{
    char text[40];
    std::snprintf(text, sizeof text, parameter.type == HAPTEL_FLOAT ? "%.17g" : "%.0f", value);
    if (parameter.type == HAPTEL_BOOL) return value != 0 ? "true" : "false";
    return text + std::string(parameter.unit);
}

} // namespace

TEST_CASE("bounds of every library texture hold, and are near what is found")
{
    std::printf("%-28s %23s %23s %6s %10s %10s %6s  %s\n", "texture", "found height (um)", "bound", "ratio",
                "found slope", "bound", "ratio", "class");
    const std::vector<std::filesystem::path> files = test::texture_files({"stdlib/tests"});
    size_t tried = 0;
    for (const std::filesystem::path& file : files) {
        const jit::CompiledTextures compiled = jit::compile_texture_file(file);
        INFO(compiled.rendered());
        REQUIRE(compiled.program);
        for (const haptel_texture& texture : compiled.program->textures()) {
            const std::string name = texture.name;
            CAPTURE(name);
            const TextureResult made = jit::make_binding(compiled.program, name, request(), jit::For::figures);
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
            CHECK(slope_ratio <= (is_loose ? 12 : 4));

            // over the parameters' box: the bounds of each choice of values hold as well
            std::mt19937 random(static_cast<uint32_t>(tried++));
            for (int choice = 0; choice < 4; ++choice) {
                TextureRequest chosen = request();
                for (uint32_t i = 0; i < texture.parameter_count; ++i) {
                    const haptel_parameter& parameter = texture.parameters[i];
                    if (!std::isfinite(parameter.minimum)) continue;
                    double value = std::uniform_real_distribution(parameter.minimum, parameter.maximum)(random);
                    if (parameter.type != HAPTEL_FLOAT) value = std::round(value);
                    chosen.parameters.emplace_back(parameter.name, with_value(parameter, value));
                }
                const TextureResult other = jit::make_binding(compiled.program, name, chosen, jit::For::figures);
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
    CHECK(tried > 2 * files.size());
}
