// Angles of any size as quarter turns: the product with so many bits of 2 / pi that all which count are exact.
#include "lang/math/elementary_constants.h"
#include "lang/math/elementary_pair.h"
#include "lang/math/two_over_pi.h"

#include <limits>

namespace haptel::ir::elementary {
namespace {

__extension__ using Wide = unsigned __int128;
using Real = Number<double>;

// 64 bits of them, from the bit of that number.
uint64_t bits_from(int first)
{
    const uint64_t* const word = two_over_pi_words + first / 64;
    const int shift = first % 64;
    return shift == 0 ? word[0] : word[0] << shift | word[1] >> (64 - shift);
}

Angle<Real> reduced(double angle)
{
    constexpr int fraction_bits = Format<double>::digits;
    const auto word = std::bit_cast<uint64_t>(angle);
    const uint64_t significand = (word & ((uint64_t{1} << fraction_bits) - 1)) | uint64_t{1} << fraction_bits;
    const int exponent = static_cast<int>(word >> fraction_bits) - Format<double>::bias - fraction_bits;
    // Bits of 2 / pi that would make multiples of 4 quarter turns are left out, and 192 are taken: in units of 2^-190
    // the product has its whole part in the two bits on top.
    const int first = exponent - 2 + 64;
    const Wide lowest = Wide{significand} * bits_from(first + 128), middle = Wide{significand} * bits_from(first + 64);
    const Wide carried = middle + (lowest >> 64);
    const uint64_t top = significand * bits_from(first) + static_cast<uint64_t>(carried >> 64);
    Wide fraction = Wide{top << 2 | static_cast<uint64_t>(carried) >> 62} << 64 |
                    (static_cast<uint64_t>(carried) << 2 | static_cast<uint64_t>(lowest) >> 62);
    uint64_t quarters = top >> 62;
    const bool is_beyond_half = fraction >> 127 != 0; // nearer to the next quarter
    if (is_beyond_half) {
        ++quarters;
        fraction = -fraction;
    }
    int zeros = 0; // no double is so near to a quarter that more than 62 are
    while (zeros < 127 && fraction >> (127 - zeros) == 0) ++zeros;
    fraction <<= zeros;
    constexpr int high_bits = 53;
    const auto high_part = static_cast<uint64_t>(fraction >> (128 - high_bits)),
               low_part = static_cast<uint64_t>(fraction << high_bits >> 64);
    const double sign = is_beyond_half ? -1 : 1;
    const Real high = std::ldexp(sign * static_cast<double>(high_part), -high_bits - zeros),
               low = std::ldexp(sign * static_cast<double>(low_part), -high_bits - 64 - zeros);
    // times pi / 2
    constexpr auto& quarter = Constants<double>::quarter_turn;
    const Pair<Real> part = halves(Pair<Real>{high, Real(0)});
    constexpr double upper = quarter_turn_upper, rest = (quarter[0] - upper) + quarter[1];
    const Real others = part.low * upper + (high * rest + low * upper);
    const Pair<Real> product = exact_sum_of_ordered(part.high * upper, others);
    return {static_cast<double>(quarters), product.high, product.low};
}

} // namespace

void reduce_huge_angles(const double* angles, uint32_t count, double* quarters, double* high, double* low)
{
    for (uint32_t i = 0; i < count; ++i) {
        constexpr double nan = std::numeric_limits<double>::quiet_NaN();
        Angle<Real> angle{0, nan, nan};
        if (angles[i] >= 0x1p20 && angles[i] <= Format<double>::largest) angle = reduced(angles[i]);
        quarters[i] = angle.quarters.value;
        high[i] = angle.high.value;
        low[i] = angle.low.value;
    }
}

} // namespace haptel::ir::elementary
