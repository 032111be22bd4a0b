// One operation as C99 and GLSL write it: alike but for a few words and signs, which are the dialect's.
#include "lang/emit/dialect.h"

#include "lang/ir/op_info.h"

namespace haptel::emit {

namespace {

std::string called(const std::string& function, std::span<const std::string> operands)
{
    std::string call = function + "(";
    for (const std::string& operand : operands) call += (call.back() == '(' ? "" : ", ") + operand;
    return call + ")";
}

} // namespace

std::string Dialect::expression(ir::Op op, std::span<const std::string> operands) const
{
    using ir::Op;
    const std::string& a = operands.front();
    const std::string& b = operands.size() > 1 ? operands[1] : a;
    const OperationWords words = operation_words();
    const auto infix = [&](const char* sign) { return a + sign + b; };
    const auto as_signed = [&](const std::string& word) { return cast(ir::Type::i32, word); };
    const auto is_signed = [&](const char* sign) { return as_signed(a) + sign + as_signed(b); };
    const auto of_math = [&](const char* function) { return called(function + std::string(words.suffix), operands); };
    const auto helper = [&] { return called("haptel_" + std::string(ir::op_info(op).name), operands); };
    switch (op) {
    case Op::add:
    case Op::iadd: return infix(" + ");
    case Op::sub:
    case Op::isub: return infix(" - ");
    case Op::mul:
    case Op::imul: return infix(" * ");
    case Op::div: return infix(" / ");
    case Op::neg: return "-" + a;
    case Op::fma: return words.has_fma ? of_math("fma") : a + " * " + b + " + " + operands[2];
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
    case Op::is_finite: return words.has_fma ? a + " - " + a + " == 0" : helper();
    case Op::abs: return of_math(words.abs);
    case Op::floor: return of_math("floor");
    case Op::ceil: return of_math("ceil");
    case Op::trunc: return of_math("trunc");
    case Op::round: return of_math(words.round);
    case Op::fract: return a + " - " + of_math("floor");
    case Op::sqrt: return of_math("sqrt");
    case Op::lt:
    case Op::ult: return infix(" < ");
    case Op::le:
    case Op::ule: return infix(" <= ");
    case Op::eq:
    case Op::ieq:
    case Op::ueq: return infix(" == ");
    case Op::ilt: return is_signed(" < ");
    case Op::ile: return is_signed(" <= ");
    case Op::iand: return infix(" & ");
    case Op::ior: return infix(" | ");
    case Op::ixor: return infix(" ^ ");
    case Op::land: return infix(words.both);
    case Op::lor: return infix(words.either);
    case Op::lxor: return infix(words.one_of);
    case Op::lnot: return "!" + a;
    case Op::select: return a + " ? " + b + " : " + operands[2];
    case Op::ishl: return a + " << (" + b + " & 31u)";
    case Op::ishr: return cast(ir::Type::u32, "(" + as_signed(a) + " >> (" + b + " & 31u))");
    case Op::ushr: return a + " >> (" + b + " & 31u)";
    case Op::imin: return is_signed(" < ") + " ? " + a + " : " + b;
    case Op::imax: return is_signed(" < ") + " ? " + b + " : " + a;
    case Op::udiv: return b + " == 0u ? 0u : " + a + " / " + b;
    case Op::urem: return b + " == 0u ? 0u : " + a + " % " + b;
    case Op::umin: return infix(" < ") + " ? " + a + " : " + b;
    case Op::umax: return infix(" < ") + " ? " + b + " : " + a;
    case Op::i_to_r: return cast(ir::Type::real, as_signed(a));
    case Op::u_to_r: return cast(ir::Type::real, a);
    case Op::i_as_u:
    case Op::u_as_i:
    case Op::detach: return a;
    case Op::b_to_i: return cast(ir::Type::u32, a);
    }
    return a;
}

} // namespace haptel::emit
