// The effect of examples/chai3d, on a plane and a grating of closed form, over a stand-in for CHAI3D.
#include "examples/chai3d/textured_effect.h"

#include "tests/support/catch.h"

#include <cmath>

namespace {

constexpr double turn = 6.283185307179586, wavelength_m = 4e-3, depth_m = 100e-6, stiffness_n_per_m = 500;

struct Block {
    haptel_block_head head;
};

// Waves across x; along the normal it has a slope, too, which no surface can feel.
void waves(const haptel_point* point, const void*, haptel_sample* sample)
{
    sample->height_m = depth_m * std::sin(turn * point->p[0] / wavelength_m);
    sample->gradient[0] = depth_m * turn / wavelength_m * std::cos(turn * point->p[0] / wavelength_m);
    sample->gradient[2] = 3;
}

haptel_texture texture_of_waves()
{
    haptel_texture texture{};
    texture.abi = HAPTEL_ABI_VERSION;
    texture.reads = HAPTEL_READS_POINT;
    texture.height_gradient = waves;
    return texture;
}

// The half space below z = 0, with the waves on it.
struct Felt {
    chai3d::cGenericObject plane;
    Block block{};
    TexturedEffect effect{&plane, texture_of_waves(), block, depth_m};

    Felt() { plane.m_material->setStiffness(stiffness_n_per_m); }
    chai3d::cVector3d force(double x_m, double z_m)
    {
        plane.m_interactionInside = z_m < 0;
        plane.m_interactionPoint = {x_m, 0, 0};
        plane.m_interactionNormal = {0, 0, 1};
        chai3d::cVector3d force_n(9, 9, 9);
        CHECK(effect.computeForce({x_m, 0, z_m}, {}, 0, force_n) == (z_m < 0));
        return force_n;
    }
};

} // namespace

TEST_CASE("chai3d: a texture pushes along the normal, and down its flanks")
{
    Felt felt;
    double sideways = 0;
    for (int step = 0; step < 400; ++step) {
        const double x_m = wavelength_m * (step + 0.5) / 400;
        const auto force_n = felt.force(x_m, -2e-3);
        const double pressed_m = 2e-3 + depth_m * std::sin(turn * x_m / wavelength_m) - depth_m;
        const double slope = depth_m * turn / wavelength_m * std::cos(turn * x_m / wavelength_m);
        CHECK(std::fabs(force_n(2) - stiffness_n_per_m * pressed_m) < 1e-13);
        CHECK(std::fabs(force_n(0) + stiffness_n_per_m * pressed_m * slope) < 1e-13);
        CHECK(force_n(1) == 0);
        sideways += force_n(0);
    }
    CHECK(std::fabs(sideways) < 1e-12); // over a whole wave nothing is won or lost
}

TEST_CASE("chai3d: a texture has no force outside, and none at its highest point on the surface")
{
    Felt felt;
    CHECK(felt.force(1e-3, 1e-6).length() == 0);
    CHECK(felt.force(1e-3, -1e-9).length() < 1e-6);
    CHECK(felt.force(3e-3, -1e-4).length() == 0); // a valley, 0.2 mm below the crest
    felt.effect.setEnabled(false);
    chai3d::cVector3d force_n;
    felt.plane.m_interactionInside = true;
    CHECK_FALSE(felt.effect.computeForce({0, 0, -2e-3}, {}, 0, force_n));
    CHECK(force_n.length() == 0);
}

TEST_CASE("chai3d: a texture is refused where it needs what CHAI3D does not tell")
{
    chai3d::cGenericObject object;
    Block block{};
    haptel_texture texture = texture_of_waves();
    texture.reads |= HAPTEL_READS_UV;
    CHECK_THROWS_AS(TexturedEffect(&object, texture, block, 0), std::invalid_argument);
    texture = texture_of_waves();
    texture.height_gradient = nullptr;
    CHECK_THROWS_AS(TexturedEffect(&object, texture, block, 0), std::invalid_argument);
}
