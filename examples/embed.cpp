// Haptel in a program of your own: a texture from text, called directly; then a scene from a file, felt by the
// simulated hand.   embed examples/scenes/rock.toml
#include "device/device_factory.h"
#include "jit/texture/resolver.h"
#include "jit/texture/texture.h"
#include "runtime/files/scene_file.h"
#include "runtime/servo/servo_thread.h"

#include <fmt/core.h>

using namespace haptel;

namespace {

constexpr auto ripple = R"(
/// Rings round the origin.
texture ripple(float wavelength = 4mm in 1mm .. 20mm, float depth = 50um in 0um .. 200um)
{
    return depth * sinturn(length(p.xy) / wavelength);
})";

bool call_a_texture()
{
    const auto compiled = jit::compile_texture(ripple);
    if (!compiled.program) return fmt::print("{}", compiled.rendered()), false;

    const TextureRequest request{"ripple", {{"depth", "80um"}}, {-0.1, -0.1, -0.1}, {0.1, 0.1, 0.1}, 0};
    const TextureResult made = jit::make_binding(compiled.program, "ripple", request);
    if (!made.binding) return fmt::print("{}", made.diagnostics), false;

    haptel_point point{};
    point.p[0] = 3.1e-3, point.p[1] = 4.2e-3;
    haptel_sample sample{};
    made.binding->texture->height_gradient(&point, made.binding->block, &sample);
    fmt::print("ripple at 3.1 mm, 4.2 mm: height {:.2f} um, slope {:.4f} in x and {:.4f} in y, never above {:.2f} um\n",
               1e6 * sample.height_m, sample.gradient[0], sample.gradient[1], 1e6 * made.binding->facts.height_max_m);
    return true;
}

bool feel_a_scene(const char* file)
{
    runtime::LoadedScene loaded = runtime::load_scene(file, jit::make_resolver(), device::open_device);
    fmt::print("{}", loaded.diagnostics);
    if (!loaded.scene) return false;

    runtime::LoadedHand& hand = loaded.hands.front();
    runtime::ServoThread servo(loaded.scene, std::move(hand.device), {.hand = hand.settings, .seconds = 2});
    servo.start();
    const runtime::ServoReport& report = servo.wait();
    fmt::print("{} ticks, {} in contact, force at most {:.2f} N, {} deadlines missed\n", report.ticks,
               report.contact_ticks, report.force_max_n, report.missed_deadlines);
    return true;
}

} // namespace

int main(int count, char** arguments)
{
    return call_a_texture() && (count < 2 || feel_a_scene(arguments[1])) ? 0 : 1;
}
