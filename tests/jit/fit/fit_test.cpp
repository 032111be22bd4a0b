// Parameters that were hidden in a height map come back.
#include "tests/jit/fit/hidden.h"
#include "tests/support/catch.h"
#include "tests/support/project_path.h"
#include "tests/support/tries.h"

#include <algorithm>
#include <random>
#include <span>
#include <sstream>

using namespace haptel;
using namespace haptel::jit;

namespace {

struct Case {
    const char *file, *texture;
    double side_mm;
};

constexpr Case examples[] = {{"brushed", "brushed", 10},     {"cast", "cast", 20},
                             {"corduroy", "corduroy", 20},   {"dimples", "dimples", 30},
                             {"grating", "grating", 20},     {"knurl", "knurl", 20},
                             {"leather", "leather", 20},     {"ripples", "ripples", 60},
                             {"rock", "rock", 20},           {"rubber", "rubber", 20},
                             {"sandpaper", "sandpaper", 10}, {"stone", "stone", 20},
                             {"taped", "taped", 60},         {"wall", "wall", 30},
                             {"weathered", "grain", 30},     {"weathered", "rust", 30},
                             {"weathered", "boards", 30},    {"weathered", "weathered", 30},
                             {"weave", "weave", 20},         {"wood", "wood", 30}};

// Of the library of materials.
constexpr Case materials[] = {{"fabric/aida", "aida", 15},
                              {"fabric/burlap", "burlap", 20},
                              {"fabric/corduroy", "corduroy", 20},
                              {"fabric/denim", "denim", 6},
                              {"fabric/jersey", "jersey", 20},
                              {"food/orange", "orange", 15},
                              {"food/waffle", "waffle", 80},
                              {"leather/calf", "calf", 10},
                              {"leather/pebbled", "pebbled", 20},
                              {"metal/brushed", "brushed", 10},
                              {"metal/cast", "cast", 30},
                              {"metal/knurl", "knurl", 10},
                              {"metal/milled", "milled", 12},
                              {"metal/perforated", "perforated", 60},
                              {"metal/turned", "turned", 6},
                              {"paper/laid", "laid", 40},
                              {"perception/dots", "dots", 30},
                              {"perception/jvp_dome", "jvp_dome", 20},
                              {"perception/metal_grating", "metal_grating", 10},
                              {"perception/sine_grating", "sine_grating", 60},
                              {"plastic/layers", "layers", 4},
                              {"plastic/lenticular", "lenticular", 6},
                              {"plastic/studs", "studs", 60},
                              {"stone/granite", "granite", 30},
                              {"stone/gravel", "gravel", 40},
                              {"stone/sandstone", "sandstone", 8},
                              {"wood/cork", "cork", 30},
                              {"wood/oak", "oak", 20},
                              {"wood/planed", "planed", 30},
                              {"wood/spruce", "spruce", 25}};

void find_hidden(const std::string& folder, std::span<const Case> cases, uint64_t seed)
{
    for (std::size_t i = 0; i < cases.size(); i += test::is_sanitized ? 10 : 1) {
        const Case& each = cases[i];
        const CompiledTextures compiled = compiled_for_fit(test::project_path(folder + each.file + ".haptel"));
        REQUIRE(compiled.program);
        const Hidden hidden = hidden_texture(compiled.program, each.texture, each.side_mm * 1e-3, 160, seed);
        FitRequest request;
        request.texture = each.texture;
        const FitResult found = fit_heights(compiled.program, request, hidden.map);
        std::ostringstream said;
        said << each.texture << ", seed " << seed << ": off by " << found.of_all << found.failure;
        for (const Undetermined& named : found.undetermined) said << "; " << named.name << ": " << named.why;
        for (const std::string& wrong : lost(hidden, found)) said << "; LOST " << wrong;
        INFO(said.str());
        CHECK(found.failure.empty());
        CHECK(lost(hidden, found).empty());
    }
}

} // namespace

TEST_CASE("hidden parameters of the examples come back within 1 %, or what cannot be told apart is named")
{
    find_hidden("examples/textures/", examples, 2);
}

TEST_CASE("hidden parameters of materials come back within 1 %, or what cannot be told apart is named")
{
    find_hidden("materials/", materials, 2);
}

TEST_CASE("the same of other hidden parameters", "[.long]")
{
    for (const uint64_t seed : {1, 3, 4, 5, 6}) find_hidden("examples/textures/", examples, seed);
}

TEST_CASE("what cannot be told apart is named: a phase, a factor of a factor, what has no effect")
{
    constexpr const char* twins = R"(
texture twins(float depth = 0.1mm in 0.01mm .. 1mm, float part = 0.5 in 0.1 .. 1.0, float pitch = 2mm in 0.5mm .. 8mm,
              float phase = 0.2 in 0.0 .. 2.0, float unused = 1.0 in 0.5 .. 2.0)
{
    return depth * part * sinturn(p.x / pitch + phase);
}
)";
    TextureOptions options;
    options.entries = Entries::both_and_batches;
    options.precision = Precision::f64;
    const CompiledTextures compiled = compile_texture(twins, options);
    REQUIRE(compiled.program);
    const Hidden hidden = hidden_texture(compiled.program, "twins", 0.02, 100, 3);
    FitRequest request;
    request.texture = "twins";
    FitResult found = fit_heights(compiled.program, request, hidden.map);
    CHECK(found.of_all < 1e-6);
    const auto is_named = [&](const char* name) {
        return std::ranges::count(found.undetermined, name, &Undetermined::name) == 1;
    };
    CHECK(is_named("depth"));
    CHECK(is_named("part"));
    CHECK(is_named("unused"));
    CHECK(!is_named("pitch"));
    CHECK(lost(hidden, found).empty());

    request.parameters = {{"part", "0.5"}, {"unused", "1"}};
    found = fit_heights(compiled.program, request, hidden.map);
    CHECK(!is_named("depth"));
    CHECK(is_named("phase")); // once more, a period on
    CHECK(found.parameters[1].value == 0.5);
    CHECK(!found.parameters[1].is_free);
    CHECK(found.parameters[0].value ==
          Approx(2 * hidden.parameters[0].value * hidden.parameters[1].value).epsilon(1e-6));
}

TEST_CASE("noise of a map widens what is known, and the parameters are within it")
{
    const CompiledTextures compiled = compiled_for_fit(test::project_path("examples/textures/wood.haptel"));
    REQUIRE(compiled.program);
    Hidden hidden = hidden_texture(compiled.program, "wood", 0.03, 160, 4);
    std::mt19937_64 random(9);
    std::normal_distribution<double> noise(0, 5e-6);
    for (double& height : hidden.map.heights_m) height += noise(random);
    FitRequest request;
    request.texture = "wood";
    const FitResult found = fit_heights(compiled.program, request, hidden.map);
    CHECK(found.error == Approx(5e-6).epsilon(0.05));
    CHECK(lost(hidden, found).empty());
}

TEST_CASE("what cannot be fitted is refused in words")
{
    const CompiledTextures compiled = compiled_for_fit(test::project_path("examples/textures/wood.haptel"));
    REQUIRE(compiled.program);
    FitRequest request;
    request.texture = "wood";
    HeightMap map{8, 8, 1e-4, std::vector<double>(64, 1e-3)};
    CHECK(fit_heights(compiled.program, request, map).failure.find("flat") != std::string::npos);
    map = {3, 3, 1e-4, {1, 2, 3, 4, 5, 6, 7, 8, 9}};
    CHECK(fit_heights(compiled.program, request, map).failure.find("4 by 4") != std::string::npos);
    request.texture = "wod";
    CHECK(fit_heights(compiled.program, request, map).failure.find("wood") != std::string::npos);
    Stroke stroke;
    stroke.stiffness_n_per_m = 700;
    stroke.passes = {{1, 2, 3}};
    CHECK(fit_stroke(compiled.program, request, stroke).failure.find("samples") != std::string::npos);
}
