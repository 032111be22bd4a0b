#include "lang/foreign.h"

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

constexpr ForeignWord words[] = {
    {ForeignKind::type, "float2", "vec2", "write vec2"},
    {ForeignKind::type, "float3", "vec3", "write vec3"},
    {ForeignKind::type, "float4", "vec4", "write vec4"},
    {ForeignKind::type, "half", "float", use_float},
    {ForeignKind::type, "half2", "vec2", "write vec2"},
    {ForeignKind::type, "half3", "vec3", "write vec3"},
    {ForeignKind::type, "half4", "vec4", "write vec4"},
    {ForeignKind::type, "double", "float", use_float},
    {ForeignKind::type, "dvec2", "vec2", use_float},
    {ForeignKind::type, "dvec3", "vec3", use_float},
    {ForeignKind::type, "dvec4", "vec4", use_float},
    {ForeignKind::type, "point", "vec3", "write vec3"},
    {ForeignKind::type, "vector", "vec3", "write vec3"},
    {ForeignKind::type, "color", "vec3", "write vec3"},
    {ForeignKind::type, "unsigned", "uint", "write uint"},
    {ForeignKind::type, "long", "int", "int has 32 bits and wraps"},
    {ForeignKind::type, "short", "int", "int has 32 bits and wraps"},
    {ForeignKind::type, "char", "int", "int has 32 bits and wraps"},
    {ForeignKind::type, "auto", "", "write the type: float, int, vec3 ..."},
    {ForeignKind::type, "var", "", "write the type: float, int, vec3 ..."},
    {ForeignKind::type, "let", "", "write the type: float, int, vec3 ..."},
    {ForeignKind::type, "bvec2", "", no_bvec},
    {ForeignKind::type, "bvec3", "", no_bvec},
    {ForeignKind::type, "bvec4", "", no_bvec},
    {ForeignKind::type, "ivec2", "", no_ivec},
    {ForeignKind::type, "ivec3", "", no_ivec},
    {ForeignKind::type, "ivec4", "", no_ivec},
    {ForeignKind::type, "uvec2", "", no_ivec},
    {ForeignKind::type, "uvec3", "", no_ivec},
    {ForeignKind::type, "uvec4", "", no_ivec},
    {ForeignKind::type, "int2", "", no_ivec},
    {ForeignKind::type, "int3", "", no_ivec},
    {ForeignKind::type, "int4", "", no_ivec},

    {ForeignKind::function, "lerp", "mix", "write mix"},
    {ForeignKind::function, "frac", "fract", "write fract"},
    {ForeignKind::function, "fmod", "mod", "write mod; the result has the sign of the divisor"},
    {ForeignKind::function, "saturate", "", "write clamp(x, 0.0, 1.0)"},
    {ForeignKind::function, "rsqrt", "inversesqrt", "write inversesqrt"},
    {ForeignKind::function, "atan2", "atan", "write atan with two arguments"},
    {ForeignKind::function, "mad", "fma", "write fma"},
    {ForeignKind::function, "fabs", "abs", "write abs"},
    {ForeignKind::function, "fmin", "min", "write min"},
    {ForeignKind::function, "fmax", "max", "write max"},
    {ForeignKind::function, "ln", "log", "write log"},
    {ForeignKind::function, "snoise", "perlin", "write perlin"},
    {ForeignKind::function, "cnoise", "perlin", "write perlin"},
    {ForeignKind::function, "lessThan", "", no_bvec},
    {ForeignKind::function, "lessThanEqual", "", no_bvec},
    {ForeignKind::function, "greaterThan", "", no_bvec},
    {ForeignKind::function, "greaterThanEqual", "", no_bvec},
    {ForeignKind::function, "any", "", no_bvec},
    {ForeignKind::function, "all", "", no_bvec},
    {ForeignKind::function, "dFdx", "", use_grad},
    {ForeignKind::function, "dFdy", "", use_grad},
    {ForeignKind::function, "fwidth", "", use_grad},
    {ForeignKind::function, "ddx", "", use_grad},
    {ForeignKind::function, "ddy", "", use_grad},

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
    {ForeignKind::declaration, "layout", "", "leave it out"},
    {ForeignKind::declaration, "precision", "", no_precision},
    {ForeignKind::declaration, "using", "", "leave it out"},
    {ForeignKind::declaration, "namespace", "", "leave it out"},
    {ForeignKind::declaration, "template", "", "functions may take functions: float f(float basis(vec3), vec3 q)"},
};

} // namespace

const ForeignWord* foreign_word(ForeignKind kind, std::string_view word)
{
    for (const ForeignWord& known : words) {
        if (known.kind == kind && known.word == word) return &known;
    }
    return nullptr;
}

} // namespace haptel::lang
