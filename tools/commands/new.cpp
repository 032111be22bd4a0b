// haptel new: a first texture to change, or a first library.
#include "lang/text/lexer.h"
#include "libraries/manifest.h"
#include "tools/commands/command.h"
#include "tools/library/new_library.h"
#include "tools/output/terminal.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fmt/format.h>
#include <memory>

namespace haptel::tools {

namespace fs = std::filesystem;

namespace {

// In the style of haptel fmt. {0}: the texture's name.
constexpr const char* first_texture =
    R"(// A texture gives the height of every point of a surface, in metres; its slope and its bounds are the compiler's work.
//   what is wrong with it, how high and how steep it gets:  haptel check {0}.haptel
//   how it looks:                                           haptel plot {0}.haptel:{0} --out {0}.png
//   what there is to call, noises, fractals, patterns:      haptel info

/// Soft hills, each octave finer and lower than the one before.
texture {0}(
    float wavelength = 3mm in 0.5mm .. 20mm,  // from hill to hill; what follows "in" is the range of a slider
    float depth = 40um     in 0um .. 300um,   // how high they are, about
    int octaves = 4        in 1 .. 8)         // how much fine detail
{{
    vec3 q = p / wavelength; // p is the point under the tip, in metres; noises want plain numbers
    return depth * fbm(q, octaves);
}}
)";

struct NewOptions {
    std::string name, folder = ".";
    bool library = false;
};

bool is_name(const std::string& text)
{
    lang::SourceSet sources;
    const uint32_t file = sources.add({"name", text});
    lang::Diagnostics diagnostics;
    const lang::TokenList list = lang::lex(sources, file, diagnostics);
    return list.tokens.size() == 2 && list.tokens[0].kind == lang::Token::name &&
           list.tokens[0].end - list.tokens[0].begin == text.size();
}

// Never over a file that exists. Says what went wrong.
bool write_new(const std::string& path, const std::string& text)
{
    std::FILE* file = std::fopen(path.c_str(), "wx");
    if (!file) {
        say_error(errno == EEXIST ? fmt::format("{} exists already: choose another name or --out DIR", path)
                                  : fmt::format("{} cannot be written: {}", path, std::strerror(errno)));
        return false;
    }
    const bool written = std::fwrite(text.data(), 1, text.size(), file) == text.size();
    if (std::fclose(file) == 0 && written) return true;
    say_error(fmt::format("{} could not be written whole: is the disk full?", path));
    return false;
}

ExitCode create_library(const NewOptions& options)
{
    if (!libraries::is_library_name(options.name)) {
        say_error(
            fmt::format("'{}' cannot be the name of a library: expected small letters, digits and _, such as wood",
                        lang::printable(options.name)));
        return ExitCode::misuse;
    }
    std::error_code fault;
    const fs::path folder = (fs::path(options.folder) / options.name).lexically_normal();
    if (fs::exists(folder, fault)) {
        say_error(fmt::format("{} exists already: choose another name or --out DIR", folder.string()));
        return ExitCode::findings;
    }
    for (const auto& [path, text] : new_library(options.name)) {
        fs::create_directories((folder / path).parent_path(), fault);
        if (!write_new((folder / path).string(), text)) return ExitCode::findings;
    }
    fmt::print("{}\n", folder.string());
    fmt::print(stderr, "haptel: try: haptel pack {}\n", folder.string());
    return ExitCode::fine;
}

ExitCode create(const NewOptions& options)
{
    if (options.library) return create_library(options);
    if (!is_name(options.name)) {
        say_error(fmt::format("'{}' cannot be the name of a texture: expected letters, digits and _, such as oak_board",
                              lang::printable(options.name)));
        return ExitCode::misuse;
    }
    std::error_code fault;
    fs::create_directories(options.folder, fault);
    const std::string path = (fs::path(options.folder) / (options.name + ".haptel")).lexically_normal().string();
    if (!write_new(path, fmt::format(first_texture, options.name))) return ExitCode::findings;
    fmt::print("{}\n", path);
    fmt::print(stderr, "haptel: try: haptel check {}\n", path);
    return ExitCode::fine;
}

} // namespace

Command new_command(CLI::App& app)
{
    const auto options = std::make_shared<NewOptions>();
    CLI::App* command = app.add_subcommand("new", "Write a first texture to change, or a first library");
    command->add_option("name", options->name, "Name of the texture and its file, or of the library and its folder")
        ->required()
        ->type_name("NAME");
    command->add_option("--out", options->folder, "Folder to write it to [.]")->type_name("DIR");
    command->add_flag("--library", options->library, "A folder with a library.toml, a texture and its test");
    set_examples(*command, "  haptel new oak\n"
                           "  haptel new --library wood\n"
                           "  haptel new oak --out textures");
    return {command, [options] { return create(*options); }};
}

} // namespace haptel::tools
