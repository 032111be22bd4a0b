// haptel build: textures as code for programs that hold no compiler.
#include "jit/ahead/ahead.h"
#include "jit/codegen/isa.h"
#include "jit/texture/facts.h"
#include "lang/emit_c/header.h"
#include "lang/emit_c/source.h"
#include "lang/emit_glsl/source.h"
#include "lang/ir/print.h"
#include "libraries/manifest.h"
#include "tools/arguments/precisions.h"
#include "tools/arguments/texture_files.h"
#include "tools/commands/build_shared.h"
#include "tools/commands/command.h"
#include "tools/library/library_place.h"
#include "tools/output/json.h"
#include "tools/output/replace_file.h"
#include "tools/output/terminal.h"

#include <filesystem>
#include <fmt/format.h>
#include <map>
#include <memory>
#include <vector>

namespace haptel::tools {

namespace {

struct BuildOptions {
    std::string what, emit, out, precision, depfile; // empty: not given
    std::vector<std::string> isas;
    bool json = false;
};

// Everything that goes into one library; the textures point into the programs.
struct Library {
    std::vector<std::shared_ptr<const lang::Program>> programs;
    std::vector<emit_c::LibraryTexture> textures;
    std::vector<std::string> files; // read, with what they import
    bool is_sound = true;
};

void add_file(Library& library, const TextureTarget& target)
{
    const lang::CompileResult checked = jit::check_texture_file(target.file, {.only_texture = target.texture});
    fmt::print(stderr, "{}", lang::render(checked.diagnostics.all(), checked.sources, stderr_has_color()));
    library.files.insert(library.files.end(), checked.files.begin(), checked.files.end());
    if (!checked.program) {
        library.is_sound = false;
        return;
    }
    library.programs.push_back(checked.program);
    const ir::Module& module = checked.program->module;
    for (const ir::Texture& texture : module.textures) {
        if (texture.height_gradient == UINT32_MAX) continue; // another one is meant
        for (const emit_c::LibraryTexture& known : library.textures)
            if (known.texture->name == texture.name) {
                say_error(
                    fmt::format("{0} and {1} both have a texture '{2}', and in a library names are symbols: rename "
                                "one of them, or build them apart ({1}:{2})",
                                known.file, target.file, texture.name));
                library.is_sound = false;
            }
        library.textures.push_back({&module, &texture, jit::facts_over_ranges(module, texture, true),
                                    std::filesystem::path(target.file).filename().string()});
    }
}

// Of a library of textures those that it names, not its tests: these are called like what they test.
std::vector<TextureTarget> targets_of(const std::string& what, std::string& fault)
{
    std::error_code ignored;
    const std::filesystem::path folder =
        std::filesystem::is_regular_file(what, ignored) ? std::filesystem::path() : library_named(what);
    if (folder.empty()) return texture_targets({what});
    const libraries::ManifestFile written = libraries::read_manifest_file(folder / libraries::manifest_name);
    fault = written.fault;
    std::vector<TextureTarget> targets;
    if (written.manifest)
        for (const libraries::TextureName& texture : written.manifest->textures)
            targets.push_back({(folder / (texture.file + ".haptel")).string(), texture.texture});
    return targets;
}

Library library_of(const std::string& what)
{
    Library library;
    std::string fault;
    for (const TextureTarget& target : targets_of(what, fault)) add_file(library, target);
    if (!fault.empty()) {
        say_error(fault);
        library.is_sound = false;
    }
    if (library.is_sound && library.textures.empty()) {
        say_error(
            fmt::format("{} holds no texture: expected a texture file, one texture of it as FILE:NAME, a folder with "
                        "texture files, or the name of an installed library",
                        what));
        library.is_sound = false;
    }
    return library;
}

// What each kind of output is made of, and which options change it.
struct Maker {
    const char *name, *shows;
    jit::AheadResult (*make)(const Library&, const BuildOptions&);
    bool has_isa, has_precision;
};

// "brushed" of "out/libbrushed.so".
std::string library_name(const BuildOptions& options)
{
    const std::string stem = std::filesystem::path(options.out).stem().string();
    return stem.starts_with("lib") && stem.size() > 3 ? stem.substr(3) : stem;
}

jit::AheadOptions ahead_options(const BuildOptions& options)
{
    jit::AheadOptions ahead;
    if (!options.isas.empty()) ahead.isas = options.isas;
    if (!options.precision.empty()) ahead.precision = precision_of(options.precision);
    return ahead;
}

jit::AheadResult make_object(const Library& library, const BuildOptions& options)
{
    return jit::build_object(library.textures, ahead_options(options));
}

jit::AheadResult make_static(const Library& library, const BuildOptions& options)
{
    const jit::AheadResult object = make_object(library, options);
    return object.error.empty() ? jit::archive_of(object.bytes, library_name(options) + ".o") : object;
}

jit::AheadResult make_shared_library(const Library& library, const BuildOptions& options)
{
    const jit::AheadResult object = make_object(library, options);
    if (!object.error.empty()) return object;
    SharedLibrary made = link_shared(object.bytes, std::filesystem::path(options.out).filename().string());
    return {std::move(made.bytes), std::move(made.error)};
}

jit::AheadResult make_header(const Library& library, const BuildOptions& options)
{
    return {emit_c::header(library_name(options), library.textures), {}};
}

jit::AheadResult make_llvm(const Library& library, const BuildOptions& options)
{
    return jit::build_llvm_text(library.textures, ahead_options(options));
}

jit::AheadResult make_assembler(const Library& library, const BuildOptions& options)
{
    return jit::build_assembler_text(library.textures, ahead_options(options));
}

jit::AheadResult make_ir(const Library& library, const BuildOptions&)
{
    jit::AheadResult result;
    for (const std::shared_ptr<const lang::Program>& program : library.programs)
        result.bytes += ir::print(program->module);
    return result;
}

jit::AheadResult make_c(const Library& library, const BuildOptions& options)
{
    return {emit_c::source(library_name(options), library.textures, options.precision == "f32"), {}};
}

jit::AheadResult make_glsl(const Library& library, const BuildOptions& options)
{
    return {emit_glsl::source(library_name(options), library.textures), {}};
}

constexpr Maker makers[] = {
    {"object", "machine code, to link into a program", make_object, true, true},
    {"static", "the same as a static library, libNAME.a", make_static, true, true},
    {"shared", "the same as a shared library, libNAME.so; linked by cc", make_shared_library, true, true},
    {"header", "the C header for any of them, and for c", make_header, false, false},
    {"c", "C99 text, complete by itself, for any processor", make_c, false, true},
    {"glsl", "functions of GLSL, to draw what is felt: for WebGL 2 and OpenGL 3.3, and later", make_glsl, false, false},
    {"asm", "the machine code as assembler's text", make_assembler, true, true},
    {"llvm", "LLVM's intermediate representation as text, optimised", make_llvm, true, true},
    {"ir", "Haptel's own intermediate representation as text, with exact derivatives", make_ir, false, false},
};

const Maker* maker_of(const std::string& name)
{
    for (const Maker& maker : makers)
        if (name == maker.name) return &maker;
    return nullptr;
}

// A rule as make and ninja read it: the output is older than none of these.
std::string depfile_of(const Library& library, const BuildOptions& options)
{
    const auto escaped = [](const std::string& path) {
        std::string text;
        for (const char c : path)
            text += c == ' ' || c == '#' || c == '\\' ? std::string("\\") + c : c == '$' ? "$$" : std::string(1, c);
        return text;
    };
    std::string rule = escaped(options.out) + ":";
    for (const std::string& file : library.files) rule += " \\\n " + escaped(file);
    return rule + "\n";
}

// Empty, or why not.
std::string write_output(const std::string& path, std::string_view bytes)
{
    const std::string why = write_file(path, bytes);
    return why.empty() ? "" : fmt::format("{} could not be written: {}", path, why);
}

// Empty, or what of the command line would change nothing.
std::string misuse_of(const BuildOptions& options)
{
    const auto without_effect = [&](const char* option, const char* why, bool Maker::* has) {
        std::string kinds;
        for (const Maker& maker : makers)
            if (maker.*has) kinds += (kinds.empty() ? "" : ", ") + std::string(maker.name);
        return fmt::format("{} changes nothing of --emit {}, which {}: leave it out, or emit one of {}", option,
                           options.emit, why, kinds);
    };
    const Maker& maker = *maker_of(options.emit);
    if (!options.isas.empty() && !maker.has_isa)
        return without_effect("--isa", "is the same for every processor", &Maker::has_isa);
    if (!options.precision.empty() && !maker.has_precision)
        return without_effect("--precision", "is the same for every precision", &Maker::has_precision);
    if (options.emit == "c" && options.precision == "mixed")
        return "--emit c is in f64 or f32 throughout: expected --precision f64 or f32, found mixed";
    std::string error;
    if (!jit::sets_in_order(options.isas, error)) return "--isa: " + error;
    return {};
}

Json to_json(const Library& library, const BuildOptions& options, size_t bytes)
{
    Json textures = Json::array();
    for (const emit_c::LibraryTexture& texture : library.textures)
        textures.push_back({{"file", texture.file},
                            {"name", texture.texture->name},
                            {"symbol", emit_c::texture_symbol(*texture.texture)},
                            {"block_bytes", texture.texture->block_size},
                            {"operations_max", texture.facts.operations_max}});
    Json made{{"emit", options.emit}, {"out", options.out}};
    if (maker_of(options.emit)->has_isa) made["isa"] = ahead_options(options).isas;
    made.update({{"abi", int{HAPTEL_ABI_VERSION}}, {"bytes", bytes}, {"textures", std::move(textures)}});
    return made;
}

ExitCode build(const BuildOptions& options)
{
    if (const std::string misuse = misuse_of(options); !misuse.empty()) {
        say_error(misuse);
        return ExitCode::misuse;
    }
    if (const std::string why = why_not_written(options.out); !why.empty()) {
        say_error(fmt::format("{} cannot be written: {}", options.out, why));
        return ExitCode::findings;
    }
    const Library library = library_of(options.what);
    if (!library.is_sound) return ExitCode::findings;
    const jit::AheadResult made = maker_of(options.emit)->make(library, options);
    std::string error = made.error;
    if (error.empty()) error = write_output(options.out, made.bytes);
    if (error.empty() && !options.depfile.empty()) error = write_output(options.depfile, depfile_of(library, options));
    if (!error.empty()) {
        say_error(error);
        return ExitCode::findings;
    }
    if (options.json) print_json(to_json(library, options, made.bytes.size()));
    return ExitCode::fine;
}

} // namespace

Command build_command(CLI::App& app)
{
    const auto options = std::make_shared<BuildOptions>();
    CLI::App* command = app.add_subcommand("build", "Compile textures ahead of time, for programs without a compiler");
    command
        ->add_option("what", options->what,
                     "A texture file, one texture of it, a folder of such files, or a library of textures: one library")
        ->required()
        ->type_name("FILE[:NAME]|DIR|LIBRARY");
    std::string shows = "What to make:";
    std::vector<std::string> names;
    for (const Maker& maker : makers) {
        names.emplace_back(maker.name);
        shows += fmt::format("\n  {}: {}", maker.name, maker.shows);
    }
    command->add_option("--emit", options->emit, shows)->required()->check(CLI::IsMember(names));
    command->add_option("-o,--out", options->out, "File to write")->required()->type_name("PATH");
    command
        ->add_option("--isa", options->isas,
                     "The least processor that machine code runs on [baseline: any of this architecture]; of several, "
                     "by commas, the largest that the processor has is chosen at load")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->check(CLI::IsMember({"baseline", "avx2", "avx512", "aarch64"}));
    command
        ->add_option("--precision", options->precision,
                     "Of the code: f64, mixed or f32 [f64 for one point, mixed for many; c: f64]")
        ->check(CLI::IsMember({"f64", "mixed", "f32"}));
    command
        ->add_option("--depfile", options->depfile, "Write a rule for make and ninja: the files that it was made from")
        ->type_name("PATH");
    command->add_flag("--json", options->json, "One JSON object on standard output: what was made");
    set_examples(*command, "  haptel build rock.haptel --emit static -o librock.a\n"
                           "  haptel build rock.haptel --emit header -o rock.h\n"
                           "  haptel build materials --emit shared --isa baseline,avx2,avx512 -o libmaterials.so\n"
                           "  haptel build rock.haptel:rock --emit c --precision f32 -o rock.c");
    return {command, [options] { return build(*options); }};
}

} // namespace haptel::tools
