#include "jit/texture/resolver.h"

#include "jit/texture/source_file.h"

#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <sys/resource.h>
#include <thread>
#include <unistd.h>

namespace haptel::jit {

namespace {

using namespace std::chrono_literals;

constexpr auto rest = 200ms; // without a new program: whoever edits has paused
constexpr int niceness = 10;

// The thread that makes the code of programs in use faster: full effort, after a draft is in the hand. What it makes
// has the same bits and takes the place of the draft under the feet of its callers, so nobody is told. It is kept on
// disk, and the next process begins with it. It yields to every other thread, waits until edits have come to rest, and
// drops programs that nobody holds any more.
class BackgroundOptimiser {
public:
    // The one of this process; it ends with the process, which waits for the program under work.
    static BackgroundOptimiser& shared()
    {
        // Not destroyed, because other threads may add to the last; but stopped before LLVM's own objects go.
        static auto& optimiser = *new BackgroundOptimiser;
        return optimiser;
    }

    void add(const std::shared_ptr<const CompiledProgram>& program)
    {
        if (!program || program->is_optimised()) return;
        const std::lock_guard lock(mutex);
        waiting.push_back(program);
        changed.notify_all();
    }

private:
    BackgroundOptimiser() : thread([this](const std::stop_token& stop) { run(stop); })
    {
        std::atexit([] { shared().thread = {}; });
    }

    void run(const std::stop_token& stop)
    {
        setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), niceness);
        std::unique_lock lock(mutex);
        while (changed.wait(lock, stop, [&] { return !waiting.empty(); }) && !stop.stop_requested()) {
            const size_t before = waiting.size();
            if (changed.wait_for(lock, stop, rest, [&] { return waiting.size() != before; })) continue;
            if (stop.stop_requested()) return;
            const std::weak_ptr<const CompiledProgram> next = waiting.back(); // the newest is the likeliest to be felt
            waiting.pop_back();
            lock.unlock();
            try {
                if (const auto program = next.lock()) program->optimise();
            } catch (...) {
                // No memory for faster code: the draft stays.
            }
            lock.lock();
        }
    }

    std::mutex mutex;
    std::condition_variable_any changed;
    std::vector<std::weak_ptr<const CompiledProgram>> waiting;
    std::jthread thread;
};

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

TextureResolver make_resolver(std::shared_ptr<ProgramCache> cache)
{
    return [cache = std::move(cache)](const TextureRequest& request) -> TextureResult {
        const TextureReference reference = split_reference(request.reference);
        const auto compiled = cache->load(reference.file);
        if (!compiled->program) return {std::nullopt, compiled->rendered()};
        TextureResult result = make_binding(compiled->program, reference.texture, request);
        result.diagnostics = compiled->rendered() + about_file(reference.file, result.diagnostics);
        return result;
    };
}

} // namespace haptel::jit
