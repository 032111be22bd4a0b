#include "tools/library/inspect_library.h"

#include "jit/texture/texture.h"
#include "lang/text/near_name.h"
#include "libraries/places.h"
#include "tools/check/test_report.h"
#include "tools/library/library_test.h"
#include "tools/output/terminal.h"
#include "tools/plot/texture_picture.h"

#include <algorithm>
#include <fmt/format.h>
#include <map>

namespace haptel::tools {

namespace fs = std::filesystem;

namespace {

constexpr uint64_t points_seed = 1;
constexpr int preview_px = 256;

std::string dotted(std::string path)
{
    std::replace(path.begin(), path.end(), '/', '.');
    return path;
}

class Inspector {
public:
    Inspector(const libraries::Manifest& of, const libraries::Contents& in, const fs::path& at)
        : manifest(of), contents(in), folder(at)
    {
    }

    LibraryInspection run(const std::function<void(double)>& progress)
    {
        std::map<std::string, std::vector<std::string>> names; // textures by file, without .haptel
        for (const libraries::TextureName& texture : manifest.textures) names[texture.file].push_back(texture.texture);
        double done = 0;
        for (const auto& [path, bytes] : contents) {
            progress(done++ / static_cast<double>(contents.size()));
            if (!path.ends_with(".haptel")) continue;
            const std::string file = path.substr(0, path.size() - std::string_view(".haptel").size());
            const Program& program = compile(path).program;
            if (const auto named = names.find(file); program && named != names.end())
                inspect_file(file, program, named->second);
        }
        return std::move(made);
    }

private:
    using Program = std::shared_ptr<const jit::CompiledProgram>;

    std::string path_of(const std::string& path) const { return (folder / path).lexically_normal().string(); }

    void problem(const std::string& path, const std::string& what)
    {
        made.problems.push_back(path_of(path) + ": error: " + what);
    }

    // Each file once; what is wrong with it is told.
    const jit::CompiledTextures& compile(const std::string& path)
    {
        if (const auto known = all.find(path); known != all.end()) return known->second;
        jit::TextureOptions options;
        options.entries =
            path.starts_with(tests_folder) ? jit::Entries::height_gradient : jit::Entries::both_and_batches;
        const auto& compiled = all[path] = jit::compile_texture_file(path_of(path), options);
        fmt::print(stderr, "{}", compiled.rendered(stderr_has_color()));
        for (const std::string& file : compiled.files)
            if (!is_to_be_had(file))
                problem(path, "it imports " + file +
                                  ", which is outside of the library: copy it into the folder, or "
                                  "import it from a library that `dependencies` names");
        if (!compiled.program) problem(path, "it does not compile");
        return compiled;
    }

    static fs::path whole(const fs::path& path) { return fs::absolute(path).lexically_normal(); }

    // Where the library is installed: a file of its own, or of an installed library.
    bool is_to_be_had(const fs::path& file) const
    {
        const auto is_in = [&](const fs::path& outer) {
            const fs::path within = whole(file).lexically_relative(whole(outer));
            return !within.empty() && *within.begin() != "..";
        };
        const auto places = libraries::search_path(folder);
        return is_in(folder) ||
               std::any_of(places.begin(), places.end(), [&](const auto& place) { return is_in(place.folder); });
    }

    void inspect_file(const std::string& file, const Program& program, const std::vector<std::string>& names)
    {
        const std::string path = file + ".haptel";
        std::vector<std::string_view> there;
        for (const ir::Texture& texture : program->module().textures) {
            there.push_back(texture.name);
            if (std::ranges::find(names, texture.name) == names.end())
                problem(path, fmt::format("texture '{0}' is not among the `textures` of library.toml: add \"{1}:{0}\", "
                                          "or move it to a file that none of them is in",
                                          texture.name, file));
        }
        for (const std::string& name : names) {
            const haptel_texture* const texture = program->find(name);
            if (!texture) {
                const std::string_view meant = near_name(name, there).name;
                problem(path, fmt::format("it has no texture '{}', which `textures` of library.toml names{}", name,
                                          meant.empty() ? "" : fmt::format(": did you mean '{}'?", meant)));
                continue;
            }
            inspect_texture(file, program, name, program->source_of(*texture).doc);
        }
    }

    void inspect_texture(const std::string& file, const Program& program, const std::string& name,
                         const std::string& doc)
    {
        const std::string path = file + ".haptel";
        if (doc.empty())
            problem(path,
                    fmt::format("texture '{}' has no doc comment: say above it, behind ///, what it feels like", name));
        const TestedTexture tested =
            test_texture(program, path, name, request_in_cube(library_box_m), jit::default_check_points, points_seed);
        if (!tested.passed())
            for (const std::string& reason : reasons(tested))
                problem(path, fmt::format("texture '{}' does not pass haptel test: {}", name, reason));
        run_test(file, name);
        draw(file, program, name);
        made.textures.push_back({path, name, doc, previews_folder + file + "/" + name + ".png",
                                 manifest.name + "." + dotted(file) + ":" + name});
    }

    void run_test(const std::string& file, const std::string& name)
    {
        const std::string path = tests_folder + file + ".haptel";
        const bool has_tests = contents.contains(path);
        if (has_tests && !compile(path).program) return; // which is told
        const Program tests = has_tests ? compile(path).program : nullptr;
        if (!tests || !tests->find(name))
            return problem(path,
                           fmt::format("there is no texture '{0}' here that tests '{0}' of {1}.haptel: one that is "
                                       "flat where that keeps its promise, such as {0}() - {0}(p = p + vec3(1mm, 0, "
                                       "0)) of a period of 1 mm",
                                       name, file));
        const std::vector<std::string>& read = compile(path).files;
        const fs::path tested = whole(folder / (file + ".haptel"));
        if (std::none_of(read.begin(), read.end(), [&](const std::string& one) { return whole(one) == tested; }))
            return problem(path,
                           fmt::format("it does not import what it tests: import {}.{};", manifest.name, dotted(file)));
        const std::string fault = why_not_held(tests, name);
        if (!fault.empty()) problem(path, fmt::format("the test '{}' {}", name, fault));
    }

    void draw(const std::string& file, const Program& program, const std::string& name)
    {
        PictureOptions options;
        options.texture = {file + ".haptel", name};
        options.kind = "relief";
        options.window_m = preview_m;
        for (const libraries::PreviewSize& size : manifest.previews)
            if (size.of == libraries::TextureName{file, name}) options.window_m = size.window_m;
        options.size_px = preview_px;
        std::string said;
        std::optional<plot::Picture> picture =
            draw_texture(program, options, [&](const std::string& text) { said += text; });
        std::string png = picture ? picture->png() : "";
        if (png.empty()) return problem(file + ".haptel", fmt::format("there is no picture of '{}': {}", name, said));
        made.previews[previews_folder + file + "/" + name + ".png"] = std::move(png);
    }

    const libraries::Manifest& manifest;
    const libraries::Contents& contents;
    const fs::path& folder;
    std::map<std::string, jit::CompiledTextures> all; // by path
    LibraryInspection made;
};

} // namespace

LibraryInspection inspect_library(const libraries::Manifest& manifest, const libraries::Contents& contents,
                                  const fs::path& folder, const std::function<void(double)>& progress)
{
    return Inspector(manifest, contents, folder).run(progress);
}

} // namespace haptel::tools
