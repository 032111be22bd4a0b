// The facts that the library states about shapes, tiles and marks.
#include "tests/stdlib/facts.h"
#include "tests/support/catch.h"

#include <string>

using namespace haptel::test;

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
}
