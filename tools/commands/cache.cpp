// haptel cache: the machine code that is kept on disk, so that the next start need not make it.
#include "jit/engine/object_cache.h"
#include "jit/texture/texture.h"
#include "lang/text/diagnostic.h"
#include "stdlib/stdlib.h"
#include "tools/arguments/quantity.h"
#include "tools/commands/command.h"
#include "tools/output/json.h"
#include "tools/output/terminal.h"

#include <filesystem>
#include <fmt/format.h>
#include <memory>

namespace haptel::tools {

namespace {

struct CacheOptions {
    bool prime = false, clear = false, json = false;
};

// Every texture of the library as a servo calls it, and as pictures and tests do: what they call becomes kernels.
void prime()
{
    jit::TextureOptions servo = jit::servo_options(), pictures;
    servo.effort = jit::Effort::quick; // kernels of drafts are not kept
    pictures.entries = jit::Entries::both_and_batches;
    const auto files = stdlib::tests();
    Progress progress;
    for (size_t i = 0; i < files.size(); ++i) {
        progress.show(static_cast<double>(i) / static_cast<double>(files.size()));
        for (jit::TextureOptions options : {servo, pictures}) {
            options.name = files[i].name;
            jit::compile_texture(files[i].text, options);
        }
    }
}

ExitCode run(const CacheOptions& options)
{
    jit::ObjectCache& cache = jit::ObjectCache::shared();
    const uint64_t removed = options.clear ? cache.clear() : 0;
    const size_t kernels_before = options.prime ? jit::kernels_alive() : 0;
    if (options.prime) prime();
    const size_t kernels = options.prime ? jit::kernels_alive() - kernels_before : 0;
    const jit::ObjectCache::Status status = cache.status();
    if (options.json) {
        print_json({{"folder", status.folder},
                    {"fault", status.fault.empty() ? Json(nullptr) : Json(status.fault)},
                    {"objects", status.objects},
                    {"bytes", status.bytes},
                    {"limit_bytes", status.limit_bytes},
                    {"removed", removed},
                    {"kernels_primed", kernels}});
        return ExitCode::fine;
    }
    if (options.clear) fmt::print("{} objects removed\n", removed);
    if (options.prime) fmt::print("{} kernels of the library are ready\n", kernels);
    if (status.folder.empty())
        fmt::print("switched off: HAPTEL_CACHE names a folder, or nothing for the usual one\n");
    else
        fmt::print("{}: {} objects, {:.1f} MB of at most {:.0f} MB\n", lang::printable(status.folder), status.objects,
                   static_cast<double>(status.bytes) * 1e-6, static_cast<double>(status.limit_bytes) * 1e-6);
    std::error_code ignored; // a folder that is not there yet will be made
    if (!status.folder.empty() && !status.fault.empty() &&
        (options.prime || std::filesystem::exists(status.folder, ignored)))
        say_warning(fmt::format("the folder is not used: {}", status.fault));
    return ExitCode::fine;
}

} // namespace

Command cache_command(CLI::App& app)
{
    const auto options = std::make_shared<CacheOptions>();
    CLI::App* command = app.add_subcommand("cache", "Machine code kept on disk: show, fill or empty it");
    command->add_flag("--prime", options->prime,
                      "Compile the standard library into it, as a build or installation does");
    command->add_flag("--clear", options->clear, "Empty it (before --prime)");
    command->add_flag("--json", options->json, "One JSON object on standard output");
    set_examples(*command, "  haptel cache\n"
                           "  haptel cache --clear --prime\n"
                           "  HAPTEL_CACHE=$PWD/cache haptel cache --prime --json");
    return {command, [options] { return run(*options); }};
}

} // namespace haptel::tools
