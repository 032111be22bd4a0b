#include "lang/emit_c/source.h"

#include "lang/abi/outputs.h"
#include "lang/emit/function.h"
#include "lang/emit_c/c_dialect.h"
#include "lang/emit_c/header.h"
#include "lang/emit_c/helpers.h"
#include "lang/emit_c/words.h"
#include "lang/ir/cost.h"

#include <algorithm>
#include <deque>

namespace haptel::emit_c {

namespace {

std::string list(std::initializer_list<std::string> items)
{
    std::string text = "{";
    for (const std::string& item : items) text += (text.size() == 1 ? "" : ", ") + item;
    return text + "}";
}

std::string parameter_row(const ir::Texture& texture, const ir::Parameter& parameter)
{
    static constexpr const char* types[] = {"HAPTEL_FLOAT", "HAPTEL_INT", "HAPTEL_UINT", "HAPTEL_BOOL", "HAPTEL_IMAGE"};
    return "    " +
           list({quoted(parameter.name), quoted(parameter.unit), quoted(parameter.doc),
                 types[static_cast<size_t>(parameter.type)],
                 "(uint32_t)offsetof(" + block_type(texture) + ", " + member_name(texture, parameter) + ")",
                 literal(parameter.value), literal(parameter.minimum), literal(parameter.maximum)}) +
           ",\n";
}

std::string default_of(const ir::Parameter& parameter)
{
    switch (parameter.type) {
    case ir::Type::real: return literal(parameter.value);
    case ir::Type::i32:
    case ir::Type::boolean: {
        const auto value = static_cast<int64_t>(parameter.value);
        return value == INT32_MIN ? "INT32_MIN" : std::to_string(value);
    }
    case ir::Type::u32: return literal(static_cast<uint32_t>(parameter.value));
    case ir::Type::image: return "0";
    }
    return {};
}

// Parameters, names of choices, defaults and the texture itself.
std::string data_of(const LibraryTexture& of, const std::string& height, const std::string& height_gradient)
{
    const ir::Texture& texture = *of.texture;
    const std::string& name = texture.name;
    std::string text, parameters = "0", choices = "0", rows, chosen;
    std::string defaults = "{{0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}, 0.0}";
    bool has_choices = false;
    for (const ir::Parameter& parameter : texture.parameters) {
        rows += parameter_row(texture, parameter);
        defaults += ", " + default_of(parameter);
        const std::string names = "choices_" + std::to_string(parameter.offset) + "_" + name;
        chosen += parameter.choices.empty() ? "0, " : names + ", ";
        if (parameter.choices.empty()) continue;
        has_choices = true;
        text += "static const char* const " + names + "[] = {";
        for (const std::string& choice : parameter.choices) text += quoted(choice) + ", ";
        text += "};\n";
    }
    if (has_choices) {
        choices = "choices_" + name;
        text += "static const char* const* const " + choices + "[] = {" + chosen + "};\n";
    }
    if (!rows.empty()) {
        parameters = "parameters_" + name;
        text += "static const haptel_parameter " + parameters + "[] = {\n" + rows + "};\n";
    }
    const haptel_facts& facts = of.facts;
    text += "const " + block_type(texture) + " " + defaults_symbol(texture) + " = {" + defaults + "};\n";
    text += "const haptel_texture " + texture_symbol(texture) +
            " = {\n    HAPTEL_ABI_VERSION, (uint32_t)sizeof(haptel_texture), " + literal(texture.reads) + ", " +
            literal(texture.writes) + ", (uint32_t)sizeof(" + block_type(texture) + "), " +
            literal(static_cast<uint32_t>(texture.parameters.size())) + ", " + quoted(name) + ", " + parameters +
            ",\n    " +
            list({literal(facts.height_min_m), literal(facts.height_max_m), literal(facts.slope_max),
                  literal(facts.curvature_max_per_m), literal(facts.continuity), literal(facts.operations_max)}) +
            ",\n    " + height + ", " + height_gradient + ", 0, 0, " + choices + "};\n\n";
    return text;
}

// A haptel_entry, which stands behind the module's functions; its name.
std::string add_entry(emit::ModuleText& module, const ir::Texture& texture, bool with_gradient, bool is_single)
{
    const emit::EntryText entry = module.entry(texture, with_gradient);
    std::string stores = emit::stores(entry, texture, with_gradient, "sample->", is_single ? "(double)" : "");
    if (with_gradient)
        for_each_output(outputs_always_written & ~texture.writes, [&](const OutputInfo& output, size_t) {
            stores += "    sample->" + std::string(output.name) + " = " + literal(output.value) + ";\n";
        });
    const std::string name = module.name_prefix() + texture.name + (with_gradient ? "_height_gradient" : "_height");
    module.append("static void " + name +
                  "(const haptel_point* const point, const void* const block, haptel_sample* const sample)\n{\n"
                  "    const " +
                  block_type(texture) + "* const values = (const " + block_type(texture) +
                  "*)block;\n    (void)point;\n    (void)values;\n" + entry.statements + stores + "}\n\n");
    return name;
}

std::string costs_of(std::span<const LibraryTexture> textures)
{
    std::string text;
    for (const LibraryTexture& of : textures) {
        const auto operations = [&](uint32_t entry) { return std::to_string(ir::operations_max(*of.module, entry)); };
        text += " *   " + of.texture->name + ": " + operations(of.texture->height) + " operations for the height, " +
                operations(of.texture->height_gradient) + " with the gradient; a block of " +
                std::to_string(of.texture->block_size) + " bytes\n";
    }
    return text;
}

} // namespace

std::string source(std::string_view name, std::span<const LibraryTexture> textures, bool is_single)
{
    const CDialect dialect(is_single);
    std::deque<emit::ModuleText> modules;
    std::string data, tables, functions;
    for (const LibraryTexture& of : textures) {
        if (modules.empty() || modules.back().source() != of.module)
            modules.emplace_back(*of.module, "m" + std::to_string(modules.size()) + "_", dialect);
        const std::string height = add_entry(modules.back(), *of.texture, false, is_single);
        data += data_of(of, height, add_entry(modules.back(), *of.texture, true, is_single));
    }
    uint64_t table_bytes = 0, variable_bytes = 0;
    for (const emit::ModuleText& module : modules) {
        tables += module.tables();
        functions += module.functions();
        table_bytes += module.table_bytes();
        variable_bytes = std::max(variable_bytes, module.variable_bytes());
    }
    return "/* At most, for one call:\n" + costs_of(textures) + " * Constant tables: " + std::to_string(table_bytes) +
           " bytes. Variables of a call: " + std::to_string(variable_bytes) +
           " bytes, were none kept in a register.\n"
           " * No heap, no recursion. Compile with -std=c99 or -ffp-contract=off, and without -ffast-math.\n */\n" +
           header(name, textures) +
           "\n#include <float.h>\n#include <math.h>\n#include <stddef.h>\n#include <string.h>\n\n"
           "#if defined(__FAST_MATH__) || (defined(FLT_EVAL_METHOD) && FLT_EVAL_METHOD != 0)\n"
           "#error \"each operation must be rounded once, to its own type: no -ffast-math, and on x86 -msse2 "
           "-mfpmath=sse\"\n"
           "#endif\n#ifdef __clang__\n#pragma STDC FP_CONTRACT OFF\n#endif\n\n" +
           helpers_for(functions, is_single) + tables + functions + data;
}

} // namespace haptel::emit_c
