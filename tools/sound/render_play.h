// haptel render --play: a stroke through a sound card while it is computed.
//
// A voice coil senses no position, so this is no HapticDevice: no hand's pose comes from it, and the stroke does not
// wait for it. The card's clock paces the simulation instead of a servo's, 0.1 s ahead of what is heard; a texture that
// is edited is heard so soon.
#pragma once

#include "tools/sound/render_report.h"
#include "tools/sound/render_scene.h"

namespace haptel::tools {

// Until its time is over or Ctrl-C. `rendered.full_scale_n` is set, the rest is filled in. Returns why it ended early;
// empty: it did not.
std::string play_stroke(const RenderOptions& options, RenderScene& scene, ExploreTextures& textures,
                        RenderOutcome& rendered);

} // namespace haptel::tools
