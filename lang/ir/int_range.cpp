#include "lang/ir/int_range.h"

#include <algorithm>
#include <bit>
#include <limits>

namespace haptel::ir {
namespace {

// Where a result may leave the type it wraps, and then it may be anything.
IntRange wrapped(IntRange range, Type type)
{
    IntRange full = full_range(type);
    return range.within(full.minimum, full.maximum) ? range : full;
}

// a * b, or the end of int64_t on its side: unsigned ends multiply to nearly 2^64.
int64_t saturating_product(int64_t a, int64_t b)
{
    int64_t result = 0;
    if (!__builtin_mul_overflow(a, b, &result)) return result;
    return (a < 0) == (b < 0) ? std::numeric_limits<int64_t>::max() : std::numeric_limits<int64_t>::min();
}

IntRange product(IntRange a, IntRange b)
{
    auto [low, high] =
        std::minmax({saturating_product(a.minimum, b.minimum), saturating_product(a.minimum, b.maximum),
                     saturating_product(a.maximum, b.minimum), saturating_product(a.maximum, b.maximum)});
    return {low, high};
}

// Smallest 2^n - 1 that is not below `value`, which is not negative.
int64_t all_ones_above(int64_t value)
{
    return static_cast<int64_t>(std::bit_ceil(static_cast<uint64_t>(value) + 1) - 1);
}

} // namespace

IntRange full_range(Type type)
{
    switch (type) {
    case Type::i32: return {INT32_MIN, INT32_MAX};
    case Type::u32: return {0, UINT32_MAX};
    case Type::boolean: return {0, 1};
    case Type::real:
    case Type::image: return {0, 0};
    }
    return {0, 0};
}

IntRange join(IntRange a, IntRange b)
{
    return {std::min(a.minimum, b.minimum), std::max(a.maximum, b.maximum)};
}

IntRange constant_range(Type type, uint32_t bits)
{
    const int64_t value = type == Type::i32 ? int64_t{static_cast<int32_t>(bits)} : int64_t{bits};
    return {value, value};
}

IntRange range_of_cells(const Table& table)
{
    if (table.words.empty()) return full_range(table.element);
    IntRange range = constant_range(table.element, table.words[0]);
    for (uint32_t word : table.words) range = join(range, constant_range(table.element, word));
    return range;
}

IntRange range_of(Op op, Type type, std::span<const IntRange> operands)
{
    const IntRange full = full_range(type);
    const IntRange a = operands.empty() ? full : operands[0], b = operands.size() < 2 ? full : operands[1];
    const bool positive = a.minimum >= 0 && b.minimum >= 0;
    if (op == Op::iadd) return wrapped({a.minimum + b.minimum, a.maximum + b.maximum}, type);
    if (op == Op::isub) return wrapped({a.minimum - b.maximum, a.maximum - b.minimum}, type);
    if (op == Op::imul) return wrapped(product(a, b), type);
    if (op == Op::idiv || op == Op::udiv) // a divisor of at least 1 only shrinks
        return b.minimum < 1 ? full
                             : IntRange{std::min(a.minimum / b.minimum, a.minimum / b.maximum),
                                        std::max(a.maximum / b.minimum, a.maximum / b.maximum)};
    if (op == Op::irem || op == Op::urem) {
        if (b.minimum < 1) return positive ? IntRange{0, a.maximum} : full;
        return {std::clamp<int64_t>(a.minimum, 1 - b.maximum, 0), std::clamp<int64_t>(a.maximum, 0, b.maximum - 1)};
    }
    if (op == Op::iand) {
        if (positive) return {0, std::min(a.maximum, b.maximum)};
        if (a.minimum >= 0) return {0, a.maximum};
        if (b.minimum >= 0) return {0, b.maximum};
    }
    if ((op == Op::ior || op == Op::ixor) && positive) return {0, all_ones_above(std::max(a.maximum, b.maximum))};
    if (op == Op::ishl && b.is_constant() && b.within(0, 31))
        return wrapped(product(a, {int64_t{1} << b.minimum, int64_t{1} << b.minimum}), type);
    if ((op == Op::ishr || op == Op::ushr) && b.is_constant() && b.within(0, 31))
        return {a.minimum >> b.minimum, a.maximum >> b.minimum};
    if (op == Op::imin || op == Op::umin) return {std::min(a.minimum, b.minimum), std::min(a.maximum, b.maximum)};
    if (op == Op::imax || op == Op::umax) return {std::max(a.minimum, b.minimum), std::max(a.maximum, b.maximum)};
    if (op == Op::i_as_u || op == Op::u_as_i) return wrapped(a, type);
    if (op == Op::b_to_i) return a;
    if (op == Op::image_width || op == Op::image_height) return {1, full.maximum};
    if (op == Op::select) return join(b, operands[2]);
    return full;
}

} // namespace haptel::ir
