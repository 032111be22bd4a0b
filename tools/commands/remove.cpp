// haptel remove: takes an installed library away.
#include "lang/text/near_name.h"
#include "lang/text/source.h"
#include "libraries/manifest.h"
#include "libraries/package/install.h"
#include "tools/commands/command.h"
#include "tools/library/library_place.h"
#include "tools/output/json.h"
#include "tools/output/terminal.h"

#include <algorithm>
#include <fmt/format.h>
#include <memory>

namespace haptel::tools {

namespace {

struct RemoveOptions {
    std::string what;
    PlaceOptions place;
    bool json = false;
};

struct Chosen {
    std::optional<libraries::Installed> library;
    std::string why;
};

// The one that is meant, of those that are there.
Chosen choose(const std::string& name, const std::optional<libraries::Version>& version, const LibraryPlace& place)
{
    const std::vector<libraries::Place> places{{"", place.folder}};
    const std::vector<libraries::Installed> there = installed_in(places, name);
    if (there.empty()) {
        std::vector<std::string> known;
        for (const libraries::Installed& one : installed_in(places)) known.push_back(one.name);
        const std::string_view meant = near_name(name, {known.begin(), known.end()}).name;
        return {{},
                fmt::format("there is no library '{}' in {}: {}", name, place.folder.string(),
                            meant.empty() ? "haptel list shows all" : fmt::format("did you mean '{}'?", meant))};
    }
    std::string versions;
    for (const libraries::Installed& one : there) {
        if (one.version == version) return {one, {}};
        versions += fmt::format("{}{}@{}", versions.empty() ? "" : ", ", name, to_text(one.version));
    }
    if (!version && there.size() == 1) return {there.front(), {}};
    return {{},
            version ? fmt::format("there is no {}@{} in {}: there is {}", name, to_text(*version),
                                  place.folder.string(), versions)
                    : fmt::format("'{}' is there in several versions: name one of {}", name, versions)};
}

ExitCode run(const RemoveOptions& options)
{
    const std::size_t at = options.what.find('@');
    const std::string name = options.what.substr(0, at);
    const std::optional<libraries::Version> version =
        at == options.what.npos ? std::nullopt : libraries::parse_version(options.what.substr(at + 1));
    if (!libraries::is_library_name(name) || (at != options.what.npos && !version)) {
        say_error(fmt::format("expected the name of a library, and perhaps a version, such as wood@1.2.0, found '{}'",
                              lang::printable(options.what)));
        return ExitCode::misuse;
    }
    const LibraryPlace place = library_place(options.place);
    if (place.folder.empty()) {
        say_error(no_place);
        return ExitCode::findings;
    }
    const Chosen chosen = choose(name, version, place);
    std::string why = chosen.why;
    if (why.empty() && place.is_project) why = libraries::unlock(place.project, *chosen.library);
    if (why.empty()) why = libraries::remove(*chosen.library);
    if (!why.empty()) say_error(why);
    if (options.json)
        print_json({{"name", name},
                    {"version", chosen.library ? Json(to_text(chosen.library->version)) : Json(nullptr)},
                    {"folder", chosen.library ? Json(chosen.library->folder.string()) : Json(nullptr)},
                    {"problems", lines_of(why)}});
    else if (why.empty())
        fmt::print("{} {} is gone from {}\n", name, to_text(chosen.library->version), place.folder.string());
    return why.empty() ? ExitCode::fine : ExitCode::findings;
}

} // namespace

Command remove_command(CLI::App& app)
{
    const auto options = std::make_shared<RemoveOptions>();
    CLI::App* command = app.add_subcommand("remove", "Take an installed texture library away");
    command->add_option("what", options->what, "A library, and its version where several are there")
        ->required()
        ->type_name("NAME[@VERSION]");
    add_place(*command, options->place);
    command->add_flag("--json", options->json, "One JSON object on standard output");
    set_examples(*command, "  haptel remove wood\n"
                           "  haptel remove wood@1.2.0 --project");
    return {command, [options] { return run(*options); }};
}

} // namespace haptel::tools
