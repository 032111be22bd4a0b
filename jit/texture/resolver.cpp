#include "jit/texture/resolver.h"

#include "jit/texture/background_optimiser.h"
#include "jit/texture/source_file.h"

namespace haptel::jit {

namespace {

// Main file and imports have the texts that `compiled` was made from. What could not be read is never current.
bool is_current(const CompiledTextures& compiled)
{
    if (compiled.has_finding("unreadable-file") || compiled.has_finding("missing-import")) return false;
    for (uint32_t i = 0; i < compiled.files.size(); ++i) {
        const SourceText source = read_source(compiled.files[i]);
        if (!source.error.empty() || source.text != compiled.sources.file(i).text) return false;
    }
    return true;
}

// The same, which owns the optimiser too: whoever holds a draft gets better code.
std::shared_ptr<const CompiledTextures> getting_better(const std::shared_ptr<const CompiledTextures>& compiled)
{
    if (!compiled->program || compiled->program->is_optimised()) return compiled;
    struct Held {
        std::shared_ptr<const CompiledTextures> compiled;
        std::shared_ptr<BackgroundOptimiser> optimiser;
    };
    const auto held = std::make_shared<Held>(compiled, BackgroundOptimiser::shared());
    held->optimiser->add(compiled->program);
    return {held, compiled.get()};
}

} // namespace

std::shared_ptr<const CompiledProgram> program_of(const std::shared_ptr<const CompiledTextures>& compiled)
{
    return {compiled, compiled->program.get()};
}

std::shared_ptr<const CompiledTextures> ProgramCache::load(const std::string& path)
{
    const std::lock_guard lock(mutex);
    std::shared_ptr<const CompiledTextures>& known = newest[path];
    if (!known || !is_current(*known))
        known = std::make_shared<CompiledTextures>(compile_texture_file(path, servo_options()));
    return getting_better(known);
}

std::shared_ptr<const CompiledTextures> ProgramCache::known(const std::string& path)
{
    const std::lock_guard lock(mutex);
    const auto found = newest.find(path);
    return found == newest.end() ? nullptr : getting_better(found->second);
}

const std::shared_ptr<ProgramCache>& ProgramCache::shared()
{
    static const auto* cache = new std::shared_ptr<ProgramCache>(std::make_shared<ProgramCache>());
    return *cache; // never taken down: compile threads may outlive static objects
}

TextureResolver make_resolver(std::shared_ptr<ProgramCache> cache)
{
    return [cache = std::move(cache)](const TextureRequest& request) -> TextureResult {
        const TextureReference reference = split_reference(request.reference, request.folder);
        const auto compiled = cache->load(reference.file);
        if (!compiled->program) return {std::nullopt, compiled->rendered()};
        TextureResult result = make_binding(program_of(compiled), reference.texture, request);
        result.diagnostics = compiled->rendered() + about_file(reference.file, result.diagnostics);
        return result;
    };
}

TextureResolver make_rebinder(std::shared_ptr<ProgramCache> cache)
{
    return [cache = std::move(cache)](const TextureRequest& request) -> TextureResult {
        const TextureReference reference = split_reference(request.reference, request.folder);
        const auto compiled = cache->known(reference.file);
        if (!compiled || !compiled->program) return {};
        TextureResult result = make_binding(program_of(compiled), reference.texture, request);
        result.diagnostics = about_file(reference.file, result.diagnostics);
        return result;
    };
}

} // namespace haptel::jit
