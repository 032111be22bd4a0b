// haptel render: the force along a stroke as a sound, for voice coils.
#include "runtime/files/quantity.h"
#include "tools/arguments/quantity.h"
#include "tools/commands/command.h"
#include "tools/output/replace_file.h"
#include "tools/output/terminal.h"
#include "tools/sound/render_play.h"

#include <array>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <utility>

namespace haptel::tools {

namespace {

constexpr double file_seconds = 5, file_seconds_max = 600; // what is kept until its peak is known: at most 460 MB
constexpr double rehearsal_s = 5;                          // of what is played, for its scale

constexpr std::array<std::pair<std::string_view, device::SoundFormat>, 3> formats = {
    {{"16", device::SoundFormat::pcm16}, {"24", device::SoundFormat::pcm24}, {"float", device::SoundFormat::float32}}};

std::string_view format_name(device::SoundFormat format)
{
    return formats[static_cast<std::size_t>(format)].first;
}

// Frames in newtons, of so much of a stroke.
std::vector<float> frames_of(const RenderOptions& options, sound::StrokeForce& stroke, double seconds)
{
    const auto channels = static_cast<std::size_t>(options.channel_count());
    const auto count = static_cast<std::size_t>(std::round(seconds * device::sound_rate_hz));
    sound::Mixer mixer(options.channels, options.high_pass_hz, device::sound_rate_hz);
    std::vector<float> frames(channels * count);
    Progress progress;
    std::size_t made = 0;
    for (sound::Stroked stroked; made < count && stroke.next(stroked); ++made) {
        mixer.frame(stroked, std::span(frames).subspan(channels * made, channels));
        if (made % 4800 == 0) progress.show(static_cast<double>(made) / static_cast<double>(count));
    }
    frames.resize(channels * made);
    return frames;
}

// For people who find the file later.
std::string comment_of(const RenderOutcome& outcome)
{
    return fmt::format("haptel: full scale is {:.9g} N; channels: {}; high-pass {:g} Hz", outcome.full_scale_n,
                       fmt::join(outcome.components, ", "), outcome.high_pass_hz);
}

// Returns why it could not be written; empty: it is.
std::string write_stroke(const RenderOptions& options, RenderScene& scene, RenderOutcome& outcome)
{
    std::vector<float> frames = frames_of(options, *scene.stroke, options.seconds.value_or(file_seconds));
    if (!scene.stroke->error().empty()) return scene.stroke->error();
    outcome.frames = frames.size() / options.channels.size();
    outcome.level.add(frames);
    outcome.full_scale_n = options.full_scale_n.value_or(sound::full_scale_n(outcome.level.peak_n()));
    outcome.clipped = sound::to_full_scale(frames, outcome.full_scale_n);
    const device::SoundBytes sound =
        device::wav_bytes(frames, options.channel_count(), options.format, comment_of(outcome));
    const std::string why = sound.error.empty() ? write_file(options.out, sound.bytes) : sound.error;
    return why.empty() ? "" : fmt::format("cannot write the sound '{}': {}", options.out, why);
}

ExitCode make_sound(const RenderOptions& options)
{
    const bool is_played = options.out.empty();
    if (!is_played)
        if (const std::string why = why_not_written(options.out); !why.empty()) {
            say_error(fmt::format("cannot write the sound '{}': {}", options.out, why));
            return ExitCode::findings;
        }
    ExploreTextures textures;
    runtime::SurfaceCache surfaces;
    RenderScene scene = load_to_render(options, textures, surfaces);
    fmt::print(stderr, "{}", scene.diagnostics);
    if (!scene.stroke) return ExitCode::findings;

    RenderOutcome outcome;
    outcome.to = is_played ? options.play : options.out;
    outcome.format = is_played ? "" : format_name(options.format);
    for (const sound::Component component : options.channels)
        outcome.components.emplace_back(sound::name_of(component));
    outcome.rate_hz = device::sound_rate_hz;
    outcome.high_pass_hz = options.high_pass_hz;
    std::string error;
    if (!is_played) {
        error = write_stroke(options, scene, outcome);
    } else {
        if (options.full_scale_n) {
            outcome.full_scale_n = *options.full_scale_n;
        } else { // a rehearsal, and then the same from its beginning
            sound::Level level;
            level.add(frames_of(options, *scene.stroke, std::min(options.seconds.value_or(rehearsal_s), rehearsal_s)));
            outcome.full_scale_n = sound::full_scale_n(level.peak_n());
            scene = load_to_render(options, textures, surfaces);
            if (!scene.stroke) { // a file has changed meanwhile
                fmt::print(stderr, "{}", scene.diagnostics);
                return ExitCode::findings;
            }
        }
        error = play_stroke(options, scene, textures, outcome);
    }
    outcome.contact_ticks = scene.stroke->contact_ticks();
    outcome.faults = scene.stroke->faults();
    if (!error.empty()) {
        say_error(error);
        return ExitCode::findings;
    }
    if (outcome.level.peak_n() == 0)
        say_warning(outcome.contact_ticks == 0
                        ? "the hand touched nothing, and the sound is silent: does it last longer "
                          "than the 0.5 s in which a simulated hand comes down?"
                        : "the sound is silent: the force has no part of what was asked for");
    if (outcome.clipped > 0)
        say_warning(fmt::format("{} samples are beyond full scale and cut off: give --full-scale {:.3g}N or more",
                                outcome.clipped, outcome.level.peak_n()));
    if (options.json)
        print_json(to_json(outcome));
    else
        fmt::print("{}", to_lines(outcome));
    return ExitCode::fine;
}

double quantity_of(const char* option, const std::string& text, runtime::Quantity quantity, double minimum,
                   double maximum, const std::string& expected)
{
    const std::optional<double> value = runtime::parse_quantity(text, quantity);
    if (!value || !(*value >= minimum && *value <= maximum))
        throw CLI::ValidationError(option, fmt::format("expected {}, found '{}'", expected, text));
    return *value;
}

void add_sound_options(CLI::App& command, const std::shared_ptr<RenderOptions>& options)
{
    command
        .add_option_function<std::string>(
            "--channels",
            [options](const std::string& text) {
                const sound::Channels channels = sound::parse_channels(text);
                if (!channels.error.empty()) throw CLI::ValidationError("--channels", channels.error);
                options->channels = channels.components;
            },
            fmt::format("What of the force goes to each channel, 1 to {}: {} [along]\n"
                        "  along: where the hand moves to on the surface; normal: out of the surface",
                        device::sound_channels_max, sound::component_names))
        ->type_name("PART,PART...");
    command
        .add_option_function<std::string>(
            "--full-scale",
            [options](const std::string& text) {
                options->full_scale_n = quantity_of("--full-scale", text, runtime::Quantity::force, 1e-9, 1000,
                                                    "a force from 1e-9 N to 1000 N, such as 2N or 500mN");
            },
            "Force that is the loudest sample [1 dB above the peak; played: above that of the first 5 s]")
        ->type_name("FORCE");
    command
        .add_option_function<std::string>(
            "--high-pass",
            [options](const std::string& text) {
                options->high_pass_hz =
                    text == "off" || text == "0"
                        ? 0
                        : quantity_of("--high-pass", text, runtime::Quantity::frequency, 0.1, 10'000,
                                      "`off`, or a frequency from 0.1 Hz to 10000 Hz, such as 20Hz");
            },
            "Takes away what is slower, constant forces above all; or off [20Hz]")
        ->type_name("FREQUENCY");
    command
        .add_option_function<std::string>(
            "--format",
            [options](const std::string& text) {
                for (const auto& [name, format] : formats)
                    if (name == text) options->format = format;
            },
            "Samples of the file: 16 or 24 bit, or float [16]")
        ->check(CLI::IsMember({"16", "24", "float"}))
        ->type_name("TEXT");
}

} // namespace

Command render_command(CLI::App& app)
{
    const auto options = std::make_shared<RenderOptions>();
    CLI::App* command = app.add_subcommand("render", "The force along a stroke as a sound, for voice coils");
    command->add_option("scene", options->scene, "Scene file (TOML)")->required()->type_name("SCENE.toml");
    CLI::Option* out =
        command->add_option("--out", options->out, "Sound file to write")
            ->type_name("X.wav")
            ->check([](const std::string& file) {
                return file.ends_with(".wav") ? "" : fmt::format("the sound is a WAV file: name it '{}.wav'", file);
            });
    CLI::Option* play =
        command->add_option("--play", options->play, "Plays it instead, on this sound device of ALSA [default]")
            ->type_name("NAME")
            ->expected(0, 1)
            ->default_str("default")
            ->excludes(out);
    command
        ->add_option_function<std::string>(
            "--seconds",
            [options](const std::string& text) {
                const Parsed<double> number = parse_number(text);
                if (!number) throw CLI::ValidationError("--seconds", number.error);
                if (!(number.value * device::sound_rate_hz >= 1))
                    throw CLI::ValidationError("--seconds", fmt::format("'{}' seconds is no time", text));
                options->seconds = number.value;
            },
            fmt::format("How much of the stroke [{:g}; played: until Ctrl-C]; of a file at most {:g}", file_seconds,
                        file_seconds_max))
        ->type_name("N");
    add_sound_options(*command, options);
    command->add_option("--device", options->device, "Device in place of the scene's first")->type_name("TEXT");
    command->add_flag("--json", options->json, "Report as JSON on standard output");
    set_examples(*command, "  haptel render scene.toml --out scene.wav\n"
                           "  haptel render scene.toml --out scene.wav --channels x,y,z --full-scale 2N --format 24\n"
                           "  haptel render scene.toml --play plughw:1 --channels none,none,along,along");
    return {command, [options, out, play] {
                if (out->count() == 0 && play->count() == 0) {
                    say_error("say where the sound goes: --out FILE.wav, or --play");
                    return ExitCode::misuse;
                }
                if (out->count() > 0 && options->seconds.value_or(0) > file_seconds_max) {
                    say_error(fmt::format("a sound file lasts at most {:g} s here: give --seconds less, or --play",
                                          file_seconds_max));
                    return ExitCode::misuse;
                }
                if (options->play.empty()) options->play = "default";
                return make_sound(*options);
            }};
}

} // namespace haptel::tools
