// haptel list: the texture libraries that an import here would find.
#include "libraries/manifest.h"
#include "libraries/places.h"
#include "tools/commands/command.h"
#include "tools/output/json.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <memory>
#include <optional>

namespace haptel::tools {

namespace {

struct Listed {
    libraries::Installed library;
    std::optional<libraries::Manifest> manifest;
    std::string fault; // why there is none
};

Listed look_at(const libraries::Installed& library)
{
    libraries::ManifestFile read = libraries::read_manifest_file(library.folder / libraries::manifest_name);
    Listed listed{library, std::move(read.manifest), std::move(read.fault)};
    if (listed.manifest) listed.fault = why_too_new(*listed.manifest);
    return listed;
}

std::vector<std::string> textures_of(const libraries::Manifest& manifest)
{
    std::vector<std::string> names;
    for (const libraries::TextureName& texture : manifest.textures) {
        std::string file = manifest.name + "." + texture.file;
        for (char& c : file)
            if (c == '/') c = '.';
        names.push_back(file + ":" + texture.texture);
    }
    return names;
}

Json to_json(const Listed& listed)
{
    const auto of_manifest = [&](auto value) {
        return listed.manifest ? Json(value(*listed.manifest)) : Json(nullptr);
    };
    using libraries::Manifest;
    return {{"name", listed.library.name},
            {"version", to_text(listed.library.version)},
            {"tagline", of_manifest([](const Manifest& manifest) { return manifest.tagline; })},
            {"license", of_manifest([](const Manifest& manifest) { return manifest.license; })},
            {"authors", of_manifest([](const Manifest& manifest) { return manifest.authors; })},
            {"tags", of_manifest([](const Manifest& manifest) { return manifest.tags; })},
            {"textures", of_manifest(textures_of)},
            {"place", listed.library.place},
            {"folder", listed.library.folder.string()},
            {"problem", listed.fault.empty() ? Json(nullptr) : Json(listed.fault)}};
}

ExitCode run(bool json)
{
    std::error_code fault;
    const std::vector<libraries::Place> places = libraries::search_path(std::filesystem::current_path(fault));
    std::vector<Listed> all;
    for (const libraries::Installed& library : installed_in(places)) all.push_back(look_at(library));
    if (json) {
        Json list = Json::array(), searched = Json::array();
        for (const Listed& listed : all) list.push_back(to_json(listed));
        for (const libraries::Place& place : places) searched.push_back(place.folder.string());
        print_json({{"libraries", std::move(list)}, {"searched", std::move(searched)}});
        return ExitCode::fine;
    }
    for (const auto& [library, manifest, problem] : all) {
        fmt::print("{} {}  {}\n  in {} ({})\n", library.name, to_text(library.version),
                   manifest ? manifest->tagline : "", library.folder.string(), library.place);
        if (manifest) fmt::print("  {}\n", fmt::join(textures_of(*manifest), ", "));
        if (!problem.empty()) fmt::print("  cannot be used: {}\n", problem);
    }
    if (all.empty()) fmt::print(stderr, "haptel: no library is installed: haptel install FILE.haptlib\n");
    return ExitCode::fine;
}

} // namespace

Command list_command(CLI::App& app)
{
    const auto json = std::make_shared<bool>(false);
    CLI::App* command = app.add_subcommand("list", "List the texture libraries that an import in this folder finds");
    command->add_flag("--json", *json, "One JSON object on standard output");
    set_examples(*command, "  haptel list\n"
                           "  haptel list --json");
    return {command, [json] { return run(*json); }};
}

} // namespace haptel::tools
