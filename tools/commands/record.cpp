// haptel record: explores a scene, as `explore --record FILE` does, for `haptel replay`.
#include "tools/commands/command.h"
#include "tools/commands/explore.h"

#include <memory>

namespace haptel::tools {

Command record_command(CLI::App& app)
{
    const auto options = std::make_shared<ExploreOptions>();
    CLI::App* command =
        app.add_subcommand("record", "Explore a scene, and keep every tick in a file for `haptel replay`");
    add_exploring(*command, *options);
    command
        ->add_option("--out", options->recording,
                     "The recording (that of a second device has _2 in its name). What is recorded is in the file "
                     "within 20 ms, whatever becomes of the program")
        ->required()
        ->type_name("FILE.haptrace");
    set_examples(*command, "  haptel record scene.toml --out run.haptrace --seconds 10\n"
                           "  haptel replay run.haptrace\n"
                           "  haptel record scene.toml --out scene.feel.haptrace --seconds 1 --clock virtual\n"
                           "The last one is what `haptel test scene.toml` then holds the scene to.");
    return {command, [options] { return explore(*options); }};
}

} // namespace haptel::tools
