#include "tools/arguments/texture_files.h"

#include "jit/texture/source_file.h"
#include "lang/syntax/parser.h"

#include <filesystem>
#include <set>

namespace haptel::tools {

namespace fs = std::filesystem;

namespace {

bool has_textures(const std::string& file)
{
    jit::SourceText source = jit::read_source(file);
    if (!source.error.empty()) return true; // the compiler says why it cannot be read
    lang::SourceSet sources;
    lang::Diagnostics diagnostics;
    const lang::ast::File tree = lang::parse(sources, sources.add({file, std::move(source.text)}), diagnostics);
    return diagnostics.has_errors() || !tree.textures.empty();
}

} // namespace

std::vector<TextureTarget> texture_targets(const std::vector<std::string>& paths, bool of_functions_too)
{
    std::vector<TextureTarget> targets;
    for (const std::string& path : paths) {
        std::error_code error;
        std::set<TextureTarget> found;
        if (!fs::is_directory(path, error)) {
            const bool is_file = fs::exists(path, error);
            const jit::TextureReference reference = jit::split_reference(path);
            found.insert(is_file ? TextureTarget{path, {}} : TextureTarget{reference.file, reference.texture});
        }
        constexpr auto careful = fs::directory_options::skip_permission_denied;
        for (fs::recursive_directory_iterator entry(path, careful, error), end; !error && entry != end;
             entry.increment(error))
            if (entry->path().extension() == ".haptel" && entry->is_regular_file(error))
                found.insert({entry->path(), {}});
        for (const TextureTarget& target : found)
            if (of_functions_too || has_textures(target.file)) targets.push_back(target);
    }
    return targets;
}

} // namespace haptel::tools
