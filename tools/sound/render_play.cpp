#include "tools/sound/render_play.h"

#include "device/sound_player.h"
#include "tools/output/interrupt.h"
#include "tools/output/terminal.h"

#include <algorithm>
#include <cstddef>
#include <fmt/format.h>
#include <limits>
#include <vector>

namespace haptel::tools {

namespace {

constexpr std::size_t block_frames = 480; // 10 ms: as often is looked whether all should end

// To silence, so that the end is no click.
void fade_out(std::vector<float>& frames, std::size_t channels)
{
    const std::size_t count = frames.size() / channels;
    for (std::size_t i = 0; i < frames.size(); ++i)
        frames[i] *= 1 - static_cast<float>(i / channels + 1) / static_cast<float>(count);
}

} // namespace

std::string play_stroke(const RenderOptions& options, RenderScene& scene, ExploreTextures& textures,
                        RenderOutcome& rendered)
{
    device::SoundPlayer player;
    if (std::string error = player.open(options.play, options.channel_count()); !error.empty()) return error;
    textures.watch(*scene.scene);
    listen_for_interrupts();

    const auto channels = static_cast<std::size_t>(options.channel_count());
    const double seconds = options.seconds.value_or(std::numeric_limits<double>::infinity());
    const double frames_wanted = std::round(seconds * device::sound_rate_hz);
    sound::Mixer mixer(options.channels, options.high_pass_hz, device::sound_rate_hz);
    std::string error;
    bool is_over = false;
    while (error.empty() && !is_over && static_cast<double>(rendered.frames) < frames_wanted) {
        const double left = frames_wanted - static_cast<double>(rendered.frames);
        std::vector<float> block(channels * static_cast<std::size_t>(std::min(left, double(block_frames))));
        std::size_t made = 0;
        for (sound::Stroked stroked; made < block.size() && scene.stroke->next(stroked); made += channels)
            mixer.frame(stroked, std::span(block).subspan(made, channels));
        is_over = made < block.size() || interrupted();
        block.resize(made);
        rendered.level.add(block);
        rendered.clipped += sound::to_full_scale(block, rendered.full_scale_n);
        if (interrupted()) fade_out(block, channels);
        error = player.write(block);
        rendered.frames += made / channels;
        fmt::print(stderr, "{}", textures.take_messages());
    }
    if (error.empty()) player.finish();
    rendered.underruns = player.underruns();
    return error.empty() ? scene.stroke->error() : error;
}

} // namespace haptel::tools
