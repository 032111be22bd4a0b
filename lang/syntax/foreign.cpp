#include "lang/syntax/foreign.h"

#include <algorithm>
#include <deque>
#include <string>
#include <unordered_map>

namespace haptel::lang {

namespace {

constexpr std::string_view use_float =
    "float means a real number; its precision is chosen when the texture is compiled";
constexpr std::string_view no_bvec = "compare component by component and join with && or ||";
constexpr std::string_view no_ivec = "vectors are of float; keep whole numbers in int variables";
constexpr std::string_view use_for =
    "every texture must end: write a for loop with a constant bound and leave it by break";
constexpr std::string_view use_if = "write if (...) { ... } else if (...) { ... }";
constexpr std::string_view use_parameter =
    "what an application or a slider sets is a parameter of the texture: texture name(float pitch = 1mm)";
constexpr std::string_view no_precision = "leave it out; precision is chosen when the texture is compiled";
constexpr std::string_view no_struct = "there are no structures; pass the values one by one or in a vector";
constexpr std::string_view use_grad = "derivatives are exact: write grad(f)(q)";
constexpr std::string_view use_texture = "write texture name(float depth = 1mm) { return ...; }";
constexpr std::string_view use_function =
    "a function begins with the type of its result: float f(vec3 q) { return ...; }";
constexpr std::string_view use_noise =
    "what a hand feels is continuous: write perlin(q) or noise(q), with a last int seed";
constexpr std::string_view use_turns =
    "write const float PI = 3.141592653589793; or use sinturn and costurn, which count full turns";
constexpr std::string_view use_return = "a texture returns its height: return 1mm;";
constexpr std::string_view use_image = "an image is a parameter of a texture: texture t(image picture)";
constexpr std::string_view use_sample = "write sample(picture, uv), a float; outside of 0 .. 1 sample_tiled repeats";
constexpr std::string_view leave_out = "leave it out";

constexpr ForeignWord words[] = {
    {ForeignKind::type, "half", "float", use_float},
    {ForeignKind::type, "double", "float", use_float},
    {ForeignKind::type, "f16", "float", use_float},
    {ForeignKind::type, "f32", "float", use_float},
    {ForeignKind::type, "f64", "float", use_float},
    {ForeignKind::type, "real", "float", use_float},
    {ForeignKind::type, "fixed", "float", use_float},
    {ForeignKind::type, "point", "vec3", "write vec3"},
    {ForeignKind::type, "vector", "vec3", "write vec3"},
    {ForeignKind::type, "color", "vec3", "write vec3"},
    {ForeignKind::type, "i32", "int", "write int"},
    {ForeignKind::type, "u32", "uint", "write uint"},
    {ForeignKind::type, "int32_t", "int", "write int"},
    {ForeignKind::type, "uint32_t", "uint", "write uint"},
    {ForeignKind::type, "unsigned", "uint", "write uint"},
    {ForeignKind::type, "long", "int", "int has 32 bits and wraps", false},
    {ForeignKind::type, "short", "int", "int has 32 bits and wraps", false},
    {ForeignKind::type, "char", "int", "int has 32 bits and wraps", false},
    {ForeignKind::type, "auto", "", "write the type: float, int, vec3 ..."},
    {ForeignKind::type, "var", "", "write the type: float, int, vec3 ..."},
    {ForeignKind::type, "let", "", "write the type: float, int, vec3 ..."},
    {ForeignKind::type, "sampler2D", "image", use_image, false},
    {ForeignKind::type, "Texture2D", "image", use_image, false},
    {ForeignKind::type, "matrix", "mat4", "write mat4", false},
    {ForeignKind::type, "fn", "", use_function},
    {ForeignKind::type, "func", "", use_function},
    {ForeignKind::type, "function", "", use_function},
    {ForeignKind::type, "def", "", use_function},

    {ForeignKind::function, "lerp", "mix", "write mix"},
    {ForeignKind::function, "frac", "fract", "write fract"},
    {ForeignKind::function, "fmod", "", "write mod; the result has the sign of the divisor"},
    {ForeignKind::function, "modf", "", "write fract(x) and floor(x)"},
    {ForeignKind::function, "saturate", "clamp($1, 0.0, 1.0)", "write clamp(x, 0.0, 1.0)"},
    {ForeignKind::function, "mul", "", "write a * b"},
    {ForeignKind::function, "rcp", "1.0 / $1", "write 1.0 / x"},
    {ForeignKind::function, "exp10", "pow(10.0, $1)", "write pow(10.0, x)"},
    {ForeignKind::function, "log10", "log($1) / log(10.0)", "write log(x) / log(10.0)"},
    {ForeignKind::function, "cbrt", "", "write pow(x, 1.0 / 3.0), which needs x >= 0"},
    {ForeignKind::function, "hypot", "length(vec2($1, $2))", "write length(vec2(x, y))"},
    {ForeignKind::function, "ldexp", "$1 * exp2($2)", "write x * exp2(n)"},
    {ForeignKind::function, "sincos", "", "write sin(x) and cos(x)"},
    {ForeignKind::function, "isfinite", "!(isnan($1) || isinf($1))", "write !(isnan(x) || isinf(x))"},
    {ForeignKind::function, "rsqrt", "inversesqrt", "write inversesqrt"},
    {ForeignKind::function, "atan2", "atan", "write atan with two arguments"},
    {ForeignKind::function, "mad", "fma", "write fma"},
    {ForeignKind::function, "fabs", "abs", "write abs"},
    {ForeignKind::function, "fmin", "min", "write min"},
    {ForeignKind::function, "fmax", "max", "write max"},
    {ForeignKind::function, "smin", "", "write smoothmin(a, b, k)"},
    {ForeignKind::function, "smax", "", "write smoothmax(a, b, k)"},
    {ForeignKind::function, "snoise", "", "write perlin"},
    {ForeignKind::function, "cnoise", "", "write perlin"},
    {ForeignKind::function, "pnoise", "", "write perlin"},
    {ForeignKind::function, "worley", "", "write cellular(q, smoothing)"},
    {ForeignKind::function, "voronoi", "", "write cellular(q, smoothing)"},
    {ForeignKind::function, "rand", "", use_noise},
    {ForeignKind::function, "random", "", use_noise},
    {ForeignKind::function, "hash", "", use_noise},
    {ForeignKind::function, "lessThan", "", no_bvec},
    {ForeignKind::function, "lessThanEqual", "", no_bvec},
    {ForeignKind::function, "greaterThan", "", no_bvec},
    {ForeignKind::function, "greaterThanEqual", "", no_bvec},
    {ForeignKind::function, "equal", "", no_bvec},
    {ForeignKind::function, "notEqual", "", no_bvec},
    {ForeignKind::function, "any", "", no_bvec},
    {ForeignKind::function, "all", "", no_bvec},
    {ForeignKind::function, "dFdx", "", use_grad},
    {ForeignKind::function, "dFdy", "", use_grad},
    {ForeignKind::function, "fwidth", "", use_grad},
    {ForeignKind::function, "ddx", "", use_grad},
    {ForeignKind::function, "ddy", "", use_grad},
    {ForeignKind::function, "Du", "", use_grad},
    {ForeignKind::function, "Dv", "", use_grad},
    {ForeignKind::function, "tex2D", "", use_sample},
    {ForeignKind::function, "texture2D", "", use_sample},
    {ForeignKind::function, "textureLod", "", use_sample},
    {ForeignKind::function, "texelFetch", "", "write texel(picture, column, row), a float"},
    {ForeignKind::function, "textureSize", "", "write image_width(picture) and image_height(picture)"},

    {ForeignKind::operation, "and", "&&", "write &&"},
    {ForeignKind::operation, "or", "||", "write ||"},
    {ForeignKind::operation, "xor", "^^", "write ^^"},
    {ForeignKind::operation, "not", "!", "write !"},

    {ForeignKind::name, "PI", "", use_turns},
    {ForeignKind::name, "pi", "", use_turns},
    {ForeignKind::name, "M_PI", "", use_turns},
    {ForeignKind::name, "TAU", "", use_turns},
    {ForeignKind::name, "P", "p", "the point of contact is p"},
    {ForeignKind::name, "N", "n", "the normal is n"},
    {ForeignKind::name, "position", "", "the point of contact is p"},
    {ForeignKind::name, "normal", "", "the normal is n"},
    {ForeignKind::name, "vUv", "uv", "the mesh coordinates are uv"},
    {ForeignKind::name, "fragCoord", "", "the point of contact is p, the mesh coordinates are uv"},
    {ForeignKind::name, "gl_FragCoord", "", "the point of contact is p, the mesh coordinates are uv"},
    {ForeignKind::name, "gl_FragColor", "", use_return},
    {ForeignKind::name, "fragColor", "", use_return},
    {ForeignKind::name, "Ci", "", use_return},
    {ForeignKind::name, "iTime", "time", "the time is time, in seconds"},

    {ForeignKind::qualifier, "static", "", leave_out},
    {ForeignKind::qualifier, "constexpr", "const", "write const"},
    {ForeignKind::qualifier, "inline", "", leave_out},
    {ForeignKind::qualifier, "highp", "", no_precision},
    {ForeignKind::qualifier, "mediump", "", no_precision},
    {ForeignKind::qualifier, "lowp", "", no_precision},
    {ForeignKind::qualifier, "precise", "", "leave it out; every operation is IEEE 754 as written"},
    {ForeignKind::qualifier, "invariant", "", leave_out},
    {ForeignKind::qualifier, "flat", "", leave_out},

    {ForeignKind::statement, "while", "", use_for},
    {ForeignKind::statement, "do", "", use_for},
    {ForeignKind::statement, "switch", "", use_if},
    {ForeignKind::statement, "case", "", use_if},
    {ForeignKind::statement, "default", "", use_if},
    {ForeignKind::statement, "discard", "", "a texture has a height everywhere: return 0.0"},
    {ForeignKind::statement, "continue", "", "put the rest of the loop's body into an if"},
    {ForeignKind::statement, "goto", "", use_if},

    {ForeignKind::declaration, "struct", "", no_struct},
    {ForeignKind::declaration, "class", "", no_struct},
    {ForeignKind::declaration, "union", "", no_struct},
    {ForeignKind::declaration, "enum", "", "write constants: const int ROUGH = 1;"},
    {ForeignKind::declaration, "typedef", "", no_struct},
    {ForeignKind::declaration, "uniform", "", use_parameter},
    {ForeignKind::declaration, "attribute", "", use_parameter},
    {ForeignKind::declaration, "varying", "", "the point of contact is p, its normal n, its mesh coordinates uv"},
    {ForeignKind::declaration, "layout", "", leave_out},
    {ForeignKind::declaration, "surface", "texture", use_texture, false},
    {ForeignKind::declaration, "displacement", "texture", use_texture, false},
    {ForeignKind::declaration, "shader", "texture", use_texture, false},
    {ForeignKind::declaration, "precision", "", no_precision},
    {ForeignKind::declaration, "using", "", leave_out},
    {ForeignKind::declaration, "namespace", "", leave_out},
    {ForeignKind::declaration, "template", "", "functions may take functions: float f(float basis(vec3), vec3 q)"},
};

// Types of several components: a word before the number of them, and perhaps one behind.
struct ForeignVector {
    std::string_view before, behind;
    bool is_real; // a vecN of ours; there are none of int, uint and bool
};
constexpr ForeignVector vectors[] = {
    {"float", "", true}, {"half", "", true},  {"double", "", true}, {"dvec", "", true},  {"vec", "f", true},
    {"vec", "h", true},  {"ivec", "", false}, {"uvec", "", false},  {"int", "", false},  {"uint", "", false},
    {"vec", "i", false}, {"vec", "u", false}, {"bvec", "", false},  {"bool", "", false},
};
// Square ones. Where they are made row by row, as in HLSL, ours are their transposes: not the same.
struct ForeignMatrix {
    std::string_view before;
    bool by_columns;
};
constexpr ForeignMatrix matrices[] = {
    {"float", false}, {"half", false}, {"double", false}, {"mat", true}, {"dmat", true}};

class Dictionary {
public:
    Dictionary()
    {
        for (const ForeignWord& known : words) by_word.emplace(known.word, known);
        constexpr std::string_view ours[][2] = {{"vec2", "mat2"}, {"vec3", "mat3"}, {"vec4", "mat4"}};
        constexpr std::string_view advice[][2] = {
            {"write vec2", "write mat2"}, {"write vec3", "write mat3"}, {"write vec4", "write mat4"}};
        for (size_t i = 0; i < std::size(ours); ++i) {
            const std::string size = std::to_string(i + 2);
            for (const ForeignVector& known : vectors) {
                const bool is_bool = known.before.starts_with('b');
                add(std::string(known.before) + size + std::string(known.behind), known.is_real ? ours[i][0] : "",
                    known.is_real ? advice[i][0]
                    : is_bool     ? no_bvec
                                  : no_ivec,
                    true);
            }
            for (const ForeignMatrix& known : matrices)
                add(std::string(known.before) + size + (known.before == "dmat" ? "" : "x" + size), ours[i][1],
                    advice[i][1], known.by_columns);
        }
    }

    const ForeignWord* find(ForeignKind kind, std::string_view word) const
    {
        const auto [first, last] = by_word.equal_range(word);
        const auto found = std::find_if(first, last, [&](const auto& known) { return known.second.kind == kind; });
        return found == last ? nullptr : &found->second;
    }

private:
    void add(std::string word, std::string_view replacement, std::string_view hint, bool is_exact)
    {
        const std::string_view kept = composed.emplace_back(std::move(word));
        by_word.emplace(kept, ForeignWord{ForeignKind::type, kept, replacement, hint, is_exact});
    }

    std::deque<std::string> composed; // stay where they are
    std::unordered_multimap<std::string_view, ForeignWord> by_word;
};

} // namespace

const ForeignWord* foreign_word(ForeignKind kind, std::string_view word)
{
    static const Dictionary dictionary;
    return dictionary.find(kind, word);
}

} // namespace haptel::lang
