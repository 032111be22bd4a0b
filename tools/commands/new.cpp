// haptel new: a first texture to change.
#include "lang/text/lexer.h"
#include "tools/commands/command.h"
#include "tools/output/terminal.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fmt/format.h>
#include <memory>

namespace haptel::tools {

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

ExitCode create(const NewOptions& options)
{
    if (!is_name(options.name)) {
        say_error(fmt::format("'{}' cannot be the name of a texture: expected letters, digits and _, such as oak_board",
                              lang::printable(options.name)));
        return ExitCode::misuse;
    }
    std::error_code fault;
    std::filesystem::create_directories(options.folder, fault);
    const std::string path =
        (std::filesystem::path(options.folder) / (options.name + ".haptel")).lexically_normal().string();
    std::FILE* file = std::fopen(path.c_str(), "wx"); // x: never over a file that exists
    if (!file) {
        say_error(errno == EEXIST ? fmt::format("{} exists already: choose another name or --out DIR", path)
                                  : fmt::format("{} cannot be written: {}", path, std::strerror(errno)));
        return ExitCode::findings;
    }
    const std::string text = fmt::format(first_texture, options.name);
    const bool written = std::fwrite(text.data(), 1, text.size(), file) == text.size();
    if (std::fclose(file) != 0 || !written) {
        say_error(fmt::format("{} could not be written whole: is the disk full?", path));
        return ExitCode::findings;
    }
    fmt::print("{}\n", path);
    fmt::print(stderr, "haptel: try: haptel check {}\n", path);
    return ExitCode::fine;
}

} // namespace

Command new_command(CLI::App& app)
{
    const auto options = std::make_shared<NewOptions>();
    CLI::App* command = app.add_subcommand("new", "Write a first texture to change");
    command->add_option("name", options->name, "Name of the texture and its file")->required()->type_name("NAME");
    command->add_option("--out", options->folder, "Folder to write it to [.]")->type_name("DIR");
    set_examples(*command, "  haptel new oak\n"
                           "  haptel new oak --out textures");
    return {command, [options] { return create(*options); }};
}

} // namespace haptel::tools
