// Textures whose height is proven too wide, or not at all, are felt all the same.
#include "tests/jit/texture/idioms.h"
#include "tests/surface/textured.h"

#include <random>

using namespace haptel;
using namespace haptel::runtime;
using namespace haptel::test;
using tests::at;

TEST_CASE("a texture that is proven too wide is felt nearly as hard as a model that needs no bound says")
{
    constexpr double depth_m = 1e-3;
    const auto program = compiled(std::string(idioms) + "texture pole() { return 1um / (p.x / 1m); }");
    const Mesh mesh = tests::plane_mesh(0.05);
    for (const haptel_texture& texture : program->textures()) {
        const auto felt_n = [&](ForceModel model, double x, double y) {
            Scene scene = *textured_scene(mesh, program, texture.name);
            scene.servo.force.model = model;
            Renderer renderer(tests::shared(std::move(scene)));
            renderer.tick(at(x, y, 1e-3));
            return renderer.tick(at(x, y, -depth_m)).force_n;
        };
        std::mt19937_64 random(7);
        std::uniform_real_distribution<double> place(-0.02, 0.02);
        const bool is_pole = std::string(texture.name) == "pole";
        for (int i = 0; i < 40; ++i) {
            const double x = place(random), y = place(random);
            const double by_bound_n = felt_n(ForceModel::displaced, x, y).z,
                         without_n = felt_n(ForceModel::lateral, x, y).z;
            CAPTURE(texture.name, x, y, by_bound_n, without_n);
            CHECK(without_n == Approx(1000 * depth_m));
            if (!is_pole) CHECK(by_bound_n > 0.8 * without_n);
            CHECK(by_bound_n <= without_n);
        }
        if (is_pole) CHECK(felt_n(ForceModel::displaced, 0.5e-3, 0).z > 0); // where it is higher than most
    }
}
