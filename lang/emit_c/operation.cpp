#include "lang/emit_c/c_dialect.h"

#include "lang/ir/op_info.h"

namespace haptel::emit_c {

std::string CDialect::expression(ir::Op op, std::span<const std::string> operands) const
{
    using ir::Op;
    const std::string& a = operands.front();
    const std::string& b = operands.size() > 1 ? operands[1] : a;
    const auto infix = [&](const char* sign) { return a + sign + b; };
    const auto is_signed = [&](const char* sign) { return "(int32_t)" + a + sign + "(int32_t)" + b; };
    const auto called = [&](const std::string& function) {
        std::string call = function + "(";
        for (const std::string& operand : operands) call += (call.back() == '(' ? "" : ", ") + operand;
        return call + ")";
    };
    const auto of_math = [&](const std::string& function) { return called(is_single ? function + "f" : function); };
    const auto helper = [&] { return called("haptel_" + std::string(ir::op_info(op).name)); };
    const std::string real = is_single ? "(float)" : "(double)";
    switch (op) {
    case Op::add: return infix(" + ");
    case Op::sub: return infix(" - ");
    case Op::mul: return infix(" * ");
    case Op::div: return infix(" / ");
    case Op::neg: return "-" + a;
    case Op::fma: return of_math("fma");
    case Op::min:
    case Op::max:
    case Op::sign:
    case Op::mod:
    case Op::length2:
    case Op::length3:
    case Op::length4:
    case Op::sinturn:
    case Op::costurn:
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
        return helper();
    case Op::abs: return of_math("fabs");
    case Op::floor: return of_math("floor");
    case Op::ceil: return of_math("ceil");
    case Op::trunc: return of_math("trunc");
    case Op::round: return of_math("nearbyint");
    case Op::fract: return a + " - " + of_math("floor");
    case Op::sqrt: return of_math("sqrt");
    case Op::lt: return infix(" < ");
    case Op::le: return infix(" <= ");
    case Op::eq: return infix(" == ");
    case Op::is_finite: return a + " - " + a + " == 0";
    case Op::ilt: return is_signed(" < ");
    case Op::ile: return is_signed(" <= ");
    case Op::ieq:
    case Op::ueq: return infix(" == ");
    case Op::ult: return infix(" < ");
    case Op::ule: return infix(" <= ");
    case Op::iand:
    case Op::land: return infix(" & ");
    case Op::ior:
    case Op::lor: return infix(" | ");
    case Op::ixor:
    case Op::lxor: return infix(" ^ ");
    case Op::lnot: return "!" + a;
    case Op::select: return a + " ? " + b + " : " + operands[2];
    case Op::iadd: return infix(" + ");
    case Op::isub: return infix(" - ");
    case Op::imul: return infix(" * ");
    case Op::ishl: return a + " << (" + b + " & 31u)";
    case Op::ishr: return "(uint32_t)((int32_t)" + a + " >> (" + b + " & 31u))";
    case Op::ushr: return a + " >> (" + b + " & 31u)";
    case Op::imin: return is_signed(" < ") + " ? " + a + " : " + b;
    case Op::imax: return is_signed(" < ") + " ? " + b + " : " + a;
    case Op::udiv: return b + " == 0 ? 0 : " + a + " / " + b;
    case Op::urem: return b + " == 0 ? 0 : " + a + " % " + b;
    case Op::umin: return infix(" < ") + " ? " + a + " : " + b;
    case Op::umax: return infix(" < ") + " ? " + b + " : " + a;
    case Op::i_to_r: return real + "(int32_t)" + a;
    case Op::u_to_r: return real + a;
    case Op::i_as_u:
    case Op::u_as_i:
    case Op::detach: return a;
    case Op::b_to_i: return "(uint32_t)" + a;
    }
    return a;
}

} // namespace haptel::emit_c
