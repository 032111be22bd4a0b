// haptel pack: a folder with a library.toml as one archive, if all of it is fit to be published.
#include "input/regular_file.h"
#include "libraries/package/archive.h"
#include "libraries/sha256.h"
#include "tools/commands/command.h"
#include "tools/library/gallery.h"
#include "tools/library/inspect_library.h"
#include "tools/output/json.h"
#include "tools/output/replace_file.h"
#include "tools/output/terminal.h"

#include <filesystem>
#include <fmt/format.h>
#include <memory>
#include <utility>

namespace haptel::tools {

namespace {

struct PackOptions {
    std::string folder, out, gallery;
    bool json = false;
};

struct Packed {
    std::string out; // empty: nothing was written
    std::string bytes, messages;
    std::optional<libraries::Package> package;
    LibraryInspection inspection;
};

Packed pack(const PackOptions& options)
{
    Packed made;
    if (const std::string why = options.gallery.empty() ? "" : why_not_written(options.gallery); !why.empty()) {
        made.messages = options.gallery + ": error: it cannot be written: " + why + "\n";
        return made;
    }
    libraries::PackageResult read = libraries::read_folder(options.folder);
    made.messages = read.messages;
    if (!read.package) return made;
    made.package = std::move(read.package);
    libraries::Contents contents = made.package->contents;
    std::erase_if(contents, [](const auto& file) { return file.first.starts_with(previews_folder); });
    Progress progress;
    made.inspection =
        inspect_library(made.package->manifest, contents, options.folder, [&](double share) { progress.show(share); });
    progress.hide();
    for (const std::string& problem : made.inspection.problems) made.messages += problem + "\n";
    if (!made.messages.empty()) return made;
    contents.insert(made.inspection.previews.begin(), made.inspection.previews.end());
    read = libraries::make_package(std::move(contents), options.folder);
    made.messages = read.messages;
    if (!read.package) return made;
    made.package = std::move(read.package);
    libraries::ArchiveResult archive = libraries::write_archive(*made.package);
    const libraries::Manifest& manifest = made.package->manifest;
    const std::string out =
        options.out.empty() ? manifest.name + "-" + to_text(manifest.version) + ".haptlib" : options.out;
    const std::string fault = archive.error.empty() ? write_file(out, archive.bytes) : archive.error;
    if (!fault.empty()) {
        made.messages = out + ": error: it cannot be written: " + fault + "\n";
        return made;
    }
    if (!options.gallery.empty()) made.messages = write_gallery(*made.package, made.inspection, options.gallery);
    if (!made.messages.empty()) return made;
    made.bytes = std::move(archive.bytes);
    made.out = out;
    return made;
}

Json to_json(const Packed& made)
{
    Json textures = Json::array();
    for (const InspectedTexture& texture : made.inspection.textures)
        textures.push_back(
            {{"file", texture.file}, {"name", texture.name}, {"doc", texture.doc}, {"preview", texture.preview}});
    const auto of_package = [&](auto value) { return made.package ? Json(value(*made.package)) : Json(nullptr); };
    const auto of_archive = [&](Json value) { return made.out.empty() ? Json(nullptr) : std::move(value); };
    return {{"name", of_package([](const auto& package) { return package.manifest.name; })},
            {"version", of_package([](const auto& package) { return to_text(package.manifest.version); })},
            {"archive", of_archive(made.out)},
            {"bytes", of_archive(made.bytes.size())},
            {"sha256", of_archive(libraries::sha256(made.bytes))},
            {"textures", std::move(textures)},
            {"problems", lines_of(made.messages)}};
}

ExitCode run(const PackOptions& options)
{
    const Packed made = pack(options);
    fmt::print(stderr, "{}", made.messages);
    if (options.json)
        print_json(to_json(made));
    else if (!made.out.empty())
        fmt::print("{}\n", made.out);
    if (made.out.empty()) {
        if (!options.json) say_error("nothing was packed");
        return ExitCode::findings;
    }
    if (!options.json)
        fmt::print(stderr, "haptel: {}: {} texture{}, {} files, {}\n", to_text(made.package->manifest),
                   made.inspection.textures.size(), made.inspection.textures.size() == 1 ? "" : "s",
                   made.package->contents.size(), input::size_in_words(made.bytes.size()));
    return ExitCode::fine;
}

} // namespace

Command pack_command(CLI::App& app)
{
    const auto options = std::make_shared<PackOptions>();
    CLI::App* command =
        app.add_subcommand("pack", "Check and test a texture library, draw its textures, and make one file of it");
    command->add_option("folder", options->folder, "Folder with a library.toml")->required()->type_name("DIR");
    command->add_option("-o,--out", options->out, "File to write [NAME-VERSION.haptlib]")->type_name("X.haptlib");
    command
        ->add_option("--gallery", options->gallery,
                     "Page to write too, with the picture and the doc comment of each texture; pictures go into a "
                     "folder of its name")
        ->type_name("X.md");
    command->add_flag("--json", options->json, "One JSON object on standard output");
    set_examples(*command, "  haptel pack wood\n"
                           "  haptel pack wood -o wood.haptlib --json\n"
                           "  haptel pack wood --gallery wood.md");
    return {command, [options] { return run(*options); }};
}

} // namespace haptel::tools
