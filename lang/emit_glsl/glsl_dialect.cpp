#include "lang/emit_glsl/glsl_dialect.h"

#include "lang/emit/function.h"
#include "lang/emit_glsl/names.h"
#include "lang/ir/op_info.h"

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

std::string GlslDialect::expression(ir::Op op, std::span<const std::string> operands) const
{
    using ir::Op;
    const std::string& a = operands.front();
    const std::string& b = operands.size() > 1 ? operands[1] : a;
    const auto infix = [&](const char* sign) { return a + sign + b; };
    const auto is_signed = [&](const char* sign) { return "int(" + a + ")" + sign + "int(" + b + ")"; };
    const auto called = [&](const std::string& function) {
        std::string call = function + "(";
        for (const std::string& operand : operands) call += (call.back() == '(' ? "" : ", ") + operand;
        return call + ")";
    };
    switch (op) {
    case Op::add: return infix(" + ");
    case Op::sub: return infix(" - ");
    case Op::mul: return infix(" * ");
    case Op::div: return infix(" / ");
    case Op::neg: return "-" + a;
    case Op::fma: return a + " * " + b + " + " + operands[2];
    case Op::min:
    case Op::max:
    case Op::sign:
    case Op::mod:
    case Op::length2:
    case Op::length3:
    case Op::length4:
    case Op::sinturn:
    case Op::costurn:
    case Op::is_finite:
    case Op::r_to_i:
    case Op::r_to_u:
    case Op::idiv:
    case Op::irem:
    case Op::spline:
    case Op::image_channel:
    case Op::image_coarser:
    case Op::image_width:
    case Op::image_height:
#define ELEMENTARY(name, ...) case Op::name:
#include "lang/ir/ops.def"
        return called("haptel_" + std::string(ir::op_info(op).name));
    case Op::abs: return called("abs");
    case Op::floor: return called("floor");
    case Op::ceil: return called("ceil");
    case Op::trunc: return called("trunc");
    case Op::round: return called("roundEven");
    case Op::fract: return a + " - floor(" + a + ")";
    case Op::sqrt: return called("sqrt");
    case Op::lt: return infix(" < ");
    case Op::le: return infix(" <= ");
    case Op::eq: return infix(" == ");
    case Op::ilt: return is_signed(" < ");
    case Op::ile: return is_signed(" <= ");
    case Op::ieq:
    case Op::ueq: return infix(" == ");
    case Op::ult: return infix(" < ");
    case Op::ule: return infix(" <= ");
    case Op::iand: return infix(" & ");
    case Op::ior: return infix(" | ");
    case Op::ixor: return infix(" ^ ");
    case Op::land: return infix(" && ");
    case Op::lor: return infix(" || ");
    case Op::lxor: return infix(" ^^ ");
    case Op::lnot: return "!" + a;
    case Op::select: return a + " ? " + b + " : " + operands[2];
    case Op::iadd: return infix(" + ");
    case Op::isub: return infix(" - ");
    case Op::imul: return infix(" * ");
    case Op::ishl: return a + " << (" + b + " & 31u)";
    case Op::ishr: return "uint(int(" + a + ") >> (" + b + " & 31u))";
    case Op::ushr: return a + " >> (" + b + " & 31u)";
    case Op::imin: return is_signed(" < ") + " ? " + a + " : " + b;
    case Op::imax: return is_signed(" < ") + " ? " + b + " : " + a;
    case Op::udiv: return b + " == 0u ? 0u : " + a + " / " + b;
    case Op::urem: return b + " == 0u ? 0u : " + a + " % " + b;
    case Op::umin: return infix(" < ") + " ? " + a + " : " + b;
    case Op::umax: return infix(" < ") + " ? " + b + " : " + a;
    case Op::i_to_r: return "float(int(" + a + "))";
    case Op::u_to_r: return called("float");
    case Op::i_as_u:
    case Op::u_as_i:
    case Op::detach: return a;
    case Op::b_to_i: return called("uint");
    }
    return a;
}

} // namespace haptel::emit_glsl
