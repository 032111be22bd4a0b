// haptel explore: the main job. A scene, a device, textures that follow their files, and the servo between them.
#include "device/device_factory.h"
#include "runtime/allocation_count.h"
#include "runtime/files/scene_file.h"
#include "runtime/servo_thread.h"
#include "tools/command.h"
#include "tools/explore_files.h"
#include "tools/explore_report.h"
#include "tools/explore_status.h"
#include "tools/explore_textures.h"
#include "tools/quantity.h"
#include "tools/terminal.h"

#include <chrono>
#include <csignal>
#include <cstddef>
#include <filesystem>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <limits>
#include <memory>
#include <optional>
#include <thread>

namespace haptel::tools {

namespace {

struct ExploreOptions {
    std::string scene, device, out;
    std::string clock = "wall";
    double seconds = std::numeric_limits<double>::infinity();
    bool json = false;
};

volatile std::sig_atomic_t interrupted = 0;

// The first Ctrl-C, or the terminal's end, asks for a clean end; the second one gets what it always gets.
extern "C" void on_interrupt(int signal)
{
    interrupted = 1;
    std::signal(signal, SIG_DFL);
}

// A scene ready to run, and what the pictures and the report want to know of it.
struct Exploration {
    std::shared_ptr<const runtime::Scene> scene;
    runtime::LoadedHand hand;
    plot::SurfaceBelow surface;
};

// The scene's device, or another one in its place.
runtime::DeviceResult open_device(runtime::DeviceRequest request, const std::string& instead)
{
    if (!instead.empty()) request.name = instead;
    return device::open_device(request);
}

std::optional<Exploration> load(const ExploreOptions& options, ExploreTextures& textures)
{
    Exploration exploration;
    const auto devices = [&](const runtime::DeviceRequest& request) {
        exploration.surface = request.surface_below;
        return open_device(request, options.device);
    };
    runtime::LoadedScene loaded = runtime::load_scene(options.scene, textures.resolver(), devices);
    fmt::print(stderr, "{}", loaded.diagnostics);
    if (!loaded.scene || loaded.hands.empty()) return std::nullopt;
    exploration.scene = std::move(loaded.scene);
    exploration.hand = std::move(loaded.hands.front());
    return exploration;
}

runtime::ServoOptions servo_options(const ExploreOptions& options, const runtime::HandSettings& hand)
{
    runtime::ServoOptions servo;
    servo.hand = hand;
    const bool wall = options.clock == "wall";
    servo.clock = wall ? runtime::ServoClock::wall : runtime::ServoClock::virtual_time;
    servo.seconds = options.seconds;
    servo.wait_for_reader = !wall;
    servo.allocation_count = runtime::allocations_of_this_thread;
    return servo;
}

ExitCode explore(const ExploreOptions& options)
{
    interrupted = 0;
    std::signal(SIGINT, on_interrupt);
    std::signal(SIGTERM, on_interrupt);
    if (std::signal(SIGHUP, on_interrupt) == SIG_IGN) std::signal(SIGHUP, SIG_IGN); // nohup: the terminal may go

    ExploreTextures textures;
    std::optional<Exploration> exploration = load(options, textures);
    if (!exploration) return ExitCode::findings;
    std::optional<ExploreFiles> files;
    if (!options.out.empty()) {
        files.emplace(options.out);
        if (!files->error().empty()) {
            say_error(files->error());
            return ExitCode::findings;
        }
    }

    ExploreOutcome outcome;
    outcome.scene = std::filesystem::path(options.scene).filename().string();
    outcome.device = exploration->hand.device->info().name;
    outcome.clock = options.clock;

    ExploreStatus status(stderr_is_terminal());
    textures.watch(*exploration->scene);
    runtime::ServoThread servo(exploration->scene, std::move(exploration->hand.device),
                               servo_options(options, exploration->hand.settings));
    // At most one ring: a servo that is faster than its reader must not keep it from hearing Ctrl-C.
    const auto drain = [&] {
        runtime::TickRecord record;
        bool any = false;
        for (std::size_t left = servo.telemetry().capacity(); left > 0 && servo.telemetry().pop(record); --left) {
            any = true;
            if (files) files->add(record);
        }
        if (any) status.show(record);
        return any;
    };

    servo.start();
    while (servo.running()) {
        if (interrupted) servo.request_stop();
        if (const std::string messages = textures.take_messages(); !messages.empty()) status.say(messages);
        if (!drain()) std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    outcome.servo = servo.wait();
    drain();
    status.say(textures.take_messages());
    outcome.textures_compiled = textures.compiled();

    if (files) {
        files->finish(outcome, exploration->scene->servo.force_limit_n, exploration->surface);
        if (!files->error().empty()) say_error(files->error());
    }
    if (options.json)
        print_json(to_json(outcome));
    else
        fmt::print("{}", to_lines(outcome));
    const bool well = outcome.servo.state != runtime::ServoState::faulted && (!files || files->error().empty());
    return well ? ExitCode::fine : ExitCode::findings;
}

void add_seconds(CLI::App& command, double& seconds)
{
    command
        .add_option_function<std::string>(
            "--seconds",
            [&seconds](const std::string& text) {
                const Parsed<double> number = parse_number(text);
                if (!number) throw CLI::ValidationError(number.error);
                if (!(number.value > 0)) throw CLI::ValidationError(fmt::format("'{}' seconds is no time", text));
                seconds = number.value;
            },
            "Ends after this time; without it, Ctrl-C does")
        ->type_name("N");
}

} // namespace

Command explore_command(CLI::App& app)
{
    const auto options = std::make_shared<ExploreOptions>();
    CLI::App* command =
        app.add_subcommand("explore", "Feel a scene: servo, device and textures that follow their files");
    command->add_option("scene", options->scene, "Scene file (TOML)")->required()->type_name("SCENE.toml");
    add_seconds(*command, options->seconds);
    command->add_option("--device", options->device,
                        fmt::format("Instead of the scene's: {}", fmt::join(device::device_names(), ", ")));
    command->add_option("--clock", options->clock, "virtual: as fast as possible, the same forces on every run")
        ->check(CLI::IsMember({"wall", "virtual"}))
        ->capture_default_str();
    command->add_option("--out", options->out, "Folder for trace.csv, report.json and pictures")->type_name("DIR");
    command->add_flag("--json", options->json, "Report as JSON on standard output");
    set_examples(*command, "  haptel explore examples/scenes/rock.toml\n"
                           "  haptel explore scene.toml --seconds 10 --out run --json\n"
                           "  haptel explore scene.toml --device replay:run/trace.csv --clock virtual");
    return {command, [options] { return explore(*options); }};
}

} // namespace haptel::tools
