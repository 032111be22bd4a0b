#include "lang/emit_glsl/names.h"

#include "lang/emit/function.h"
#include "lang/emit/shortest.h"

#include <algorithm>
#include <cmath>

namespace haptel::emit_glsl {

namespace {

// Keywords of GLSL 4.60 and of GLSL ES 3.20, and what either keeps for later; types of samplers and images are told by
// what they hold. length is what an array has, and no member of a structure may be called so.
constexpr std::string_view reserved[] = {
    "active",   "asm",       "atomic_uint", "attribute", "bool",      "break",         "buffer",    "bvec2",
    "bvec3",    "bvec4",     "case",        "cast",      "centroid",  "class",         "coherent",  "common",
    "const",    "continue",  "default",     "discard",   "dmat2",     "dmat3",         "dmat4",     "do",
    "double",   "dvec2",     "dvec3",       "dvec4",     "else",      "enum",          "extern",    "external",
    "false",    "filter",    "fixed",       "flat",      "float",     "for",           "fvec2",     "fvec3",
    "fvec4",    "goto",      "half",        "highp",     "hvec2",     "hvec3",         "hvec4",     "if",
    "in",       "inline",    "inout",       "input",     "int",       "interface",     "invariant", "ivec2",
    "ivec3",    "ivec4",     "layout",      "length",    "long",      "lowp",          "mat2",      "mat2x2",
    "mat2x3",   "mat2x4",    "mat3",        "mat3x2",    "mat3x3",    "mat3x4",        "mat4",      "mat4x2",
    "mat4x3",   "mat4x4",    "mediump",     "namespace", "noinline",  "noperspective", "out",       "output",
    "packed",   "partition", "patch",       "precise",   "precision", "public",        "readonly",  "resource",
    "restrict", "return",    "row_major",   "sample",    "shared",    "short",         "sizeof",    "smooth",
    "static",   "struct",    "subroutine",  "superp",    "switch",    "template",      "this",      "true",
    "typedef",  "uint",      "uniform",     "union",     "unsigned",  "using",         "uvec2",     "uvec3",
    "uvec4",    "varying",   "vec2",        "vec3",      "vec4",      "void",          "volatile",  "while",
    "writeonly"};

bool is_reserved(std::string_view name)
{
    const bool is_opaque = name.find("sampler") != name.npos || name.find("image") != name.npos;
    return is_opaque || std::ranges::binary_search(reserved, name);
}

std::string unlike(const std::vector<std::string>& others, std::string name)
{
    if (name.empty()) name = "x";
    while (std::ranges::find(others, name) != others.end()) name += name.ends_with('_') ? "x" : "_";
    return name;
}

} // namespace

std::string literal(double value)
{
    const auto held = static_cast<float>(value);
    if (std::isnan(held)) return "uintBitsToFloat(0x7fc00000u)";
    if (std::isinf(held)) return held < 0 ? "uintBitsToFloat(0xff800000u)" : "uintBitsToFloat(0x7f800000u)";
    const std::string text = emit::shortest(held);
    return std::signbit(held) ? "(" + text + ")" : text;
}

std::vector<std::string> texture_names(std::span<const ir::Texture* const> textures)
{
    std::vector<std::string> names;
    for (const ir::Texture* texture : textures) names.push_back(unlike(names, emit::readable(texture->name)));
    return names;
}

std::vector<std::string> member_names(const ir::Texture& texture)
{
    std::vector<std::string> names = {"head"};
    for (const ir::Parameter& parameter : texture.parameters) {
        const std::string name = emit::readable(parameter.name);
        const bool begins_reserved = name.starts_with("gl_");
        names.push_back(unlike(names, begins_reserved ? "x" + name : is_reserved(name) ? name + "_" : name));
    }
    names.erase(names.begin());
    return names;
}

} // namespace haptel::emit_glsl
