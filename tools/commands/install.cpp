// haptel install: a library from an archive or a folder, put where imports find it.
#include "libraries/package/install.h"
#include "libraries/lock.h"
#include "libraries/package/archive.h"
#include "tools/commands/command.h"
#include "tools/library/library_place.h"
#include "tools/output/json.h"
#include "tools/output/terminal.h"

#include <filesystem>
#include <fmt/format.h>
#include <memory>

namespace haptel::tools {

namespace fs = std::filesystem;

namespace {

struct InstallOptions {
    std::string what;
    PlaceOptions place;
    bool json = false;
};

struct Installing {
    std::optional<libraries::Package> package;
    libraries::Installation done;
    std::string messages;
};

Installing install(const InstallOptions& options, const LibraryPlace& place)
{
    Installing made;
    std::error_code fault;
    libraries::PackageResult read = fs::is_directory(options.what, fault) ? libraries::read_folder(options.what)
                                                                          : libraries::read_archive_file(options.what);
    made.messages = read.messages;
    if (!read.package) return made;
    made.package = std::move(read.package);
    const auto refused = [&](const std::string& why) {
        made.messages = options.what + ": error: " + why + "\n";
        return made;
    };
    if (place.folder.empty()) return refused(no_place);
    std::string missing = missing_dependency(made.package->manifest, libraries::search_path(place.project));
    if (!missing.empty()) return refused(missing);
    const std::string unreadable =
        place.is_project ? libraries::read_lock_file(place.project / libraries::lock_name).fault : "";
    if (!unreadable.empty()) return refused(unreadable);
    made.done = libraries::install(*made.package, place.folder);
    if (made.done.folder.empty()) return refused(made.done.why);
    if (place.is_project)
        if (const std::string why = libraries::lock(place.project, *made.package); !why.empty()) return refused(why);
    return made;
}

ExitCode run(const InstallOptions& options)
{
    const Installing made = install(options, library_place(options.place));
    fmt::print(stderr, "{}", made.messages);
    const bool is_done = made.messages.empty();
    if (options.json) {
        const auto of_package = [&](auto value) {
            return made.package ? Json(value(made.package->manifest)) : Json(nullptr);
        };
        print_json({{"name", of_package([](const auto& manifest) { return manifest.name; })},
                    {"version", of_package([](const auto& manifest) { return to_text(manifest.version); })},
                    {"folder", is_done ? Json(made.done.folder.string()) : Json(nullptr)},
                    {"was_there", made.done.was_there},
                    {"problems", lines_of(made.messages)}});
    } else if (is_done) {
        fmt::print("{}\n", made.done.folder.string());
        const libraries::Manifest& manifest = made.package->manifest;
        fmt::print(stderr, "haptel: {} {}: import {}.{};\n", to_text(manifest),
                   made.done.was_there ? "is there already" : "is installed", manifest.name,
                   manifest.textures.front().file.substr(0, manifest.textures.front().file.find('/')));
    }
    return is_done ? ExitCode::fine : ExitCode::findings;
}

} // namespace

Command install_command(CLI::App& app)
{
    const auto options = std::make_shared<InstallOptions>();
    CLI::App* command = app.add_subcommand("install", "Install a texture library, for you or for one project");
    command->add_option("what", options->what, "What haptel pack made, or a folder with a library.toml")
        ->required()
        ->type_name("FILE|DIR");
    add_place(*command, options->place);
    command->add_flag("--json", options->json, "One JSON object on standard output");
    set_examples(*command, "  haptel install wood-1.2.0.haptlib\n"
                           "  haptel install wood-1.2.0.haptlib --project");
    return {command, [options] { return run(*options); }};
}

} // namespace haptel::tools
