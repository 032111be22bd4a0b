// The options of haptel render, and its scene made ready to be stroked.
#pragma once

#include "device/sound_file.h"
#include "tools/explore/explore_textures.h"
#include "tools/sound/channels.h"
#include "tools/sound/stroke_force.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace haptel::tools {

struct RenderOptions {
    std::string scene, device; // device: in place of the scene's first; empty: that
    std::string out;           // file; empty: it is played
    std::string play;          // where, as ALSA names it
    std::vector<sound::Component> channels = {sound::Component::along};
    device::SoundFormat format = device::SoundFormat::pcm16;
    std::optional<double> seconds, full_scale_n;
    double high_pass_hz = 20; // 0: off
    bool json = false;

    int channel_count() const { return static_cast<int>(channels.size()); }
};

struct RenderScene {
    std::shared_ptr<const runtime::Scene> scene;
    std::unique_ptr<sound::StrokeForce> stroke; // null: `diagnostics` say why
    std::string diagnostics;                    // ready to print
};

// At the rate of sound: textures have all the detail that can be heard, and nothing has to be resampled. A simulated
// device knows the positions exactly, since a sound is computed and not measured: its steps would rattle.
RenderScene load_to_render(const RenderOptions& options, ExploreTextures& textures, runtime::SurfaceCache& surfaces);

} // namespace haptel::tools
