// The resolver that compiles: what the runtime's scenes ask for textures. Texture files are compiled once per process,
// known by path and content. Only height_gradient becomes code: a draft, which becomes fast code in the background.
#pragma once

#include "jit/texture/texture.h"

#include <map>
#include <memory>
#include <mutex>
#include <string>

namespace haptel::jit {

class ProgramCache {
public:
    // What load() and known() give becomes fast code for as long as somebody holds it, or a binding of program_of() it.
    // Whoever lets go of the last waits for the program under work, and does so before the process ends.

    // The file as it is on disk now: compiled if it or an import of it has changed since it was asked for last. Any
    // thread; one compiles at a time.
    std::shared_ptr<const CompiledTextures> load(const std::string& path);

    // What load() gave last for this path, without a look at the disk; null: it was never asked for.
    std::shared_ptr<const CompiledTextures> known(const std::string& path);

    // The one of this process.
    static const std::shared_ptr<ProgramCache>& shared();

private:
    std::mutex mutex;
    std::map<std::string, std::shared_ptr<const CompiledTextures>> newest; // by path
};

// Owns what load() gave.
std::shared_ptr<const CompiledProgram> program_of(const std::shared_ptr<const CompiledTextures>& compiled);

// Resolves "PATH.haptel:NAME", or "PATH.haptel" where the file holds one texture; "wood.oak:NAME" of an installed
// library. The result's diagnostics start with the file's name; warnings stand beside a binding. Any thread.
TextureResolver make_resolver(std::shared_ptr<ProgramCache> cache = ProgramCache::shared());

} // namespace haptel::jit
