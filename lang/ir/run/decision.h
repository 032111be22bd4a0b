// The discrete part of what an operation decides, as a number: equal for two inputs that lie on one smooth piece.
#pragma once

#include "lang/ir/semantics.h"

#include <bit>

namespace haptel::ir {

template <typename T>
uint64_t decision(Op op, const Slot<T>& result, const Slot<T>& a, const Slot<T>& b)
{
    using std::floor;
    auto cell = [](const T& whole) { return std::bit_cast<uint64_t>(static_cast<double>(whole)); };
    auto side = [](const T& left, const T& right) -> uint64_t { return left < right ? 1 : right < left ? 2 : 3; };
    switch (op) {
    case Op::min:
    case Op::max: return side(a.real, b.real);
    case Op::abs: return side(a.real, T(0));
    case Op::sign:
    case Op::floor:
    case Op::ceil:
    case Op::trunc:
    case Op::round: return cell(result.real);
    case Op::fract: return cell(T(floor(a.real)));
    case Op::mod: return cell(T(floor(T(a.real / b.real))));
    case Op::length2:
    case Op::length3:
    case Op::length4: return side(result.real, T(0));
    case Op::atan2: return side(a.real, T(0)) * 4 + side(b.real, T(0));
    case Op::lt:
    case Op::le:
    case Op::eq:
    case Op::is_finite:
    case Op::r_to_i:
    case Op::r_to_u: return result.bits;
    // smooth, or decided by what is listed above
    case Op::add:
    case Op::sub:
    case Op::mul:
    case Op::div:
    case Op::neg:
    case Op::fma:
    case Op::sqrt:
    case Op::sin:
    case Op::cos:
    case Op::tan:
    case Op::sinturn:
    case Op::costurn:
    case Op::asin:
    case Op::acos:
    case Op::atan:
    case Op::sinh:
    case Op::cosh:
    case Op::tanh:
    case Op::asinh:
    case Op::acosh:
    case Op::atanh:
    case Op::exp:
    case Op::exp2:
    case Op::log:
    case Op::log2:
    case Op::pow:
    case Op::spline: // its pieces meet twice differentiably
    case Op::image_width:
    case Op::image_height:
    case Op::detach:
    case Op::ilt:
    case Op::ile:
    case Op::ieq:
    case Op::ult:
    case Op::ule:
    case Op::ueq:
    case Op::land:
    case Op::lor:
    case Op::lxor:
    case Op::lnot:
    case Op::select:
    case Op::iadd:
    case Op::isub:
    case Op::imul:
    case Op::idiv:
    case Op::irem:
    case Op::iand:
    case Op::ior:
    case Op::ixor:
    case Op::ishl:
    case Op::ishr:
    case Op::imin:
    case Op::imax:
    case Op::udiv:
    case Op::urem:
    case Op::ushr:
    case Op::umin:
    case Op::umax:
    case Op::i_to_r:
    case Op::u_to_r:
    case Op::i_as_u:
    case Op::u_as_i:
    case Op::b_to_i: return 0;
    }
    return 0;
}

} // namespace haptel::ir
