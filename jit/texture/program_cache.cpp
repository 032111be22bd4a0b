#include "jit/texture/program_cache.h"

#include "jit/texture/background_optimiser.h"
#include "jit/texture/source_file.h"

#include <algorithm>

namespace haptel::jit {

namespace {

// Main file and imports have the texts that `compiled` was made from. What could not be read is never current.
bool is_current(const CompiledTextures& compiled)
{
    const auto& findings = compiled.diagnostics.all();
    if (std::any_of(findings.begin(), findings.end(), [](const lang::Diagnostic& finding) {
            return finding.code == "unreadable-file" || finding.code == "missing-import";
        }))
        return false;
    for (uint32_t i = 0; i < compiled.files.size(); ++i) {
        const SourceText source = read_source(compiled.files[i]);
        if (!source.error.empty() || source.text != compiled.sources.file(i).text) return false;
    }
    return true;
}

} // namespace

std::shared_ptr<const CompiledTextures> ProgramCache::load(const std::string& path)
{
    const std::lock_guard lock(mutex);
    std::shared_ptr<const CompiledTextures>& known = newest[path];
    if (!known || !is_current(*known)) {
        known = std::make_shared<CompiledTextures>(compile_texture_file(path, servo_options()));
        BackgroundOptimiser::shared().add(known->program);
    }
    return known;
}

std::shared_ptr<const CompiledTextures> ProgramCache::known(const std::string& path)
{
    const std::lock_guard lock(mutex);
    const auto found = newest.find(path);
    return found == newest.end() ? nullptr : found->second;
}

const std::shared_ptr<ProgramCache>& ProgramCache::shared()
{
    static const auto* cache = new std::shared_ptr<ProgramCache>(std::make_shared<ProgramCache>());
    return *cache; // never taken down: compile threads may outlive static objects
}

} // namespace haptel::jit
