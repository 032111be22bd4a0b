// f64 far from the origin: the gradient of every library texture against the 113-bit oracle, up to 1e6 wavelengths
// away.
//
// With a wavelength that is a power of two, a coordinate divided by it is exact, and what is left is the arithmetic of
// the library: it must keep the place within a cell, by exact reductions. With any wavelength the division rounds; no
// more than eight times what half an ulp of the coordinates changes may come from that.
#include "jit/check/oracle.h"
#include "jit/texture/texture.h"
#include "tests/support/catch.h"
#include "tests/support/haptel_files.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <random>
#include <set>

using namespace haptel;

namespace {

constexpr double unit = 0x1p-52, reaches[] = {1, 1e3, 1e6}; // wavelengths
const std::set<std::string> wavelengths{"wavelength", "size", "period", "spacing",
                                        "thread"}; // what parameters call them

// Textures whose own sum, p.x + 0.5 p.y, is exact only where the coordinates leave it room.
bool adds_coordinates(const std::string& texture)
{
    return texture == "wave_plain" || texture == "grating_plain";
}

// Textures of places that are moved: a sum or a turn rounds them as a division does.
bool moves_places(const std::string& texture)
{
    return texture.starts_with("domain_warp") || texture.starts_with("rotate");
}

// Largest over the points; shares of the largest true gradient.
struct Far {
    double error = 0, conditioning = 0;
};

// Random points within so many metres, at multiples of `grid_m`; 0: anywhere.
Far far_from(const std::shared_ptr<const jit::CompiledProgram>& program, const TextureBinding& binding, double reach_m,
             double grid_m)
{
    jit::Oracle oracle(program, binding);
    std::mt19937_64 random(11);
    std::uniform_real_distribution<double> place(-reach_m, reach_m);
    const auto distance = [](const double(&a)[3], const double(&b)[3]) {
        return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
    };
    Far far;
    double largest = 0;
    for (int i = 0; i < 60; ++i) {
        haptel_point point{{place(random), place(random), place(random)},
                           {0.6, 0.48, 0.64},
                           {0.3, 0.7},
                           0,
                           {},
                           {},
                           {},
                           0,
                           0,
                           {},
                           {},
                           0};
        for (double& coordinate : point.p)
            if (grid_m != 0) coordinate = std::round(coordinate / grid_m) * grid_m;
        haptel_sample found{};
        binding.texture->height_gradient(&point, binding.block, &found);
        const jit::OracleSample truth = oracle.sample(point);
        for (double& coordinate : point.p) coordinate = std::nextafter(coordinate, HUGE_VAL);
        const jit::OracleSample beside = oracle.sample(point);
        largest = std::max(largest, std::hypot(truth.gradient[0], truth.gradient[1], truth.gradient[2]));
        far.error = std::max(far.error, distance(found.gradient, truth.gradient));
        far.conditioning = std::max(far.conditioning, distance(beside.gradient, truth.gradient) / 2); // by an ulp
    }
    return {far.error / largest, far.conditioning / largest};
}

// Wavelengths and factors between them at powers of two, or at anything else.
TextureRequest request_for(const haptel_texture& texture, bool is_exact, bool& has_wavelength)
{
    TextureRequest request;
    for (uint32_t i = 0; i < texture.parameter_count; ++i) {
        const std::string name = texture.parameters[i].name;
        const bool is_wavelength = texture.parameters[i].type == HAPTEL_FLOAT && wavelengths.count(name) > 0;
        has_wavelength = has_wavelength || is_wavelength;
        if (is_wavelength) request.parameters.push_back({name, is_exact ? "0.00390625" : "3.7mm"});
        if (name == "lacunarity" && is_exact) request.parameters.push_back({name, "2"});
    }
    return request;
}

} // namespace

TEST_CASE("f64 keeps the place within a wavelength up to 1e6 of them from the origin")
{
    const std::vector<std::filesystem::path> files = test::texture_files({"stdlib/tests"});
    size_t textures = 0;
    for (const std::filesystem::path& path : files) {
        const std::string file = path.filename();
        const jit::CompiledTextures compiled = jit::compile_texture_file(path);
        INFO(compiled.rendered());
        REQUIRE(compiled.program);
        for (const haptel_texture& texture : compiled.program->textures()) {
            const std::string name = texture.name;
            for (const bool is_exact : {true, false}) {
                bool has_wavelength = false;
                const TextureRequest request = request_for(texture, is_exact, has_wavelength);
                if (!has_wavelength) continue;
                const TextureResult bound = jit::make_binding(compiled.program, name, request, jit::For::figures);
                INFO(bound.diagnostics);
                REQUIRE(bound.binding);
                const double wavelength_m = is_exact ? 0x1p-8 : 0.0037;
                const double grid_m = is_exact && adds_coordinates(name) ? 0x1p-36 : 0;
                textures += is_exact;
                for (const double reach : reaches) {
                    const Far far = far_from(compiled.program, *bound.binding, reach * wavelength_m, grid_m);
                    INFO(file << " " << name << " within " << reach << " wavelengths of " << wavelength_m
                              << " m, in units of 2^-52: error " << far.error / unit << ", conditioning "
                              << far.conditioning / unit);
                    CHECK(far.error <= 16 * unit + (is_exact && !moves_places(name) ? 0 : 8 * far.conditioning));
                }
            }
        }
    }
    CHECK(textures >= 2 * files.size());
}
