// Slope, curvature and class: closed forms, and what they promise of every pair of points.
#include "lang/ir/bounds/bounds.h"
#include "lang/ir/builder.h"
#include "lang/ir/derive/differentiate.h"
#include "lang/ir/op_info.h"
#include "tests/lang/ir/ir_random.h"
#include "tests/lang/ir/ir_support.h"

#include <array>
#include <cmath>
#include <random>

using namespace ir_test;

namespace {

using Point = std::array<double, 3>;

// A texture of p whose body is the last function of `text`.
Texture texture_of(const Module& module)
{
    Texture texture;
    texture.body = static_cast<uint32_t>(module.functions.size() - 1);
    return texture;
}

TextureBounds bounds_of(const std::string& body, std::initializer_list<Interval> point,
                        const std::string& functions = {}, uint32_t evaluations = 4096)
{
    const Module module = parsed(functions + "function \"t\" () { " + body + " }");
    BoundsBox box;
    std::copy(point.begin(), point.end(), box.input);
    return texture_bounds(module, texture_of(module), box, evaluations);
}

bool is_near(double bound, double exact, double looseness = 1e-9)
{
    CAPTURE(bound, exact);
    return bound >= exact && bound <= exact * (1 + looseness) + 1e-300;
}

Point minus(const Point& a, const Point& b)
{
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
double norm(const Point& a)
{
    return std::hypot(a[0], a[1], a[2]);
}

} // namespace

TEST_CASE("slope and curvature: closed forms")
{
    SECTION("a plane")
    {
        const TextureBounds plane = bounds_of("%x = input p_x %y = input p_y %a = real 3 %b = real 4 %u = mul %a, %x "
                                              "%v = mul %b, %y %h = add %u, %v return %h",
                                              {{-1, 1}, {-1, 1}});
        CHECK(is_near(plane.slope_max, 5));
        CHECK(plane.curvature_max_per_m == 0);
        CHECK(plane.continuity == Continuity::smooth);
    }
    SECTION("a square: the largest slope lies at the end")
    {
        const TextureBounds square = bounds_of("%x = input p_x %h = mul %x, %x return %h", {{-0.5, 0.25}});
        CHECK(is_near(square.slope_max, 1));
        CHECK(is_near(square.curvature_max_per_m, 2));
    }
    SECTION("a wave of many periods")
    {
        const TextureBounds wave =
            bounds_of("%x = input p_x %k = real 100 %a = mul %x, %k %h = sinturn %a return %h", {{-1, 1}});
        CHECK(is_near(wave.slope_max, 200 * M_PI));
        CHECK(is_near(wave.curvature_max_per_m, 40000 * M_PI * M_PI));
    }
    SECTION("a product of waves: cutting the box finds its curvature")
    {
        const TextureBounds egg = bounds_of(
            "%x = input p_x %y = input p_y %a = sin %x %b = sin %y %h = mul %a, %b return %h", {{0, 1.5}, {0, 1.5}});
        CHECK(is_near(egg.slope_max, std::sin(1.5), 0.3)); // |(cos x sin y, sin x cos y)|, at (0, 1.5)
        CHECK(is_near(egg.curvature_max_per_m, std::sin(1.5), 0.6));
    }
    SECTION("an angle: 1 over the least distance, curved by its square")
    {
        const std::string angle = "%x = input p_x %y = input p_y %h = atan2 %y, %x return %h";
        const TextureBounds turn = bounds_of(angle, {{0.5, 1}, {-1, 1}});
        CHECK(is_near(turn.slope_max, 2, 0.1));
        CHECK(is_near(turn.curvature_max_per_m, 4, 0.1));
        CHECK(bounds_of(angle, {{0, 1}, {-1, 1}}).slope_max == infinity);
    }
    SECTION("an angle that ends flat before its pole: cutting goes on until no piece holds both")
    {
        const std::string angle = "%x = input p_x %y = input p_y %a = atan2 %y, %x %r = length2 %x, %y "
                                  "%least = real 0.1 %zero = real 0 %d = sub %r, %least %fade = max %d, %zero "
                                  "%h = mul %fade, %a return %h";
        // fade' a + fade a': sqrt(pi^2 + (1 - 0.1 / r)^2), at r = sqrt(2)
        const double exact = std::hypot(M_PI, 1 - 0.1 / std::sqrt(2));
        CHECK(is_near(bounds_of(angle, {{-1, 1}, {-1, 1}}, {}, 512).slope_max, exact, 0.5));
    }
    SECTION("a normal: as steep as it turns, and no more than the object's normals do")
    {
        const Module module = parsed("function \"t\" () { %n = input n_x return %n }");
        BoundsBox box;
        box.input[static_cast<size_t>(Input::n_x)] = {-1, 1};
        for (size_t i = 0; i < 9; ++i) box.input[static_cast<size_t>(Input::n_dp_00) + i] = {-3, 3};
        CHECK(is_near(texture_bounds(module, texture_of(module), box).slope_max, 3 * std::sqrt(3)));
        box.normal_turn_max_per_m = 3;
        CHECK(is_near(texture_bounds(module, texture_of(module), box).slope_max, 3));
    }
    SECTION("a distance: slope 1 wherever it is, curved by 1 over the least")
    {
        const std::string length = "%x = input p_x %y = input p_y %z = input p_z %h = length3 %x, %y, %z return %h";
        const TextureBounds cone = bounds_of(length, {{-1, 1}, {-1, 1}, {-1, 1}});
        CHECK(is_near(cone.slope_max, 1));
        CHECK(cone.continuity == Continuity::c0);
        const TextureBounds away = bounds_of(length, {{-1, 1}, {-1, 1}, {2, 3}});
        CHECK(is_near(away.curvature_max_per_m, 0.5));
        CHECK(away.continuity == Continuity::smooth);
    }
}

TEST_CASE("slope and curvature: facts by the chain rule")
{
    const std::string noise = R"(
        function "noise" (%a: real, %b: real, %c: real) first 3 facts minimum -1 maximum 1 slope 2 curvature 10 class C1 {
          %s = floor %a
          %w = sin %s
          return %w
        })";
    const TextureBounds plain = bounds_of("%x = input p_x %y = input p_y %z = input p_z %k = real 1000 %u = mul %x, %k "
                                          "%v = mul %y, %k %w = mul %z, %k %n = call \"noise\" (%u, %v, %w) "
                                          "%d = real 0.001 %h = mul %n, %d return %h",
                                          {{-1, 1}, {-1, 1}, {-1, 1}}, noise);
    CHECK(is_near(plain.slope_max, 2));
    CHECK(is_near(plain.curvature_max_per_m, 1e4));
    CHECK(plain.continuity == Continuity::c1);

    // a rotation does not make it steeper
    const std::string turned = "%x = input p_x %y = input p_y %z = input p_z %k = real 1 "
                               "%c = real 0.70710678118654757 %a = add %x, %y %b = sub %x, %y %u = mul %c, %a "
                               "%v = mul %c, %b %w = mul %k, %z %h = call \"noise\" (%u, %v, %w) return %h";
    const TextureBounds rotated = bounds_of(turned, {{-9, 9}, {-9, 9}, {-9, 9}}, noise);
    CHECK(is_near(rotated.slope_max, 2));
    CHECK(is_near(rotated.curvature_max_per_m, 10));

    // a warp: slope <= s |J|, curvature <= c |J|^2 + s |H|, with q = 3 x + x^2 on [0, 1]
    const TextureBounds warped =
        bounds_of("%x = input p_x %k = real 3 %a = mul %k, %x %b = mul %x, %x %q = add %a, %b %z = real 0 "
                  "%h = call \"noise\" (%q, %z, %z) return %h",
                  {{0, 1}}, noise, 1);
    CHECK(is_near(warped.slope_max, 2 * 5));
    CHECK(is_near(warped.curvature_max_per_m, 10 * 25 + 2 * 2));

    // further arguments: a number of a cell only steps, one that moves adds its own part, which has no bound here
    const std::string tile = R"(
        function "tile" (%x: real, %cell: real) first 1 facts minimum -1 maximum 1 slope 2 curvature 10 class C2 {
          %s = floor %x
          %b = add %s, %cell
          %w = sin %b
          %t = sqrt %w
          return %t
        })";
    const std::string place = "%x = input p_x %c = floor %x %d = sub %x, %c ";
    const TextureBounds stepping = bounds_of(place + "%h = call \"tile\" (%d, %c) return %h", {{-9, 9}}, tile);
    CHECK(is_near(stepping.slope_max, 2));
    CHECK(is_near(stepping.curvature_max_per_m, 10));
    CHECK(stepping.continuity == Continuity::jump);
    CHECK(bounds_of(place + "%h = call \"tile\" (%d, %x) return %h", {{-9, 9}}, tile).slope_max > 1e9);
}

TEST_CASE("class: the roughest part that can be met, with its place")
{
    const auto class_of = [](const std::string& body, Interval x) { return bounds_of(body, {x}).continuity; };
    const std::string x = "%x = input p_x %t = real 0.1 ";
    CHECK(class_of(x + "%h = abs %x return %h", {-1, 1}) == Continuity::c0);
    CHECK(class_of(x + "%h = abs %x return %h", {0.5, 1}) == Continuity::smooth);
    CHECK(class_of(x + "%h = floor %x return %h", {0.2, 0.8}) == Continuity::smooth);
    CHECK(class_of(x + "%h = floor %x return %h", {0.2, 1.8}) == Continuity::jump);
    CHECK(class_of(x + "%h = floor %t return %h", {0.2, 1.8}) == Continuity::smooth);
    CHECK(class_of(x + "%h = max %x, %t return %h", {-1, 1}) == Continuity::c0);
    CHECK(class_of(x + "%h = max %x, %t return %h", {0.2, 1}) == Continuity::smooth);
    CHECK(class_of(x + "%h = sqrt %x return %h", {0, 1}) == Continuity::c0);
    CHECK(class_of(x + "%h = div %t, %x return %h", {-1, 1}) == Continuity::jump);
    CHECK(class_of(x + "%c = lt %x, %t %h = select %c, %x, %t return %h", {-1, 1}) == Continuity::c0); // they meet
    CHECK(class_of(x + "%c = lt %x, %t %k = real 0 %h = select %c, %x, %k return %h", {-1, 1}) == Continuity::jump);
    CHECK(class_of(x + "%c = lt %x, %t %h = select %c, %x, %t return %h", {-1, 0}) == Continuity::smooth);
    CHECK(class_of(x + "%c = lt %x, %t %h = if %c { yield %t } else { yield %x } return %h", {-1, 1}) ==
          Continuity::c0); // they meet
    CHECK(class_of(x + "%c = lt %x, %t %k = real 0 %h = if %c { yield %k } else { yield %x } return %h", {-1, 1}) ==
          Continuity::jump);
    CHECK(class_of(x + "%h = div %x, %x return %h", {-1, 1}) == Continuity::jump);
}

TEST_CASE("class: a kink where the value is 0 is smoothed by a power")
{
    const auto class_of = [](const std::string& body) { return bounds_of(body, {{-1, 1}}).continuity; };
    const std::string ramp = "%x = input p_x %z = real 0 %r = max %x, %z ";
    CHECK(class_of(ramp + "return %r") == Continuity::c0);
    CHECK(class_of(ramp + "%h = mul %r, %r return %h") == Continuity::c1);
    CHECK(class_of(ramp + "%s = mul %r, %r %h = mul %s, %r return %h") == Continuity::c2);
    CHECK(class_of(ramp + "%w = sin %x %h = mul %r, %w return %h") == Continuity::c0);
    CHECK(class_of(ramp + "%w = abs %x %h = mul %r, %w return %h") == Continuity::c0);
    CHECK(class_of(ramp + "%s = mul %r, %r %k = real 1 %h = add %s, %k return %h") == Continuity::c1);
    CHECK(class_of("%x = input p_x %k = real 0.5 %r = max %x, %k %h = mul %r, %r return %h") == Continuity::c0);
    CHECK(class_of(ramp + "%s = mul %r, %r %q = sqrt %s return %q") == Continuity::c0);
}

TEST_CASE("class: a length of lengths is smooth where it is not 0")
{
    const std::string inner = "%x = input p_x %y = input p_y %r = length2 %x, %y ";
    const auto class_of = [&](const std::string& rest) {
        return bounds_of(inner + rest + " return %h", {{-1, 1}, {-1, 1}}).continuity;
    };
    CHECK(class_of("%k = real 2 %h = length2 %r, %k") == Continuity::c1);
    CHECK(class_of("%a = abs %x %k = real 2 %h = length2 %a, %k") == Continuity::c1);
    CHECK(class_of("%h = length2 %r, %x") == Continuity::c0);
    CHECK(class_of("%k = real 0.5 %a = sub %r, %k %t = real 2 %h = length2 %a, %t") ==
          Continuity::c0); // the tip is elsewhere
}

TEST_CASE("class: arms of an if that meet")
{
    const auto class_of = [](const std::string& arms) {
        return bounds_of("%x = input p_x %y = input p_y %r = length2 %x, %y %one = real 1 %z = real 0 %c = le %r, %one "
                         "%h = if %c { " +
                             arms + " return %h",
                         {{-3, 3}, {-3, 3}})
            .continuity;
    };
    const std::string bowl = "%s = mul %r, %r %b = sub %one, %s ";
    CHECK(class_of(bowl + "yield %b } else { yield %z }") == Continuity::c0);                 // 1 - r^2, 0
    CHECK(class_of(bowl + "%q = mul %b, %b yield %q } else { yield %z }") == Continuity::c0); // r alone is C0, at 0
    CHECK(class_of(bowl + "yield %b } else { yield %one }") == Continuity::jump);
    CHECK(class_of("%u = add %x, %y yield %u } else { yield %z }") == Continuity::jump);

    const auto along_x = [](const std::string& arms) {
        return bounds_of("%x = input p_x %y = input p_y %z = real 0 %two = real 2 %c = lt %x, %two %h = if %c { " +
                             arms + " return %h",
                         {{-3, 3}, {-3, 3}})
            .continuity;
    };
    CHECK(along_x("yield %x } else { yield %two }") == Continuity::c0);
    CHECK(along_x(
              "%s = mul %x, %x yield %s } else { %a = mul %x, %two %b = add %a, %a %d = add %two, %two %e = sub %b, %d "
              "yield %e }") == Continuity::c1); // x^2, 4 x - 4
    // y + (x - 2)^2, y: what is added comes to 0, and so does its slope; (x - 2) y: its slope does not; x y: nothing
    // does
    const std::string short_of = "%s = sub %x, %two ";
    CHECK(along_x(short_of + "%q = mul %s, %s %b = add %y, %q yield %b } else { yield %y }") == Continuity::c1);
    CHECK(along_x(short_of + "%q = mul %s, %y %b = add %y, %q yield %b } else { yield %y }") == Continuity::c0);
    CHECK(along_x("yield %y } else { %q = mul %x, %y %b = add %q, %y yield %b }") == Continuity::jump);
    CHECK(along_x("%s = mul %x, %y yield %s } else { %t = mul %two, %y yield %t }") == Continuity::jump); // not told
}

// For programs at random: no pair of points of the box breaks what slope, curvature and class promise.
TEST_CASE("slope and curvature: never exceeded")
{
    uint32_t with_slope = 0, with_curvature = 0;
    for (uint32_t seed = 1; seed <= 300; ++seed) {
        Module module = random_module(seed, Flavour::tame);
        const auto tried = static_cast<uint32_t>(module.functions.size() - 1);
        const std::vector<Slot<double>> arguments = random_arguments(module.functions[tried], seed, Flavour::tame);

        Builder builder(module, "texture");
        std::vector<Value> passed;
        BoundsBox box;
        for (size_t i = 0; i < arguments.size(); ++i) {
            const Type type = module.functions[tried].type(module.functions[tried].parameters[i]);
            if (type == Type::real && i < 3) {
                passed.push_back(builder.input(static_cast<Input>(i)));
                const double half = seed % 3 == 0 ? 0.5 : seed % 3 == 1 ? 0.05 : 0.002;
                box.input[i] = {arguments[i].real - half, arguments[i].real + half};
            } else if (type == Type::real)
                passed.push_back(builder.real(arguments[i].real));
            else if (type == Type::i32)
                passed.push_back(builder.i32(static_cast<int32_t>(arguments[i].bits)));
            else if (type == Type::u32)
                passed.push_back(builder.u32(arguments[i].bits));
            else
                passed.push_back(builder.boolean(arguments[i].bits != 0));
        }
        const std::vector<Value> results = builder.call(tried, passed);
        Texture texture;
        texture.body = builder.finish(std::vector<Value>{results[0]});
        Differentiator(module).make_entries(texture);
        const TextureBounds bounds = texture_bounds(module, texture, box, 64);
        with_slope += bounds.slope_max < infinity;
        with_curvature += bounds.continuity >= Continuity::c1 && bounds.curvature_max_per_m < infinity;

        std::mt19937 random(seed);
        const auto anywhere = [&] {
            Point at;
            for (size_t i = 0; i < 3; ++i)
                at[i] = std::uniform_real_distribution(box.input[i].minimum, box.input[i].maximum)(random);
            return at;
        };
        Interpreter<double> interpreter(module);
        struct Touch {
            double height;
            Point gradient;
            bool is_faulty;
        };
        const auto touch = [&](const Point& at) {
            EntryInputs<double> point;
            std::copy(at.begin(), at.end(), point.input);
            const auto all = interpreter.run(texture.height_gradient, {}, &point);
            return Touch{all[0].real, {all[1].real, all[2].real, all[3].real}, all[4].bits != 0};
        };
        for (int pair = 0; pair < 40; ++pair) {
            const Point from = anywhere();
            Point to = anywhere();
            const double share = std::pow(10.0, -static_cast<double>(random() % 5));
            for (size_t i = 0; i < 3; ++i) to[i] = from[i] + share * (to[i] - from[i]);
            const Touch a = touch(from), b = touch(to);
            if (a.is_faulty || b.is_faulty) continue;
            const double distance = norm(minus(from, to));
            const double size = std::max({1.0, std::fabs(a.height), norm(a.gradient), norm(b.gradient)});
            INFO(seed << ' ' << pair << " class " << to_string(bounds.continuity));
            CHECK(norm(a.gradient) <= bounds.slope_max * (1 + 1e-9) + 1e-9);
            if (bounds.continuity >= Continuity::c0)
                CHECK(std::fabs(a.height - b.height) <= bounds.slope_max * distance * (1 + 1e-9) + 1e-11 * size);
            if (bounds.continuity >= Continuity::c1)
                CHECK(norm(minus(a.gradient, b.gradient)) <=
                      bounds.curvature_max_per_m * distance * (1 + 1e-9) + 1e-9 * size);
        }
    }
    CHECK(with_slope > 150);
    CHECK(with_curvature > 50);
}
