#include "lang/syntax/foreign.h"

#include <algorithm>
#include <unordered_map>

namespace haptel::lang {

namespace {

using enum ForeignKind;

constexpr std::string_view no_precision = "leave it out; precision is chosen when the texture is compiled";
constexpr std::string_view leave_out = "leave it out";

// A word stands here once.
constexpr ForeignWord meanings[] = {
    {type, "half double f16 f32 f64 real fixed", "float",
     "float means a real number; its precision is chosen when the texture is compiled"},
    {type, "i32 int32_t", "int", "write int"},
    {type, "long short char", "int", "int has 32 bits and wraps", false},
    {type, "u32 uint32_t unsigned", "uint", "write uint"},
    {type, "auto var let", "", "write the type: float, int, vec3 ..."},
    {type, "float2 half2 double2 dvec2 vec2f vec2h", "vec2", "write vec2"},
    {type, "float3 half3 double3 dvec3 vec3f vec3h point vector color", "vec3", "write vec3"},
    {type, "float4 half4 double4 dvec4 vec4f vec4h", "vec4", "write vec4"},
    {type, "int2 vec2i", "ivec2", "write ivec2"},
    {type, "int3 vec3i", "ivec3", "write ivec3"},
    {type, "int4 vec4i", "ivec4", "write ivec4"},
    {type, "uint2 vec2u", "uvec2", "write uvec2"},
    {type, "uint3 vec3u", "uvec3", "write uvec3"},
    {type, "uint4 vec4u", "uvec4", "write uvec4"},
    {type, "bool2", "bvec2", "write bvec2"},
    {type, "bool3", "bvec3", "write bvec3"},
    {type, "bool4", "bvec4", "write bvec4"},
    {type, "mat2x2 dmat2", "mat2", "write mat2"},
    {type, "mat3x3 dmat3", "mat3", "write mat3"},
    {type, "mat4x4 dmat4", "mat4", "write mat4"},
    // Made row by row, as in HLSL: ours are their transposes, not the same.
    {type, "float2x2 half2x2 double2x2", "mat2", "write mat2", false},
    {type, "float3x3 half3x3 double3x3", "mat3", "write mat3", false},
    {type, "float4x4 half4x4 double4x4 matrix", "mat4", "write mat4", false},
    {type, "sampler2D Texture2D", "image", "an image is a parameter of a texture: texture t(image picture)", false},
    {type, "fn func function def", "",
     "a function begins with the type of its result: float f(vec3 q) { return ...; }"},
    {type, "string", "",
     "a picture is a parameter of its own type, image picture; a choice is an int whose values have names: int kind = "
     "fine in {fine, coarse}"},

    {function, "lerp", "mix", "write mix"},
    {function, "frac", "fract", "write fract"},
    {function, "rsqrt", "inversesqrt", "write inversesqrt"},
    {function, "atan2", "atan", "write atan with two arguments"},
    {function, "mad", "fma", "write fma"},
    {function, "fabs", "abs", "write abs"},
    {function, "fmin", "min", "write min"},
    {function, "fmax", "max", "write max"},
    {function, "saturate", "clamp($1, 0.0, 1.0)", "write clamp(x, 0.0, 1.0)"},
    {function, "rcp", "1.0 / $1", "write 1.0 / x"},
    {function, "exp10", "pow(10.0, $1)", "write pow(10.0, x)"},
    {function, "log10", "log($1) / log(10.0)", "write log(x) / log(10.0)"},
    {function, "hypot", "length(vec2($1, $2))", "write length(vec2(x, y))"},
    {function, "ldexp", "$1 * exp2($2)", "write x * exp2(n)"},
    {function, "isfinite", "!(isnan($1) || isinf($1))", "write !(isnan(x) || isinf(x))"},
    {function, "fmod", "", "write mod; the result has the sign of the divisor"},
    {function, "modf", "", "write fract(x) and floor(x)"},
    {function, "mul", "", "write a * b"},
    {function, "cbrt", "", "write pow(x, 1.0 / 3.0), which needs x >= 0"},
    {function, "sincos", "", "write sin(x) and cos(x)"},
    {function, "smin", "", "write smoothmin(a, b, k)"},
    {function, "smax", "", "write smoothmax(a, b, k)"},
    {function, "snoise", "simplex", "write simplex"},
    {function, "cnoise pnoise", "", "write perlin"},
    {function, "voronoi", "", "write worley(q), voronoi_border(q), or the smooth cellular(q, smoothing)"},
    {function, "rand random", "",
     "write hash(q), which jumps between cells, or the smooth value_noise(q); with a last int seed"},
    {function, "floatBitsToInt floatBitsToUint intBitsToFloat uintBitsToFloat asuint asint asfloat", "",
     "the bits of a float depend on its precision: write hash(q), of the cell that q is in, or hash(i, j)"},
    {function, "dFdx dFdy fwidth ddx ddy Du Dv", "", "derivatives are exact: write grad(f)(q)"},
    {function, "tex2D texture2D", "",
     "write sample(picture, uv), a float, or sample_rgba(picture, uv); outside of 0 .. 1 sample_tiled repeats"},
    {function, "textureLod tex2Dlod", "", "write sample(coarser(picture, int(level)), uv), a float"},
    {function, "texelFetch", "", "write texel(picture, column, row), a float"},
    {function, "textureSize", "", "write image_width(picture) and image_height(picture)"},

    {operation, "and", "&&", "write &&"},
    {operation, "or", "||", "write ||"},
    {operation, "xor", "^^", "write ^^"},
    {operation, "not", "!", "write !"},

    {name, "pi M_PI", "PI", "write PI; or use sinturn and costurn, which count full turns"},
    {name, "tau TWO_PI M_TAU", "TAU", "write TAU; or use sinturn and costurn, which count full turns"},
    {name, "M_E", "E", "write E"},
    {name, "P", "p", "the point of contact is p"},
    {name, "N", "n", "the normal is n"},
    {name, "position", "", "the point of contact is p"},
    {name, "normal", "", "the normal is n"},
    {name, "vUv", "uv", "the mesh coordinates are uv"},
    {name, "fragCoord gl_FragCoord", "", "the point of contact is p, the mesh coordinates are uv"},
    {name, "gl_FragColor fragColor Ci", "", "a texture returns its height: return 1mm;"},
    {name, "iTime", "time", "the time is time, in seconds"},
    {name, "iResolution iMouse iFrame", "",
     "there is no screen: the point of contact is p, in metres, and mesh coordinates uv go from 0 to 1"},

    {qualifier, "static inline invariant flat", "", leave_out},
    {qualifier, "constexpr", "const", "write const"},
    {qualifier, "highp mediump lowp", "", no_precision},
    {qualifier, "precise", "", "leave it out; every operation is IEEE 754 as written"},

    {statement, "do", "", "write /// @bound 64 and while (...) { ... }, or a for loop"},
    {statement, "goto", "", "write if (...) { ... } else if (...) { ... }"},
    {statement, "discard", "", "a texture has a height everywhere: return 0.0"},

    {declaration, "class union typedef", "", "write a struct: struct Cell { vec2 id; float d; };"},
    {declaration, "enum", "",
     "write constants, const int ROUGH = 1;, or name a parameter's values: int finish = fine in {fine, rough}"},
    {declaration, "uniform attribute", "",
     "what an application or a slider sets is a parameter of the texture: texture name(float pitch = 1mm)"},
    {declaration, "varying", "", "the point of contact is p, its normal n, its mesh coordinates uv"},
    {declaration, "surface displacement shader", "texture", "write texture name(float depth = 1mm) { return ...; }",
     false},
    {declaration, "precision", "", no_precision},
    {declaration, "layout using namespace", "", leave_out},
    {declaration, "template", "", "functions may take functions: float f(float basis(vec3), vec3 q)"},
};

std::unordered_map<std::string_view, const ForeignWord*> by_word()
{
    std::unordered_map<std::string_view, const ForeignWord*> meaning_of;
    for (const ForeignWord& meaning : meanings)
        for (std::string_view words = meaning.words; !words.empty();) {
            const std::string_view word = words.substr(0, words.find(' '));
            meaning_of.emplace(word, &meaning);
            words.remove_prefix(std::min(words.size(), word.size() + 1));
        }
    return meaning_of;
}

} // namespace

const ForeignWord* foreign_word(ForeignKind kind, std::string_view word)
{
    static const auto meaning_of = by_word();
    const auto found = meaning_of.find(word);
    return found == meaning_of.end() || found->second->kind != kind ? nullptr : found->second;
}

} // namespace haptel::lang
