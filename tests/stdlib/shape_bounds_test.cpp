// The facts that the library states about shapes, tiles and marks.
#include "tests/stdlib/facts.h"
#include "tests/support/catch.h"

#include <algorithm>
#include <cmath>
#include <random>

using namespace haptel;
using namespace haptel::test;

namespace {

// What one mark, or several, leave of 1, with slope and curvature at most.
struct Mark {
    double left, slope, curvature;
};

Mark both(const Mark& a, const Mark& b) // by the product rule
{
    return {a.left * b.left, a.slope * b.left + a.left * b.slope,
            a.curvature * b.left + 2 * a.slope * b.slope + a.left * b.curvature};
}

} // namespace

TEST_CASE("no fact of a shape, a tile or a mark is exceeded anywhere")
{
    const auto check = [](const std::string& function, const std::string& call, double size) {
        check_never_exceeded(call, facts_of(function, call), size, 20'000, 1e-15);
    };
    check("sd_circle(vec2,float)", "sd_circle(q.xy, 0.7)", 2);
    check("sd_sphere(vec3,float)", "sd_sphere(q, 0.7)", 2);
    check("sd_ring(vec2,float,float)", "sd_ring(q.xy, 0.7, 0.2)", 2);
    check("sd_torus(vec3,float,float)", "sd_torus(q, 0.7, 0.2)", 2);
    for (const std::string rounding : {"0.0", "0.2", "9.0"}) {
        check("sd_box(vec2,vec2,float)", "sd_box(q.xy, vec2(0.7, 0.4), " + rounding + ")", 2);
        check("sd_box(vec3,vec3,float)", "sd_box(q, vec3(0.7, 0.4, 0.9), " + rounding + ")", 2);
    }
    check("sd_box(vec2,vec2)", "sd_box(q.xy, vec2(0.7, -0.4))", 2);
    check("sd_box(vec3,vec3)", "sd_box(q, vec3(0.7, 0.4, 0.9))", 2);
    check("sd_segment(vec2,vec2,vec2)", "sd_segment(q.xy, vec2(-0.7, 0.4), vec2(1.0))", 2);
    check("sd_segment(vec3,vec3,vec3)", "sd_segment(q, vec3(-0.7, 0.4, 0.0), vec3(1.0))", 2);
    check("sd_capsule(vec2,vec2,vec2,float)", "sd_capsule(q.xy, vec2(-0.7, 0.4), vec2(1.0), 0.2)", 2);
    check("sd_capsule(vec3,vec3,vec3,float)", "sd_capsule(q, vec3(-0.7, 0.4, 0.0), vec3(1.0), 0.2)", 2);
    check("sd_hexagon(vec2,float)", "sd_hexagon(q.xy, 0.7)", 2);
    check("sd_polygon(vec2,int,float)", "sd_polygon(q.xy, 5, 0.7)", 2);
    for (const std::string inner : {"-1.0", "0.0", "0.3", "2.0"})
        check("sd_star(vec2,int,float,float)", "sd_star(q.xy, 5, 1.0, " + inner + ")", 2);
    check("sd_union(float,float,float)", "sd_union(q.x, 0.4, 0.3)", 2);
    check("sd_intersection(float,float,float)", "sd_intersection(q.x, 0.4, 0.3)", 2);
    check("sd_subtraction(float,float,float)", "sd_subtraction(q.x, 0.4, 0.3)", 2);
    check("outline(float,float)", "outline(q.x, 0.4)", 2);
    for (const std::string size : {"-1.0", "0.0", "0.6"}) {
        check("hexagon_rim(vec2,float)", "hexagon_rim(q.xy, " + size + ")", 2);
        check("groove_profile(vec2,float,float)", "groove_profile(q.xy, 0.1, " + size + ")", 2);
        check("ridge_round(vec2,float)", "ridge_round(q.xy, 0.4 + " + size + ")", 3);
    }
    check("rim_profile(vec2)", "rim_profile(q.xy)", 2);
    check("tile(vec2,float,float)", "tile(q.xy, 0.1, 0.2)", 5);
    check("brick(vec2,float,float,float)", "brick(q.xy, 3.0, 0.1, 0.2)", 5);
    check("plank(vec2,float,float,float,int)", "plank(q.xy, 3.0, 0.1, 0.2, 7)", 5);
    check("herringbone(vec2,float,float)", "herringbone(q.xy, 0.1, 0.2)", 5);
    check("hex_tile(vec2,float,float)", "hex_tile(q.xy, 0.1, 0.2)", 5);
    check("truchet(vec2,float,int)", "truchet(q.xy, 0.3, 7)", 5);
    check("knit(vec2)", "knit(q.xy)", 5);
    check("splat_near(vec2,int,int,float,uint)", "splat_near(q.xy, 3, 7, 0.5, 9u)", 2.5);
    check("splat(vec2,float,int)", "splat(q.xy, 0.5, 7)", 20);
    check("scratches_near(vec2,int,int,float,float,uint)", "scratches_near(q.xy, 3, 7, 0.25, 0.75, 9u)", 6);
    check("scratches(vec2,float,float,int)", "scratches(q.xy, 0.3, 2.0, 7)", 20);
}

TEST_CASE("the facts of marks are the supremum over where they lie and how large they are, rounded up")
{
    const auto marks = [](bool is_narrow_as_low) { // or it is as wide as any
        std::vector<Mark> all;
        for (int i = 0; i <= 1000; ++i)
            for (const double high : {0.4, 0.7, 1.0}) {
                const double s = i / 1000.0, w = 1 - s * s, narrow = is_narrow_as_low ? 1 / high : 1;
                const double bent = std::max(6 * w * w, std::fabs(24 * s * s * w - 6 * w * w));
                all.push_back({1 - high * w * w * w, high * narrow * 6 * s * w * w, high * narrow * narrow * bent});
            }
        return all;
    };
    // One at a time is exchanged for the worst, from random starts.
    const auto supremum = [](const std::vector<Mark>& all, size_t count, double Mark::* which) {
        std::mt19937_64 random(3);
        double best = 0;
        for (int start = 0; start < 20; ++start) {
            std::vector<Mark> chosen;
            for (size_t i = 0; i < count; ++i) chosen.push_back(all[random() % all.size()]);
            for (double before = -1, found = 0; found > before; best = std::max(best, found)) {
                before = found;
                for (Mark& mark : chosen) {
                    Mark others{1, 0, 0};
                    for (const Mark& other : chosen)
                        if (&other != &mark) others = both(others, other);
                    for (const Mark& trial : all)
                        if (both(others, trial).*which > found) found = both(others, trial).*which, mark = trial;
                }
            }
        }
        return best;
    };
    const auto check = [&](const std::string& function, const std::string& call, bool is_narrow_as_low, size_t count) {
        const ir::Facts facts = facts_of(function, call);
        const std::vector<Mark> all = marks(is_narrow_as_low);
        const double slope = supremum(all, count, &Mark::slope), curvature = supremum(all, count, &Mark::curvature);
        CAPTURE(call, slope, curvature);
        CHECK((*facts.slope > slope && *facts.slope < slope * 1.01));
        CHECK((*facts.curvature > curvature && *facts.curvature < curvature * 1.01));
    };
    check("splat_near(vec2,int,int,float,uint)", "splat_near(q.xy, 3, 7, 0.5, 9u)", true, 4);
    check("scratches_near(vec2,int,int,float,float,uint)", "scratches_near(q.xy, 3, 7, 0.2, 0.8, 9u)", false, 9);
}
