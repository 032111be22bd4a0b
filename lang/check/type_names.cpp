// What types the names in source mean, and what is said of a name that means none.
#include "lang/check/body_checker.h"
#include "lang/syntax/grammar.h"

#include <map>

namespace haptel::lang {

using namespace ast;

std::optional<Type> type_named(std::string_view name)
{
    static const auto types = [] {
        std::map<std::string, Type, std::less<>> by_name;
        const auto add = [&](Type type) { by_name.emplace(to_string(type), type); };
        for (const Scalar of : {Scalar::float_, Scalar::int_, Scalar::uint_, Scalar::bool_})
            for (uint8_t size = 1; size <= 4; ++size) add(vec(size, of));
        for (const Type type : {mat(2), mat(3), mat(4), image_type, void_type}) add(type);
        return by_name;
    }();
    const auto found = types.find(name);
    return found == types.end() ? std::nullopt : std::optional(found->second);
}

Type resolve_type(CheckContext& context, const TypeName& name)
{
    if (name.base.text.empty()) return Type::error(); // the parser has said why
    if (const auto type = type_named(name.base.text)) return *type;
    const FileScope* scope = context.scopes ? &scope_of(context, name.base.span.file) : nullptr;
    if (StructDeclaration* declared = scope ? scope->structure(name.base.text) : nullptr)
        return type_of_struct(context, *declared, name.base.span);
    if (scope && scope->is_unread(name.base.text)) return Type::error(); // told
    Diagnostic& reported =
        context.diagnostics.error(name.base.span, "unknown-type", "unknown type " + quoted(name.base.text));
    if (name.base.text == any_size) {
        reported.hint = "vecN is vec2 and vec3 in a function that has a parameter of it: float f(vecN q)";
        return Type::error();
    }
    reported.hint = "types are float, int, uint, bool, vec2, vec3, vec4 (ivec2, uvec2, bvec2 ...), mat2, mat3 and mat4";
    if (name.base.text.starts_with("mat") && name.base.text.find('x') != std::string::npos)
        reported.hint = "matrices are square: mat2, mat3 and mat4";
    else {
        std::vector<std::string> names(std::begin(own_types), std::end(own_types));
        for (size_t i = 0; scope && i < scope->layers.size(); ++i)
            for (const auto& [known, declared] : scope->layers[i]->structs) names.push_back(known);
        if (scope)
            for (const auto& [prefix, behind] : scope->by_prefix)
                if (behind)
                    for (const auto& [known, declared] : behind->structs) names.push_back(prefix + "." + known);
        propose(reported, name.base.span, near_name(name.base.text, {names.begin(), names.end()}));
    }
    return Type::error();
}

Type value_type(CheckContext& context, const TypeName& name, const std::string& why, bool may_be_image)
{
    const Type type = resolve_type(context, name);
    if (type == image_type && !may_be_image)
        context.diagnostics.error(
            name.base.span, "image", "an image is a parameter of a texture or of a function, and nothing else",
            "pass it on as it is: float bark(image picture, vec2 q) { return sample(picture, q); }");
    else if (type == void_type)
        context.diagnostics.error(name.base.span, "type-mismatch", why + ", found void", "write float, int, vec3 ...");
    else
        return type;
    return Type::error();
}

} // namespace haptel::lang
