#include "tools/library/gallery.h"

#include "tools/output/replace_file.h"

#include <filesystem>
#include <fmt/format.h>
#include <set>
#include <vector>

namespace haptel::tools {

namespace fs = std::filesystem;

namespace {

std::string window(const libraries::Manifest& manifest, const libraries::TextureName& texture)
{
    double window_m = preview_m;
    for (const libraries::PreviewSize& size : manifest.previews)
        if (size.of == texture) window_m = size.window_m;
    return fmt::format("{:g} mm wide", window_m * 1e3);
}

// The part of a file's path that says the family: "stones" of "stones/granite".
std::string family_of(const std::string& file)
{
    const std::size_t slash = file.rfind('/');
    return slash == std::string::npos ? "" : file.substr(0, slash);
}

} // namespace

std::string gallery_page(const libraries::Manifest& manifest, const LibraryInspection& inspection,
                         const std::string& read_me, const std::string& pictures)
{
    std::string page = read_me.empty() ? fmt::format("# {}\n\n{}.\n", manifest.name, manifest.tagline) : read_me;
    page +=
        fmt::format("\nThese are the textures of version {}, under the licence {}. `haptel pack --gallery` makes this "
                    "page of their doc comments.\n",
                    to_text(manifest.version), manifest.license);
    std::string family;
    for (const InspectedTexture& texture : inspection.textures) {
        const libraries::TextureName name{texture.file.substr(0, texture.file.rfind('.')), texture.name};
        if (family_of(name.file) != family) {
            family = family_of(name.file);
            page += fmt::format("\n## {}\n", family);
        }
        page +=
            fmt::format("\n### {0}\n\n![{1}]({2}/{1}.png)\n\n`{3}`, {4}\n\n{5}\n", name.texture,
                        name.file + "/" + name.texture, pictures, texture.called, window(manifest, name), texture.doc);
    }
    return page;
}

std::string write_gallery(const libraries::Package& package, const LibraryInspection& inspection,
                          const std::string& page)
{
    const fs::path at(page);
    const fs::path folder = at.parent_path() / at.stem();
    std::error_code fault;
    std::set<fs::path> drawn;
    for (const auto& [path, bytes] : inspection.previews) {
        const fs::path picture = folder / path.substr(std::string_view(previews_folder).size());
        fs::create_directories(picture.parent_path(), fault);
        const std::string why = write_file(picture.string(), bytes);
        if (!why.empty()) return picture.string() + ": error: it cannot be written: " + why + "\n";
        drawn.insert(picture);
    }
    std::vector<fs::path> gone;
    for (fs::recursive_directory_iterator entry(folder, fault), end; !fault && entry != end; entry.increment(fault))
        if (entry->path().extension() == ".png" && !drawn.contains(entry->path())) gone.push_back(entry->path());
    for (const fs::path& picture : gone) fs::remove(picture, fault);
    const auto read_me = package.contents.find("README.md");
    const std::string why =
        write_file(page, gallery_page(package.manifest, inspection,
                                      read_me == package.contents.end() ? "" : read_me->second, at.stem().string()));
    return why.empty() ? "" : page + ": error: it cannot be written: " + why + "\n";
}

} // namespace haptel::tools
