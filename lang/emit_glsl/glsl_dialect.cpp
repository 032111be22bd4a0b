#include "lang/emit_glsl/glsl_dialect.h"

#include "lang/emit/function.h"
#include "lang/emit_glsl/names.h"

namespace haptel::emit_glsl {

std::string GlslDialect::type(ir::Type type) const
{
    switch (type) {
    case ir::Type::real: return "float";
    case ir::Type::i32:
    case ir::Type::u32: return "uint";
    case ir::Type::boolean: return "bool";
    case ir::Type::image: return "int";
    }
    return {};
}

std::string GlslDialect::real(double value) const
{
    return literal(value);
}

std::string GlslDialect::read(ir::Input input) const
{
    return emit::place_of(input, "point.", "values.head.");
}

std::string GlslDialect::read(const ir::Texture& texture, const ir::Parameter& parameter) const
{
    const auto index = static_cast<size_t>(&parameter - texture.parameters.data());
    const std::string member = "values." + member_names(texture)[index];
    return parameter.type == ir::Type::i32 ? "uint(" + member + ")" : member;
}

std::string GlslDialect::table(ir::Type element, const std::string& name, uint32_t size, const std::string& cells) const
{
    const std::string array = type(element) + "[" + std::to_string(size) + "]";
    return "const " + type(element) + " " + name + "[" + std::to_string(size) + "] = " + array + "(" + cells + ");";
}

} // namespace haptel::emit_glsl
