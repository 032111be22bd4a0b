#include "tools/library/info_library.h"

#include "jit/texture/source_file.h"
#include "lang/syntax/parser.h"
#include "libraries/package/archive.h"
#include "libraries/package/package.h"
#include "tools/library/library_place.h"
#include "tools/output/json.h"
#include "tools/output/terminal.h"

#include <filesystem>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <optional>
#include <vector>

namespace haptel::tools {

namespace {

namespace fs = std::filesystem;

// What is read of a library, or messages.
struct LibraryText {
    std::optional<libraries::Manifest> manifest;
    libraries::Contents contents; // the files of its textures at least
    std::string fault;
};

LibraryText read_library_text(const std::string& what)
{
    const fs::path folder = library_named(what);
    if (folder.empty()) {
        libraries::PackageResult archive = libraries::read_archive_file(what);
        if (!archive.package) return {{}, {}, std::move(archive.messages)};
        return {std::move(archive.package->manifest), std::move(archive.package->contents), {}};
    }
    libraries::ManifestFile written = libraries::read_manifest_file(folder / libraries::manifest_name);
    LibraryText shown{std::move(written.manifest), {}, std::move(written.fault)};
    if (!shown.manifest) return shown;
    for (const libraries::TextureName& texture : shown.manifest->textures) {
        const std::string path = texture.file + ".haptel";
        if (!shown.contents.contains(path)) shown.contents[path] = jit::read_source((folder / path).string()).text;
    }
    return shown;
}

// The first line of the doc comment of a texture or preset, as the library's file has it.
std::string tagline_of(const libraries::Contents& contents, const libraries::TextureName& texture)
{
    const auto text = contents.find(texture.file + ".haptel");
    if (text == contents.end()) return {};
    lang::SourceSet sources;
    lang::Diagnostics ignored; // `haptel check` tells
    const lang::ast::File tree = lang::parse(sources, sources.add({text->first, text->second}), ignored);
    const auto in = [&](const auto& all) -> std::string {
        for (const auto& one : all)
            if (one.name.text == texture.texture) return one.doc.substr(0, one.doc.find('\n'));
        return {};
    };
    const std::string tagline = in(tree.textures);
    return tagline.empty() ? in(tree.presets) : tagline;
}

} // namespace

bool names_library(const std::string& what)
{
    return what.ends_with(".haptlib") || !library_named(what).empty();
}

ExitCode show_library(const std::string& what, bool json)
{
    const LibraryText shown = read_library_text(what);
    if (!shown.manifest) {
        say_error(shown.fault);
        return ExitCode::findings;
    }
    const libraries::Manifest& manifest = *shown.manifest;
    Json textures = Json::array();
    std::string lines;
    for (const libraries::TextureName& texture : manifest.textures) {
        const std::string name = texture.file + ":" + texture.texture, tagline = tagline_of(shown.contents, texture);
        textures.push_back({{"name", name}, {"tagline", tagline}});
        lines += fmt::format("  {:<24} {}\n", name, tagline);
    }
    if (json)
        print_json({{"schema", "haptel-library"},
                    {"schema_version", 1},
                    {"name", manifest.name},
                    {"version", to_text(manifest.version)},
                    {"tagline", manifest.tagline},
                    {"license", manifest.license},
                    {"authors", manifest.authors},
                    {"tags", manifest.tags},
                    {"language", manifest.language_least},
                    {"textures", std::move(textures)}});
    else
        fmt::print("{} {}  {}\n  licence {}, by {}\n{}", manifest.name, to_text(manifest.version), manifest.tagline,
                   manifest.license, fmt::join(manifest.authors, ", "), lines);
    return ExitCode::fine;
}

} // namespace haptel::tools
