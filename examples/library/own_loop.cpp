// A program with a haptic loop of its own, and a texture that needs no compiler: a grating, written by hand as
// `haptel build` would write it.
#include <haptel/renderer.h>

#include <cmath>
#include <cstddef>
#include <cstdio>

namespace {

constexpr double two_pi = 6.283185307179586;

struct Block { // as the parameters below say
    haptel_block_head head;
    double wavelength_m, depth_m;
};

void height_gradient(const haptel_point* at, const void* block, haptel_sample* sample)
{
    const auto& own = *static_cast<const Block*>(block);
    const double angle = two_pi * at->p[0] / own.wavelength_m;
    sample->height_m = own.depth_m * std::sin(angle);
    sample->gradient[0] = own.depth_m * two_pi / own.wavelength_m * std::cos(angle);
    sample->gradient[1] = sample->gradient[2] = 0;
    sample->stiffness_scale = sample->friction_scale = 1;
    sample->faults = 0;
}

constexpr haptel_parameter parameters[] = {
    {"wavelength", "m", "From crest to crest", HAPTEL_FLOAT, offsetof(Block, wavelength_m), 4e-3, 1e-3, 2e-2},
    {"depth", "m", "Of the grooves", HAPTEL_FLOAT, offsetof(Block, depth_m), 1e-4, 0, 1e-3},
};

haptel_texture grating()
{
    haptel_texture texture{};
    texture.abi = HAPTEL_ABI_VERSION;
    texture.size = sizeof texture;
    texture.reads = HAPTEL_READS_POINT;
    texture.block_size = sizeof(Block);
    texture.parameter_count = 2;
    texture.name = "grating";
    texture.parameters = parameters;
    texture.facts = {-1e-3, 1e-3, two_pi, 4e4, HAPTEL_CONTINUITY_C1, 0}; // over all values of the parameters
    texture.height_gradient = height_gradient;
    return texture;
}

} // namespace

int main()
{
    const haptel_texture texture = grating();
    haptel::SceneBuilder build{haptel::precompiled({&texture})};
    build
        .add(haptel::plane(0.2),
             {.stiffness_n_per_m = 500, .damping_n_s_per_m = 0, .static_friction = 0, .dynamic_friction = 0})
        .texture("precompiled:grating", {{"depth", "0.1mm"}});
    const auto scene = build.finish({.rate_hz = 1000, .force_rise_s = 0});
    haptel::Renderer renderer{scene};
    if (!renderer) return std::fputs(renderer.messages().c_str(), stderr), 1;

    double worst_n = 0;
    for (int tick = 0; tick < 1000; ++tick) { // in from above, then along at 50 mm/s, 2 mm deep
        const double x = 50e-3 * 1e-3 * tick - 0.02, z = std::fmax(-2e-3, 2e-3 - 5e-5 * tick);
        const haptel::Force force = renderer.tick({.tip_m = {x, 0, z}});
        // A spring from the texture's highest to the hand: the force of the potential K/2 (depth + height - most)^2.
        const double angle = two_pi * x / 4e-3, depth_m = -z + 1e-4 * std::sin(angle) - 1e-3;
        const double expected_n = depth_m > 0 ? 500 * depth_m : 0;
        worst_n = std::fmax(worst_n, std::fabs(force.force_n.z - expected_n));
    }
    std::printf("1000 ticks, the normal force at most %.2g N off that of the spring\n", worst_n);
    return worst_n < 1e-9 ? 0 : 1;
}
