// The discrete part of what an operation decides, as a number: equal for two inputs that lie on one smooth piece.
#pragma once

#include "lang/ir/op_info.h"
#include "lang/ir/semantics.h"

#include <bit>

namespace haptel::ir {

template <typename T>
uint64_t decision(Op op, const Slot<T>& result, const Slot<T>& a, const Slot<T>& b)
{
    using std::floor;
    auto cell = [](const T& whole) { return std::bit_cast<uint64_t>(static_cast<double>(whole)); };
    auto side = [](const T& left, const T& right) -> uint64_t { return left < right ? 1 : right < left ? 2 : 3; };
    switch (traits(op).decides) {
    case Decision::nothing: return 0;
    case Decision::order: return side(a.real, b.real);
    case Decision::side: return side(a.real, T(0));
    case Decision::whole: return cell(result.real);
    case Decision::cell: return cell(T(floor(a.real)));
    case Decision::cell_of_quotient: return cell(T(floor(T(a.real / b.real))));
    case Decision::tip: return side(result.real, T(0));
    case Decision::quadrant: return side(a.real, T(0)) * 4 + side(b.real, T(0));
    case Decision::truth: return result.bits;
    }
    return 0;
}

} // namespace haptel::ir
