#include "tools/replay/traced_files.h"

#include "input/regular_file.h"
#include "jit/picture/image_file.h"
#include "jit/texture/resolver.h"
#include "jit/texture/source_file.h"
#include "runtime/files/mesh_file.h"

#include <map>
#include <optional>

namespace haptel::tools {

namespace fs = std::filesystem;

namespace {

std::optional<input::Checksum> sum_of(const fs::path& file)
{
    const input::FileBytes read = input::read_regular_file(file, runtime::mesh_bytes_max);
    if (read.refused.refusal != input::Refusal::none) return std::nullopt;
    return input::checksum(read.bytes);
}

fs::path whole_path(const fs::path& path)
{
    return fs::absolute(path).lexically_normal();
}

// Each file once, by its path; in the order of these.
using KindByFile = std::map<fs::path, std::string>;

void add_texture(const TextureRequest& request, KindByFile& kinds)
{
    const jit::TextureReference reference = jit::split_reference(request.reference, request.folder);
    kinds.emplace(whole_path(reference.file), "texture");
    const auto compiled = jit::ProgramCache::shared()->known(reference.file);
    if (!compiled || !compiled->program) return;
    for (const std::string& file : compiled->files) kinds.emplace(whole_path(file), "texture");
    const haptel_texture* texture = compiled->program->find(reference.texture);
    if (!texture) return;
    for (const ir::Parameter& parameter : compiled->program->source_of(*texture).parameters)
        for (const auto& [name, value] : request.parameters)
            if (parameter.type == ir::Type::image && name == parameter.name)
                kinds.emplace(whole_path(jit::image_file(value, request.folder)), "picture");
}

} // namespace

std::vector<runtime::TracedFile> traced_files(const fs::path& recording, const fs::path& scene,
                                              const runtime::LoadedScene& loaded)
{
    KindByFile kinds;
    for (const fs::path& mesh : loaded.meshes) kinds.emplace(whole_path(mesh), "mesh");
    for (const runtime::SceneObject& object : loaded.scene->objects)
        if (object.request) add_texture(*object.request, kinds);
    const fs::path whole_scene = whole_path(scene);
    std::vector<runtime::TracedFile> files;
    files.push_back({"scene", whole_scene.lexically_proximate(whole_path(recording).parent_path()).string(),
                     sum_of(scene).value_or(input::Checksum{})});
    for (const auto& [file, kind] : kinds)
        files.push_back({kind, file.lexically_proximate(whole_scene.parent_path()).string(),
                         sum_of(file).value_or(input::Checksum{})});
    return files;
}

std::vector<ChangedFile> changed_files(const runtime::TraceOrigin& origin, const fs::path& scene)
{
    std::vector<ChangedFile> changed;
    for (const runtime::TracedFile& file : origin.files) {
        const bool is_scene = file.kind == "scene";
        const std::optional<input::Checksum> sum = sum_of(is_scene ? scene : scene.parent_path() / file.path);
        if (!sum || *sum != file.sum) changed.push_back({file.kind, is_scene ? scene.string() : file.path, !sum});
    }
    return changed;
}

} // namespace haptel::tools
