#include "jit/texture/texture.h"

#include "jit/texture/facts.h"
#include "jit/texture/source_file.h"
#include "stdlib/stdlib.h"

#include <atomic>
#include <filesystem>
#include <future>

namespace haptel::jit {

namespace {

// Of the texture h among the names of entry points: h' with the gradient, h* and h'* for many points.
constexpr char with_gradient = '\'', of_many = '*';

haptel_parameter described(const ir::Parameter& parameter)
{
    using ir::Type;
    constexpr auto number = [](Type type) { return static_cast<uint32_t>(type); };
    static_assert(number(Type::real) == HAPTEL_FLOAT && number(Type::i32) == HAPTEL_INT &&
                  number(Type::u32) == HAPTEL_UINT && number(Type::boolean) == HAPTEL_BOOL &&
                  number(Type::image) == HAPTEL_IMAGE);
    return {parameter.name.c_str(), parameter.unit.c_str(), parameter.doc.c_str(), number(parameter.type),
            parameter.offset,       parameter.value,        parameter.minimum,     parameter.maximum};
}

lang::CompileOptions language_options(const TextureOptions& options)
{
    lang::CompileOptions language{{}, options.load_import, options.only_texture};
    if (options.standard_library)
        for (const stdlib::LibraryFile& file : stdlib::library())
            language.library.push_back({std::string(file.name), std::string(file.text)});
    return language;
}

// The engine starts beside the front end of the first text: neither needs the other.
std::future<void> start_engine()
{
    static std::atomic<bool> has_begun{false};
    return has_begun.exchange(true) ? std::future<void>() : std::async(std::launch::async, [] { engine_info(); });
}

} // namespace

std::vector<EntryPoint> entry_points(const ir::Module& module, const TextureOptions& options)
{
    const Entries wanted = options.entries;
    const Precision precision = options.precision.value_or(Precision::f64),
                    of_many_precision = options.precision.value_or(Precision::mixed);
    const LaneForm one =
        options.iterations_in_lanes.value_or(precision != Precision::f64) ? LaneForm::iterations : LaneForm::one;
    std::vector<EntryPoint> entries;
    for (const ir::Texture& texture : module.textures) {
        if (texture.height != UINT32_MAX && wanted != Entries::height_gradient)
            entries.push_back({texture.name, &texture, EntryPoint::Kind::height, one, precision});
        if (texture.height_gradient != UINT32_MAX)
            entries.push_back(
                {texture.name + with_gradient, &texture, EntryPoint::Kind::height_gradient, one, precision});
    }
    const size_t of_one = wanted == Entries::both_and_batches ? entries.size() : 0;
    for (size_t i = 0; i < of_one; ++i)
        entries.push_back(
            {entries[i].name + of_many, entries[i].texture, entries[i].kind, LaneForm::points, of_many_precision});
    return entries;
}

CompiledProgram::CompiledProgram(std::shared_ptr<const lang::Program> checked, std::vector<EntryPoint> of_code,
                                 std::shared_ptr<const Code> machine_code, bool has_facts)
    : program(std::move(checked)), entries(std::move(of_code)), code(std::move(machine_code))
{
    parameters.reserve(module().textures.size());
    for (const ir::Texture& texture : module().textures) {
        std::vector<haptel_parameter>& list = parameters.emplace_back();
        std::vector<const char* const*>& names = choices.emplace_back();
        for (const ir::Parameter& parameter : texture.parameters) {
            list.push_back(described(parameter));
            std::vector<const char*>& named = choice_names.emplace_back();
            for (const std::string& choice : parameter.choices) named.push_back(choice.c_str());
            names.push_back(named.empty() ? nullptr : named.data());
        }
        table.push_back({HAPTEL_ABI_VERSION, sizeof(haptel_texture), texture.reads, texture.writes, texture.block_size,
                         static_cast<uint32_t>(list.size()), texture.name.c_str(), list.data(),
                         facts_over_ranges(module(), texture, has_facts), code->entry(texture.name),
                         code->entry(texture.name + with_gradient), code->batch_entry(texture.name + of_many),
                         code->batch_entry(texture.name + with_gradient + of_many), names.data()});
    }
}

void CompiledProgram::optimise() const
{
    if (is_optimised()) return;
    CodeResult made = compile_code(module(), entries, {.effort = Effort::full, .kernels = true});
    if (made.code) code->replace_by(std::move(made.code));
    prepare_kernels(module(), entries); // of which a draft has drafts: the next edit gets better ones
}

const haptel_texture* CompiledProgram::find(std::string_view name) const
{
    if (name.empty() && table.size() == 1) return table.data();
    const std::string of_file = name.empty() ? std::filesystem::path(sources().file(0).name).stem().string() : "";
    if (name.empty()) name = of_file;
    const auto found = std::ranges::find(table, name, &haptel_texture::name);
    return found == table.end() ? nullptr : &*found;
}

const ir::Texture& CompiledProgram::source_of(const haptel_texture& texture) const
{
    return module().textures[static_cast<size_t>(&texture - table.data())];
}

TextureOptions servo_options()
{
    return {.entries = Entries::height_gradient, .effort = Effort::draft, .iterations_in_lanes = true};
}

lang::CompileResult check_texture(std::string text, const TextureOptions& options)
{
    return lang::compile({options.name, std::move(text)}, language_options(options));
}

lang::CompileResult check_texture_file(const std::string& path, TextureOptions options)
{
    options.name = path;
    options.load_import = load_beside;
    SourceText source = read_source(path);
    if (source.error.empty()) return check_texture(std::move(source.text), options);
    lang::CompileResult result;
    result.files = {path};
    result.sources.add({path, {}});
    result.diagnostics.error({}, "unreadable-file", source.error, source.hint);
    return result;
}

CompiledTextures with_code(lang::CompileResult checked, const TextureOptions& options)
{
    CompiledTextures result{nullptr, std::move(checked.diagnostics), std::move(checked.sources),
                            std::move(checked.files)};
    if (!checked.program) return result;
    std::vector<EntryPoint> entries = entry_points(checked.program->module, options);
    CodeResult code = compile_code(checked.program->module, entries, {options.effort, options.kernels});
    if (code.code)
        result.program = std::make_shared<CompiledProgram>(std::move(checked.program), std::move(entries),
                                                           std::move(code.code), options.facts_over_ranges);
    else
        result.diagnostics.error({}, "no-code", "no machine code could be made: " + code.error);
    return result;
}

CompiledTextures compile_texture(std::string_view text, const TextureOptions& options)
{
    const std::future<void> starting = start_engine();
    return with_code(check_texture(std::string(text), options), options);
}

CompiledTextures compile_texture_file(const std::string& path, TextureOptions options)
{
    const std::future<void> starting = start_engine();
    return with_code(check_texture_file(path, options), options);
}

} // namespace haptel::jit
