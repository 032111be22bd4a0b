#include "tests/stdlib/facts.h"

#include "tests/support/catch.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace haptel::test {

namespace {

double length(const Vec3& v)
{
    return std::hypot(v[0], v[1], v[2]);
}

} // namespace

ir::Facts facts_of(const std::string& function, const std::string& call)
{
    const jit::CompiledTextures compiled =
        jit::compile_texture("texture t() { vec3 q = p / 1m; return 1m * " + call + "; }");
    REQUIRE(compiled.program);
    // made anew for its caller, a function that asks for its footprint is called "resolved f(vec3) [...]"
    const std::string resolved = "resolved " + function;
    for (const ir::Function& candidate : compiled.program->module().functions) {
        const std::string name = candidate.name.substr(0, candidate.name.find(" ["));
        if (name == function || name == resolved) return candidate.facts.at(0);
    }
    FAIL("no function " << function);
    return {};
}

void check_never_exceeded(const std::string& call, const ir::Facts& facts, double size, int count, double rounding)
{
    CAPTURE(call);
    const Field field(call);
    double least = INFINITY, most = -INFINITY, slope = 0, curvature = 0;
    const double step = 1e-4;
    for (const Vec3& q : points_within(size, count)) {
        const FieldSample here = field(q), beside = field({q[0] + step, q[1] - step, q[2] + step});
        least = std::min(least, here.value);
        most = std::max(most, here.value);
        slope = std::max(slope, length(here.gradient));
        const Vec3 change{beside.gradient[0] - here.gradient[0], beside.gradient[1] - here.gradient[1],
                          beside.gradient[2] - here.gradient[2]};
        curvature = std::max(curvature, length(change) / (step * std::sqrt(3.0)));
    }
    CHECK((!facts.value_minimum || least >= *facts.value_minimum));
    CHECK((!facts.value_maximum || most <= *facts.value_maximum));
    CHECK((!facts.slope || slope <= *facts.slope * (1 + rounding)));
    CHECK((!facts.curvature || curvature <= *facts.curvature * (1 + 1e-9)));
}

double supremum(size_t dimensions, double minimum, double maximum, const DirectedFunction& function)
{
    std::mt19937_64 random(5);
    const auto uniform = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
    const auto unit = [&](Vec3 v) {
        const double length = std::hypot(v[0], v[1], v[2]);
        return Vec3{v[0] / length, v[1] / length, v[2] / length};
    };
    double best = 0;
    for (int start = 0; start < 40; ++start) {
        Vec3 x{}, e{};
        for (size_t a = 0; a < dimensions; ++a) {
            x[a] = minimum + (maximum - minimum) * uniform();
            e[a] = uniform() - 0.5;
        }
        e = unit(e);
        double found = function(x, e);
        for (double step = 0.3; step > 1e-7;) {
            bool better = false;
            for (int attempt = 0; attempt < 30; ++attempt) {
                Vec3 y = x, f = e;
                for (size_t a = 0; a < dimensions; ++a) {
                    y[a] = std::clamp(x[a] + step * (2 * uniform() - 1), minimum, maximum);
                    f[a] += step * (2 * uniform() - 1);
                }
                f = unit(f);
                const double there = function(y, f);
                if (there > found) {
                    found = there;
                    x = y;
                    e = f;
                    better = true;
                }
            }
            if (!better) step /= 2;
        }
        best = std::max(best, found);
    }
    return best;
}

} // namespace haptel::test
