#include "jit/texture/resolver.h"

#include "jit/texture/source_file.h"

namespace haptel::jit {

TextureResolver make_resolver(std::shared_ptr<ProgramCache> cache, Unbounded unbounded)
{
    return [cache = std::move(cache), unbounded](const TextureRequest& request) -> TextureResult {
        const TextureReference reference = split_reference(request.reference);
        const auto compiled = cache->load(reference.file);
        std::string said = compiled->rendered();
        if (!compiled->program) return {std::nullopt, std::move(said)};
        TextureResult result = make_binding(compiled->program, reference.texture, request, unbounded);
        result.diagnostics = said + about_file(reference.file, result.diagnostics);
        return result;
    };
}

} // namespace haptel::jit
