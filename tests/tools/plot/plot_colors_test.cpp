// The maps' colours at eighths, as they are published (viridisLite 0.4, of the tables by van der Walt and Smith).
#include "tests/support/catch.h"
#include "tools/plot/plot_colors.h"

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>

using namespace haptel::tools::plot;

namespace {

void check(ColorMap map, const uint32_t (&rgb)[9], int slack)
{
    for (int i = 0; i < 9; ++i) {
        const Color color = map(i / 8.0);
        const double found[] = {color.red, color.green, color.blue};
        for (int channel = 0; channel < 3; ++channel) {
            const auto expected = static_cast<int>(rgb[i] >> (16 - 8 * channel) & 0xff);
            CAPTURE(i, channel);
            CHECK(std::abs(static_cast<int>(std::lround(255 * found[channel])) - expected) <= slack);
        }
    }
}

} // namespace

TEST_CASE("colours are those of the published maps, and what is no number is grey")
{
    check(magma, {0x000004, 0x1c1044, 0x4f127b, 0x812581, 0xb5367a, 0xe55064, 0xfb8761, 0xfec287, 0xfcfdbf}, 0);
    check(viridis, {0x440154, 0x472d7b, 0x3b528b, 0x2c728e, 0x21908c, 0x27ad81, 0x5dc863, 0xaadc32, 0xfde725}, 1);
    const Color none = magma(std::numeric_limits<double>::quiet_NaN());
    CHECK((none.red == none.green && none.green == none.blue));
}
