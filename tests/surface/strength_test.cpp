// How strong a texture feels does not depend on triangles or size: height and wavelength are metres.
#include "tests/support/tries.h"
#include "tests/surface/textured.h"

#include <cmath>
#include <numbers>
#include <random>

using namespace haptel;
using namespace haptel::runtime;
using namespace haptel::test;
using tests::at;
using tests::plane_mesh;

namespace {

const char* const strength_source = R"(
texture ripples() { return 50um * sinturn(p.x / 3mm) * costurn(p.y / 4mm); }
texture rock() { return 100um * fbm(p / 5mm, 4); }
texture printed(float tiles = 1 in 0.1 .. 100) { return 50um * sinturn(tiles * uv.x) * costurn(tiles * uv.y); }
)";

struct Felt {
    double lateral_per_normal = 0; // rms of one over rms of the other
    std::vector<glm::dvec3> forces_n;
};

// A hand that is pressed into the plane and wanders over 8 mm of it.
Felt felt_on(const std::shared_ptr<const Scene>& scene)
{
    Renderer renderer(scene);
    renderer.tick(at(0, 0, 1e-3));
    std::mt19937 random(4);
    std::uniform_real_distribution<double> depth_m(0.3e-3, 0.6e-3);
    Felt felt;
    double lateral = 0, normal = 0;
    for (int i = 0; i < tries(20000); ++i) {
        const double t = i * 1e-3;
        const glm::dvec3 f =
            renderer.tick(at(4e-3 * std::sin(1.1 * t), 4e-3 * std::cos(1.7 * t), -depth_m(random))).force_n;
        lateral += f.x * f.x + f.y * f.y;
        normal += f.z * f.z;
        felt.forces_n.push_back(f);
    }
    felt.lateral_per_normal = std::sqrt(lateral / normal);
    return felt;
}

double furthest(const Felt& a, const Felt& b)
{
    double result = 0;
    for (std::size_t i = 0; i < a.forces_n.size(); ++i)
        result = std::max(result, glm::distance(a.forces_n[i], b.forces_n[i]));
    return result;
}

} // namespace

TEST_CASE("anchors row 2: texture strength is the same from 2 to 131072 triangles and at every size")
{
    const auto program = compiled(strength_source);
    for (const char* texture : {"ripples", "rock", "printed"}) {
        CAPTURE(texture);
        // `printed` is drawn on the mesh, 2.5 mm a tile whatever the mesh's size.
        const auto on = [&](double side_m, uint32_t cells) {
            Values values;
            if (std::string(texture) == "printed") values = {{"tiles", std::to_string(std::lround(side_m / 2.5e-3))}};
            return felt_on(textured_scene(plane_mesh(side_m, cells), program, texture, values));
        };
        const Felt coarse = on(0.1, 1);
        REQUIRE(coarse.forces_n.size() == std::size_t(tries(20000)));
        CHECK(coarse.lateral_per_normal > 0.02);
        const uint32_t many = is_sanitized ? 64 : 256; // which takes long to build them
        for (const auto& [side_m, cells] : {std::pair{0.1, 4u}, {0.1, many}, {0.01, 1u}, {0.01, many}, {1.0, many}}) {
            CAPTURE(side_m, cells);
            const Felt other = on(side_m, cells);
            CHECK(std::abs(other.lateral_per_normal / coarse.lateral_per_normal - 1) < 0.01);
            CHECK(furthest(other, coarse) < 1e-5); // N, of forces about 0.5 N: only rounding of the geometry differs
        }
    }
}

TEST_CASE("the lateral force over the normal one is the slope of the texture")
{
    const auto program = compiled("texture ripples() { return 50um * sinturn(p.x / 3mm); }");
    const Felt felt = felt_on(textured_scene(plane_mesh(0.1, 64), program, "ripples"));
    const double wave_per_m = 2 * std::numbers::pi / 3e-3;
    std::mt19937 random(4);
    std::uniform_real_distribution<double> depth_m(0.3e-3, 0.6e-3);
    for (std::size_t i = 0; i < felt.forces_n.size(); ++i) {
        const double x = 4e-3 * std::sin(1.1e-3 * static_cast<double>(i)), d = depth_m(random);
        const double normal_n = 1000 * (d + 50e-6 * (std::sin(wave_per_m * x) - 1));
        CHECK(std::abs(felt.forces_n[i].z - normal_n) < 1e-7);
        CHECK(std::abs(felt.forces_n[i].x + normal_n * 50e-6 * wave_per_m * std::cos(wave_per_m * x)) < 1e-7);
    }
}
