#include "tools/sound/render_scene.h"

#include "device/device_factory.h"
#include "tools/output/terminal.h"

#include <fmt/format.h>
#include <utility>

namespace haptel::tools {

RenderScene load_to_render(const RenderOptions& options, ExploreTextures& textures, runtime::SurfaceCache& surfaces)
{
    const auto devices = [&, first = true](runtime::DeviceRequest request) mutable {
        const bool is_replaced = std::exchange(first, false) && !options.device.empty();
        if (is_replaced) request.name = options.device;
        request.exact_positions = true;
        runtime::DeviceResult opened = device::open_device(request);
        if (!opened.device && request.name.starts_with("replay:"))
            opened.error +=
                fmt::format("\n  a sound has {0:g} samples a second: a hand that is to be heard is recorded "
                            "by `haptel explore` with `rate_hz = {0:g}`",
                            device::sound_rate_hz);
        if (is_replaced && !opened.device)
            opened.error = fmt::format("`--device {}` in its place: {}", request.name, opened.error);
        return opened;
    };
    Steps steps;
    const runtime::Loading loading{[&](std::string_view doing) { steps.show(doing); }};
    runtime::LoadedScene loaded = runtime::load_scene(options.scene, textures.resolver(), devices, &surfaces, loading,
                                                      {.rate_hz = device::sound_rate_hz});
    if (!loaded.scene || loaded.hands.empty()) return {nullptr, nullptr, std::move(loaded.diagnostics)};
    auto stroke = std::make_unique<sound::StrokeForce>(loaded.scene, std::move(loaded.hands.front()));
    return {std::move(loaded.scene), std::move(stroke), std::move(loaded.diagnostics)};
}

} // namespace haptel::tools
