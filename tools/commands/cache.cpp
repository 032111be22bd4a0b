// haptel cache: the machine code and the surfaces that are kept on disk, so that the next start need not make them.
#include "jit/engine/object_cache.h"
#include "jit/texture/texture.h"
#include "lang/text/diagnostic.h"
#include "runtime/files/mesh_surface.h"
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
    input::KeptFiles& surfaces = runtime::kept_surfaces();
    const uint64_t removed = options.clear ? cache.clear() : 0;
    const uint64_t surfaces_removed = options.clear ? surfaces.clear() : 0;
    const size_t kernels_before = options.prime ? jit::kernels_alive() : 0;
    if (options.prime) prime();
    const size_t kernels = options.prime ? jit::kernels_alive() - kernels_before : 0;
    const input::KeptFiles::Status status = cache.status(), of_surfaces = surfaces.status();
    if (options.json) {
        print_json({{"folder", status.folder},
                    {"fault", status.fault.empty() ? Json(nullptr) : Json(status.fault)},
                    {"objects", status.files},
                    {"bytes", status.bytes},
                    {"limit_bytes", status.limit_bytes},
                    {"removed", removed},
                    {"surfaces", of_surfaces.files},
                    {"surfaces_bytes", of_surfaces.bytes},
                    {"surfaces_limit_bytes", of_surfaces.limit_bytes},
                    {"surfaces_removed", surfaces_removed},
                    {"kernels_primed", kernels}});
        return ExitCode::fine;
    }
    if (options.clear) fmt::print("{} objects removed, {} surfaces\n", removed, surfaces_removed);
    if (options.prime) fmt::print("{} kernels of the library are ready\n", kernels);
    if (status.folder.empty())
        fmt::print("switched off: HAPTEL_CACHE names a folder, or nothing for the usual one\n");
    else
        fmt::print("{}: {} objects, {:.1f} MB of at most {:.0f} MB; {} surfaces of meshes, {:.1f} MB of at most "
                   "{:.0f} MB\n",
                   lang::printable(status.folder), status.files, static_cast<double>(status.bytes) * 1e-6,
                   static_cast<double>(status.limit_bytes) * 1e-6, of_surfaces.files,
                   static_cast<double>(of_surfaces.bytes) * 1e-6, static_cast<double>(of_surfaces.limit_bytes) * 1e-6);
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
    CLI::App* command = app.add_subcommand("cache", "Machine code and surfaces kept on disk: show, fill or empty it");
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
