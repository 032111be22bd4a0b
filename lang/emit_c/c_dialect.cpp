#include "lang/emit_c/c_dialect.h"

#include "lang/emit/function.h"
#include "lang/emit_c/words.h"

namespace haptel::emit_c {

std::string CDialect::type(ir::Type type) const
{
    switch (type) {
    case ir::Type::real: return is_single ? "float" : "double";
    case ir::Type::i32:
    case ir::Type::u32: return "uint32_t";
    case ir::Type::boolean: return "int";
    case ir::Type::image: return "const haptel_image*";
    }
    return {};
}

std::string CDialect::fixed(ir::Type of) const
{
    return of == ir::Type::image ? type(of) + " const" : "const " + type(of);
}

uint64_t CDialect::bytes(ir::Type type) const
{
    return type == ir::Type::image || (type == ir::Type::real && !is_single) ? 8 : 4;
}

std::string CDialect::real(double value) const
{
    return literal(value, is_single);
}

std::string CDialect::read(ir::Input input) const
{
    return (is_single ? "(float)" : "") + emit::place_of(input, "point->", "values->head.");
}

std::string CDialect::read(const ir::Texture& texture, const ir::Parameter& parameter) const
{
    const std::string member = "values->" + member_name(texture, parameter);
    switch (parameter.type) {
    case ir::Type::real: return (is_single ? "(float)" : "") + member;
    case ir::Type::i32:
    case ir::Type::u32: return "(uint32_t)" + member;
    case ir::Type::boolean: return member + " != 0";
    case ir::Type::image: break;
    }
    return member;
}

std::string CDialect::table(ir::Type element, const std::string& name, uint32_t size, const std::string& cells) const
{
    return "static const " + type(element) + " " + name + "[" + std::to_string(size) + "] = {" + cells + "\n};";
}

} // namespace haptel::emit_c
