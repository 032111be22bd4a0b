// A program with a haptic loop of its own, and a texture that was compiled when the program was: it needs no compiler.
#include <haptel/renderer.h>

#include <waves.h> // made of waves.haptel by haptel_add_textures

#include <cmath>
#include <cstdio>

int main()
{
    haptel::SceneBuilder build{haptel::precompiled({&haptel_texture_waves})};
    build
        .add(haptel::plane(0.2),
             {.stiffness_n_per_m = 500, .damping_n_s_per_m = 0, .static_friction = 0, .dynamic_friction = 0})
        .texture("precompiled:waves", {{"wavelength", "4mm"}, {"depth", "0.1mm"}});
    const auto scene = build.finish({.rate_hz = 1000, .force_rise_s = 0});
    haptel::Renderer renderer{scene};
    if (!renderer) return std::fputs(renderer.messages().c_str(), stderr), 1;

    double worst_n = 0;
    for (int tick = 0; tick < 1000; ++tick) { // in from above, then along at 50 mm/s, 2 mm deep
        const double x = 50e-3 * 1e-3 * tick - 0.02, z = std::fmax(-2e-3, 2e-3 - 5e-5 * tick);
        const haptel::Force force = renderer.tick({.tip_m = {x, 0, z}});
        // A spring whose rest is where the texture may be highest: the force of K/2 (depth + height - highest)^2.
        const double height_m = 1e-4 * std::sin(6.283185307179586 * x / 4e-3);
        const double depth_m = -z + height_m - haptel_texture_waves.facts.height_max_m;
        worst_n = std::fmax(worst_n, std::fabs(force.force_n.z - (depth_m > 0 ? 500 * depth_m : 0)));
    }
    std::printf("1000 ticks, the normal force at most %.2g N off that of the spring\n", worst_n);
    return worst_n < 1e-9 ? 0 : 1;
}
