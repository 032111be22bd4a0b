#include "lang/emit_glsl/source.h"

#include "lang/abi/outputs.h"
#include "lang/emit/function.h"
#include "lang/emit/shortest.h"
#include "lang/emit_glsl/glsl_dialect.h"
#include "lang/emit_glsl/helpers.h"
#include "lang/emit_glsl/names.h"
#include "lang/ir/cost.h"

#include <algorithm>
#include <cmath>
#include <deque>

namespace haptel::emit_glsl {

namespace {

// Behind "// ", on one line or several.
std::string in_comment(std::string_view text, const std::string& margin = "")
{
    std::string comment = margin + "//", space = " ";
    for (const char c : text) {
        if (c == '\n') {
            comment += "\n" + margin + "//";
            space = " ";
            continue;
        }
        const bool is_shown = c >= ' ' && c <= '~' && c != '\\'; // which at its end would join the next line to it
        comment += space + (is_shown ? c : '?');
        space.clear();
    }
    return comment + "\n";
}

std::string vector_type(size_t components)
{
    return components == 1 ? "float" : "vec" + std::to_string(components);
}

// The structures that all textures share: members as in lang/abi/abi.h.
std::string contract()
{
    std::string members, values;
    for (const OutputInfo& output : output_table) {
        members += "    " + vector_type(output.components) + " " + std::string(output.name) + "; // " +
                   std::string(output.meaning) + "\n";
        values += "    made." + std::string(output.name) + " = " +
                  (output.components > 1 ? vector_type(output.components) + "(" + literal(output.value) + ")"
                                         : literal(output.value)) +
                  ";\n";
    }
    return R"(#ifndef HAPTEL_GLSL
#define HAPTEL_GLSL
#ifdef GL_ES
precision highp float;
precision highp int;
#if __VERSION__ >= 320
#define haptel_precise precise
#else
#define haptel_precise
#endif
#elif __VERSION__ >= 400
#define haptel_precise precise
#else
#define haptel_precise
#endif

// Where the surface is touched, in metres and in the object's space. Jacobians: n_dp[i][j] is dn_i/dp_j.
struct haptel_point {
    vec3 p, n;
    vec2 uv;
    float time_s;
    vec3 n_dp[3], uv_dp[2];
    vec3 velocity;
    float normal_force_n, tool_radius_m;
    vec3 tangent, bitangent;
    float curvature_per_m;
};

// The centre of the object's box, its sides, and the smallest wavelength worth rendering (0: all), in metres.
struct haptel_head {
    vec3 center, extent;
    float footprint_m;
};

struct haptel_sample {
    float height_m; // along the outward normal
    vec3 gradient; // metres per metre; not yet projected to the surface
    uint faults; // 0: all was finite
)" + members +
           R"(};

// A point of which nothing but the place is known.
haptel_point haptel_point_at(vec3 p)
{
    vec3 none = vec3(0.0);
    return haptel_point(p, none, vec2(0.0), 0.0, vec3[3](none, none, none), vec3[2](none, none), none, 0.0, 0.0, none,
                        none, 0.0);
}

haptel_sample haptel_blank_sample()
{
    haptel_sample made;
    made.height_m = 0.0;
    made.gradient = vec3(0.0);
    made.faults = 0u;
)" + values +
           R"(    return made;
}
#endif

)";
}

std::string member_type(ir::Type type)
{
    switch (type) {
    case ir::Type::real: return "float";
    case ir::Type::u32: return "uint";
    case ir::Type::boolean: return "bool";
    case ir::Type::i32:
    case ir::Type::image: break;
    }
    return "int";
}

std::string default_of(const ir::Parameter& parameter)
{
    const auto whole = static_cast<int64_t>(parameter.value);
    switch (parameter.type) {
    case ir::Type::real: return literal(parameter.value);
    case ir::Type::u32: return std::to_string(whole) + "u";
    case ir::Type::boolean: return whole ? "true" : "false";
    case ir::Type::i32: return whole == INT32_MIN ? "int(0x80000000u)" : std::to_string(whole);
    case ir::Type::image: break;
    }
    return "0";
}

std::string remark_of(const ir::Parameter& parameter)
{
    std::string remark = parameter.name;
    const auto add = [&](const std::string& what) { remark += ", " + what; };
    if (!parameter.unit.empty()) add(parameter.unit);
    if (parameter.type == ir::Type::image) add("a place in haptel_images, 0: flat");
    for (size_t i = 0; i < parameter.choices.size(); ++i) add(std::to_string(i) + ": " + parameter.choices[i]);
    if (parameter.choices.empty() && std::isfinite(parameter.minimum) && parameter.type != ir::Type::boolean)
        add(emit::shortest(parameter.minimum) + " .. " + emit::shortest(parameter.maximum));
    if (!parameter.doc.empty()) remark += ". " + parameter.doc;
    return remark;
}

std::string block_of(const ir::Texture& texture, const std::string& name)
{
    const std::vector<std::string> members = member_names(texture);
    std::string text = "struct haptel_block_" + name + " {\n    haptel_head head;\n";
    std::string values = "haptel_head(vec3(0.0), vec3(0.0), 0.0)";
    for (size_t i = 0; i < members.size(); ++i) {
        const ir::Parameter& parameter = texture.parameters[i];
        text +=
            in_comment(remark_of(parameter), "    ") + "    " + member_type(parameter.type) + " " + members[i] + ";\n";
        values += ", " + default_of(parameter);
    }
    return text + "};\nconst haptel_block_" + name + " haptel_defaults_" + name + " = haptel_block_" + name + "(" +
           values + ");\n\n";
}

// The declarations and functions of one texture, to stand behind those of its module.
std::string texture_text(emit::ModuleText& module, const emit_c::LibraryTexture& of, const std::string& name)
{
    const ir::Texture& texture = *of.texture;
    std::string text = in_comment(texture.name + ", of " + of.file);
    if (!texture.doc.empty()) text += in_comment(texture.doc);
    text += in_comment("Height and gradient take " + std::to_string(of.facts.operations_max) + " operations at most.") +
            block_of(texture, name);
    for (const bool with_gradient : {false, true}) {
        const emit::EntryText entry = module.entry(texture, with_gradient);
        text += "haptel_sample haptel_height_" + std::string(with_gradient ? "gradient_" : "") + name +
                "(haptel_point point, haptel_block_" + name + " values)\n{\n" + entry.statements +
                "    haptel_sample made = haptel_blank_sample();\n" +
                emit::stores(entry, texture, with_gradient, "made.", "") + "    return made;\n}\n\n";
    }
    return text;
}

} // namespace

std::string source(std::string_view name, std::span<const emit_c::LibraryTexture> textures)
{
    std::vector<const ir::Texture*> all;
    for (const emit_c::LibraryTexture& of : textures) all.push_back(of.texture);
    const std::vector<std::string> names = texture_names(all);
    const GlslDialect dialect;
    std::deque<emit::ModuleText> modules;
    std::string entries, tables, functions;
    for (size_t i = 0; i < textures.size(); ++i) {
        const emit_c::LibraryTexture& of = textures[i];
        if (modules.empty() || modules.back().source() != of.module)
            modules.emplace_back(*of.module, "of_" + emit::readable(name) + std::to_string(modules.size()) + "_",
                                 dialect);
        entries += texture_text(modules.back(), of, names[i]);
    }
    for (const emit::ModuleText& module : modules) {
        tables += module.tables();
        functions += module.functions();
    }
    return in_comment(
               std::string(name) +
               ": textures compiled by Haptel, for GLSL ES 3.00, GLSL 3.30, and later. Made by `haptel build`: do "
               "not edit.\n\nPut it behind #version in a shader. Copy a texture's defaults, change what you like, "
               "set the head to the\nobject's box, and call:\n\n    haptel_block_NAME block = "
               "haptel_defaults_NAME;\n    haptel_sample made = "
               "haptel_height_gradient_NAME(haptel_point_at(p), block);\n\nA block may be a uniform.") +
           "\n" + contract() + helpers_for(functions + entries) + tables + functions + entries;
}

} // namespace haptel::emit_glsl
