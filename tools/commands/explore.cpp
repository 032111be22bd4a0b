// haptel explore: the main job. A scene, a device, textures that follow their files, and the servo between them.
#include "tools/commands/explore.h"

#include "device/device_factory.h"
#include "runtime/files/scene_file.h"
#include "runtime/servo/allocation_count.h"
#include "tools/arguments/quantity.h"
#include "tools/commands/command.h"
#include "tools/explore/explore_control.h"
#include "tools/explore/explore_hands.h"
#include "tools/explore/explore_scene.h"
#include "tools/explore/explore_status.h"
#include "tools/explore/explore_textures.h"
#include "tools/output/interrupt.h"
#include "tools/output/terminal.h"
#include "tools/replay/traced_files.h"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstddef>
#include <filesystem>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <memory>
#include <optional>
#include <thread>
#include <vector>

namespace haptel::tools {

namespace {

// What is recorded goes to the file from the loop that pauses so, every few milliseconds.
constexpr std::chrono::milliseconds pause{2};

std::optional<runtime::LoadedScene> load(const ExploreOptions& options, ExploreTextures& textures,
                                         runtime::SurfaceCache& surfaces)
{
    const auto devices = [&, hand = std::size_t{0}](runtime::DeviceRequest request) mutable {
        const bool replaced = hand < options.devices.size();
        if (replaced) request.name = options.devices[hand];
        ++hand;
        runtime::DeviceResult opened = device::open_device(request);
        if (replaced && !opened.device)
            opened.error = fmt::format("`--device {}` in its place: {}", request.name, opened.error);
        return opened;
    };
    Steps steps;
    const runtime::Loading loading{[&](std::string_view doing) { steps.show(doing); }};
    runtime::LoadedScene loaded = runtime::load_scene(options.scene, textures.resolver(), devices, &surfaces, loading);
    fmt::print(stderr, "{}", loaded.diagnostics);
    if (!loaded.scene || loaded.hands.empty()) return std::nullopt;
    if (options.devices.size() > loaded.hands.size()) {
        say_error(
            fmt::format("--device is given {} times, but the scene has {}: it takes the place of the scene's, in "
                        "their order",
                        options.devices.size(),
                        loaded.hands.size() == 1 ? "one device" : fmt::format("{} devices", loaded.hands.size())));
        return std::nullopt;
    }
    return loaded;
}

runtime::ServoOptions servo_options(const ExploreOptions& options)
{
    runtime::ServoOptions servo;
    const bool wall = options.clock == "wall";
    servo.clock = wall ? runtime::ServoClock::wall : runtime::ServoClock::virtual_time;
    servo.seconds = options.seconds.value_or(servo.seconds);
    servo.core = options.core;
    servo.wait_for_reader = !wall;
    servo.allocation_count = runtime::allocations_of_this_thread;
    return servo;
}

std::string recorded_line(const std::string& recording)
{
    return recording.empty() ? "" : fmt::format("recorded     haptel replay {}\n", recording);
}

// The files are hashed as they are now, moments after they were read.
ExploreKept kept_of(const ExploreOptions& options, const runtime::LoadedScene& loaded)
{
    ExploreKept kept{options.out, options.recording, {}};
    if (options.recording.empty()) return kept;
    kept.origin.haptel = HAPTEL_VERSION;
    kept.origin.rate_hz = loaded.scene->servo.rate_hz;
    kept.origin.clock = options.clock;
    kept.origin.files = traced_files(options.recording, options.scene, loaded);
    return kept;
}

} // namespace

ExitCode explore(const ExploreOptions& options)
{
    ExploreTextures textures;
    runtime::SurfaceCache surfaces;
    std::optional<runtime::LoadedScene> read = load(options, textures, surfaces);
    if (!read) return ExitCode::findings;
    listen_for_interrupts(); // until here nothing is felt yet, and nothing half written
    runtime::LoadedScene& loaded = *read;
    textures.watch(*loaded.scene);
    ExploreKept kept = kept_of(options, loaded);
    ExploreHands hands(std::move(loaded.scene), std::move(loaded.hands), servo_options(options), std::move(kept));
    if (!hands.error().empty()) {
        say_error(hands.error());
        return ExitCode::findings;
    }

    ExploreStatus status(stderr_is_terminal());
    std::optional<ExploreScene> scene(std::in_place, options.scene, std::move(loaded.meshes), std::move(loaded.probes),
                                      surfaces, textures, hands);
    std::optional<ExploreControl> control; // until the hands have told how it ended
    if (options.osc_port) {
        control.emplace(*options.osc_port, hands, textures, *scene);
        if (!control->error().empty()) {
            say_error(control->error());
            return ExitCode::findings;
        }
        status.say(control->greeting());
    }
    hands.start();
    while (hands.running()) {
        if (interrupted() || hands.is_recording_lost()) hands.request_stop();
        if (const std::string messages = scene->take_messages() + textures.take_messages() + hands.take_messages();
            !messages.empty()) {
            status.say(messages);
            if (control) control->tell(messages);
        }
        const bool is_quiet = !hands.drain(status);
        if (control)
            control->serve(is_quiet ? pause : std::chrono::milliseconds(0));
        else if (is_quiet)
            std::this_thread::sleep_for(pause);
    }
    const std::string last_messages = scene->take_messages();
    scene.reset();
    status.say(last_messages);
    ExploreOutcome outcome;
    outcome.scene = std::filesystem::path(options.scene).filename().string();
    outcome.clock = options.clock;
    outcome.hands = hands.wait(status);
    if (control) control->end(outcome.hands.front().servo.stop_reason);
    control.reset();
    status.say(textures.take_messages());
    outcome.textures_compiled = textures.compiled();

    hands.finish(outcome);
    if (!hands.error().empty()) say_error(hands.error());
    if (options.json)
        print_json(to_json(outcome));
    else
        fmt::print("{}", to_lines(outcome) + recorded_line(options.recording));
    const bool faulted = std::any_of(outcome.hands.begin(), outcome.hands.end(), [](const HandOutcome& hand) {
        return hand.servo.state == runtime::ServoState::faulted;
    });
    return faulted || !hands.error().empty() ? ExitCode::findings : ExitCode::fine;
}

void add_exploring(CLI::App& command, ExploreOptions& options)
{
    command.add_option("scene", options.scene, "Scene file (TOML)")->required()->type_name("SCENE.toml");
    add_number(command, "--seconds", options.seconds, "Ends after this time; without it, Ctrl-C does",
               NumberRange::positive)
        ->type_name("N");
    command
        .add_option("--device", options.devices,
                    fmt::format("Device in place of the scene's; repeat for several: {}",
                                fmt::join(device::device_names(), ", ")))
        ->type_name("TEXT")
        ->allow_extra_args(false);
    command.add_option("--clock", options.clock, "virtual: as fast as possible, the same forces on every run")
        ->check(CLI::IsMember({"wall", "virtual"}))
        ->capture_default_str();
    command.add_option("--core", options.core, "Processor for the servo alone to stay on, from 0")
        ->type_name("N")
        ->check(CLI::NonNegativeNumber);
    command
        .add_option_function<std::string>(
            "--osc",
            [&port = options.osc_port](const std::string& text) {
                uint16_t number = 0;
                const auto [end, failed] = std::from_chars(text.data(), text.data() + text.size(), number);
                if (failed != std::errc() || end != text.data() + text.size())
                    throw CLI::ValidationError(
                        fmt::format("expected a port from 1 to 65535, or 0 for any free one, found '{}'", text));
                port = number;
            },
            "Port of 127.0.0.1 and ::1 for Open Sound Control: other programs of this machine set parameters "
            "while it runs (docs/control.md); 0: any free one")
        ->type_name("PORT");
    command.add_flag("--json", options.json, "Report as JSON on standard output");
}

Command explore_command(CLI::App& app)
{
    const auto options = std::make_shared<ExploreOptions>();
    CLI::App* command = app.add_subcommand("explore", "Explore a scene with a device; textures follow their files");
    add_exploring(*command, *options);
    command
        ->add_option("--out", options->out,
                     "Folder for trace.csv (trace_2.csv ... of further devices), report.json and pictures")
        ->type_name("DIR");
    command->add_option("--record", options->recording, "Recording for `haptel replay`; see `haptel help record`")
        ->type_name("FILE.haptrace");
    set_examples(*command, "  haptel explore examples/scenes/rock.toml\n"
                           "  haptel explore scene.toml --seconds 10 --out run --json\n"
                           "  haptel explore scene.toml --device replay:run.haptrace --clock virtual");
    return {command, [options] { return explore(*options); }};
}

} // namespace haptel::tools
