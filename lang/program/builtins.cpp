#include "lang/program/builtins.h"

#include <algorithm>

namespace haptel::lang {
namespace {

constexpr Builtin builtins[] = {
#define OPERATION(id, name, signatures, dimensions, op, doc)                                                           \
    {BuiltinId::id, name, signatures, dimensions, ir::Op::op, doc},
#define COMPOSED(id, name, signatures, dimensions, doc)                                                                \
    {BuiltinId::id, name, signatures, dimensions, std::nullopt, doc},
#include "lang/program/builtins.def"
};

Type type_of(char letter, uint8_t generic_size)
{
    switch (letter) {
    case 'I':
    case 'j': return vec(generic_size, Scalar::int_);
    case 'U':
    case 'k': return vec(generic_size, Scalar::uint_);
    case 'B':
    case 'l': return vec(generic_size, Scalar::bool_);
    case 'i': return int_type;
    case 'u': return uint_type;
    case 'b': return bool_type;
    case 't': return image_type;
    case '3': return vec(3);
    case 'g':
    case 'v': return vec(generic_size);
    case 'm': return mat(generic_size);
    }
    return float_type;
}

// "g(g,f)" for one size of g.
BuiltinOverload overload(const Builtin& builtin, std::string_view signature, uint8_t generic_size)
{
    BuiltinOverload made{&builtin, type_of(signature[0], generic_size), {}};
    for (char letter : signature.substr(1))
        if (letter != '(' && letter != ',' && letter != ')') made.parameters.push_back({type_of(letter, generic_size)});
    return made;
}

BuiltinOverloads expand_all()
{
    BuiltinOverloads all;
    for (const Builtin& builtin : builtins) {
        std::vector<BuiltinOverload>& overloads = all[builtin.name];
        for (std::string_view rest = builtin.signatures; !rest.empty();) {
            const std::string_view signature = rest.substr(0, rest.find(' '));
            rest.remove_prefix(std::min(rest.size(), signature.size() + 1));
            const bool generic = signature.find_first_of("gvmjklIUB") != std::string_view::npos;
            const bool scalars = signature.find_first_of("vmIUB") == std::string_view::npos;
            for (uint8_t size = scalars ? 1 : 2; size <= (generic ? 4 : 1); ++size) {
                BuiltinOverload made = overload(builtin, signature, size);
                // g(g,f) of a float is g(g,g) once more
                if (!std::ranges::count(overloads, made.parameters, &BuiltinOverload::parameters))
                    overloads.push_back(std::move(made));
            }
        }
    }
    return all;
}

} // namespace

std::span<const Builtin> all_builtins()
{
    return builtins;
}

const BuiltinOverloads& builtin_overloads()
{
    static const BuiltinOverloads all = expand_all();
    return all;
}

std::span<const BuiltinOverload> builtin_overloads(std::string_view name)
{
    const auto found = builtin_overloads().find(name);
    if (found == builtin_overloads().end()) return {};
    return found->second;
}

} // namespace haptel::lang
