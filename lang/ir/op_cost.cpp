#include "lang/ir/op_cost.h"

#include "lang/math/spline.h"

#include <algorithm>

namespace haptel::ir {
namespace {

// A number that counts what is done to it.
struct Counted {
    double value = 0;
    static inline thread_local uint64_t operations = 0;

    Counted() = default;
    explicit Counted(double number) : value(number) {}
    explicit operator double() const { return value; }

    static Counted done(double number)
    {
        ++operations;
        return Counted(number);
    }
    static bool compared(bool outcome)
    {
        ++operations;
        return outcome;
    }
    friend Counted operator+(Counted a, Counted b) { return done(a.value + b.value); }
    friend Counted operator-(Counted a, Counted b) { return done(a.value - b.value); }
    friend Counted operator*(Counted a, Counted b) { return done(a.value * b.value); }
    friend Counted operator/(Counted a, Counted b) { return done(a.value / b.value); }
    friend Counted operator-(Counted a) { return done(-a.value); }
    friend bool operator<(Counted a, Counted b) { return compared(a.value < b.value); }
    friend bool operator>(Counted a, Counted b) { return compared(a.value > b.value); }
    friend bool operator==(Counted a, Counted b) { return compared(a.value == b.value); }
    friend Counted floor(Counted a) { return done(std::floor(a.value)); }
};

uint64_t counted_spline()
{
    const double texels[9] = {};
    const haptel_image image{{texels, texels, texels}, 1, 1};
    uint64_t worst = 0;
    for (uint32_t edge = 0; edge < spline_edges; ++edge)
        for (uint32_t by_x = 0; by_x <= 3; ++by_x)
            for (uint32_t by_y = 0; by_x + by_y <= 3; ++by_y) {
                Counted::operations = 0;
                spline(&image, Counted(0.5), Counted(0.5), spline_order(by_x, by_y, edge));
                worst = std::max(worst, Counted::operations);
            }
    const uint64_t places = 2 * spline_support, reads = spline_support * spline_support;
    return worst + places + reads;
}

} // namespace

uint64_t operations_of(Op op)
{
    static const uint64_t of_spline = counted_spline();
    return op == Op::spline ? of_spline : 1;
}

} // namespace haptel::ir
