#include "lang/program/builtins.h"

#include <algorithm>
#include <map>

namespace haptel::lang {
namespace {

constexpr Builtin builtins[] = {
#define OPERATION(id, name, signatures, dimensions, op, doc) {BuiltinId::id, name, dimensions, ir::Op::op, doc},
#define COMPOSED(id, name, signatures, dimensions, doc) {BuiltinId::id, name, dimensions, std::nullopt, doc},
#include "lang/program/builtins.def"
#undef OPERATION
#undef COMPOSED
};

constexpr std::string_view signatures[] = {
#define OPERATION(id, name, signatures, ...) signatures,
#define COMPOSED(id, name, signatures, ...) signatures,
#include "lang/program/builtins.def"
#undef OPERATION
#undef COMPOSED
};

Type type_of(char letter, uint8_t generic_size)
{
    switch (letter) {
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

using Overloads = std::map<std::string_view, std::vector<BuiltinOverload>>;

Overloads expand_all()
{
    Overloads all;
    for (size_t i = 0; i < std::size(builtins); ++i) {
        std::vector<BuiltinOverload>& overloads = all[builtins[i].name];
        for (std::string_view rest = signatures[i]; !rest.empty();) {
            std::string_view signature = rest.substr(0, rest.find(' '));
            rest.remove_prefix(std::min(rest.size(), signature.size() + 1));
            const bool generic = signature.find_first_of("gvm") != std::string_view::npos;
            const bool scalars = signature.find_first_of("vm") == std::string_view::npos;
            for (uint8_t size = scalars ? 1 : 2; size <= (generic ? 4 : 1); ++size) {
                BuiltinOverload made = overload(builtins[i], signature, size);
                // g(g,f) of a float is g(g,g) once more
                const bool known = std::any_of(overloads.begin(), overloads.end(), [&](const BuiltinOverload& other) {
                    return other.parameters == made.parameters;
                });
                if (!known) overloads.push_back(std::move(made));
            }
        }
    }
    return all;
}

const Overloads& overloads_by_name()
{
    static const Overloads all = expand_all();
    return all;
}

} // namespace

std::span<const Builtin> all_builtins()
{
    return builtins;
}

std::span<const BuiltinOverload> builtin_overloads(std::string_view name)
{
    const auto found = overloads_by_name().find(name);
    if (found == overloads_by_name().end()) return {};
    return found->second;
}

const std::vector<std::string_view>& builtin_names()
{
    static const std::vector<std::string_view> names = [] {
        std::vector<std::string_view> made;
        for (const auto& [name, overloads] : overloads_by_name()) made.push_back(name);
        return made;
    }();
    return names;
}

} // namespace haptel::lang
