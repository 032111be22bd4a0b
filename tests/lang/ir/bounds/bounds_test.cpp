// Bounds of textures hold every height, and are not needlessly wide.
#include "lang/ir/bounds/bounds.h"
#include "lang/ir/bounds/cell_ranges.h"
#include "tests/lang/ir/ir_support.h"

#include <algorithm>
#include <cmath>
#include <random>

using namespace ir_test;

namespace {

// A texture of p and k, with these bits of outputs beside its height.
struct Bounded {
    Module module;
    BoundsBox box;

    Bounded(const std::string& functions, const std::string& body, Interval p, Interval k, const char* writes)
        : module(parsed(functions + "function \"body\" () {\n" + body + R"(
        }
        texture "t" {
          parameter "k" i32 2 in 1 .. 4 unit "" offset 56
          block 64 reads 0 writes )" +
                        writes + R"(
          body "body"
        })"))
    {
        REQUIRE(verify(module) == "");
        for (size_t i = 0; i < 3; ++i) box.input[i] = p;
        box.parameters = {k};
    }
};

Interval height(const std::string& functions, const std::string& body, Interval p, Interval k = {1, 4})
{
    const Bounded texture(functions, body, p, k, "0");
    return height_bounds(texture.module, texture.module.textures[0], texture.box);
}

} // namespace

TEST_CASE("bounds: exact where the operations are")
{
    Interval square = height("", "%x = input p_x %h = mul %x, %x return %h", {-0.5, 0.25});
    CHECK((square.minimum == 0 && square.maximum == 0.25 && !square.may_be_nan));
    // x - x^2 on [0, 1]: natural evaluation says [-1, 1]; cutting tells [0, 1/4]
    Interval hill = height("", "%x = input p_x %s = mul %x, %x %h = sub %x, %s return %h", {0, 1});
    CHECK((hill.minimum <= 0 && hill.minimum > -0.02));
    CHECK((hill.maximum >= 0.25 && hill.maximum < 0.26));
    // 3 x - 2 x is x
    Interval line =
        height("", "%x = input p_x %t = real 3 %u = mul %x, %t %v = add %x, %x %h = sub %u, %v return %h", {-1, 1});
    CHECK((line.minimum > -1 - 1e-12 && line.maximum < 1 + 1e-12));
    // the entry turns what is not finite into 0
    Interval log = height("", "%x = input p_x %h = log %x return %h", {2, 3});
    CHECK((!log.may_be_nan && log.minimum > 0.69 && log.maximum < 1.1));
    Interval edge =
        height("", "%x = input p_x %t = real 3 %y = add %x, %t %l = log %y %h = add %l, %t return %h", {-4, -1});
    CHECK((edge.may_be_nan && edge.minimum == -infinity && edge.maximum >= 3.69));
}

// x - x^2 and 1 - x + x^2 on [0, 1] lie in [0, 1/4] and [3/4, 1]; natural evaluation says [-1, 1] and [0, 2] of both.
TEST_CASE("bounds: outputs beside the height are cut as it is")
{
    const Bounded texture("", R"(%x = input p_x %one = real 1 %s = mul %x, %x %h = sub %x, %s
                                 %r = sub %one, %x %g = add %r, %s return %x, %h, %g)",
                          {0, 1}, {1, 4}, "3");
    const std::vector<Interval> outputs = output_bounds(texture.module, texture.module.textures[0], texture.box);
    REQUIRE(outputs.size() == 2);
    CHECK((outputs[0].minimum <= 0 && outputs[0].minimum > -0.02));
    CHECK((outputs[0].maximum >= 0.25 && outputs[0].maximum < 0.26));
    CHECK((outputs[1].minimum <= 0.75 && outputs[1].minimum > 0.7));
    CHECK((outputs[1].maximum >= 1 && outputs[1].maximum < 1.05));
}

TEST_CASE("bounds: where the height may be no number it counts as 0, and the bounds hold that")
{
    const auto beside_root = [](double offset, double factor) {
        return "%x = input p_x %s = sqrt %x %f = real " + std::to_string(factor) + " %o = real " +
               std::to_string(offset) + " %t = mul %s, %f %h = add %t, %o return %h";
    };
    const Interval hill = height("", beside_root(1, 1), {-1, 1}), pit = height("", beside_root(-1, -1), {-1, 1});
    CHECK((hill.may_be_nan && hill.minimum == 0 && hill.maximum >= 2 && hill.maximum < 2.1));
    CHECK((pit.may_be_nan && pit.maximum == 0 && pit.minimum <= -2 && pit.minimum > -2.1));
    const Interval everywhere = height("", beside_root(1, 1), {0, 1}),
                   nowhere = height("", beside_root(1, 1), {-2, -1});
    CHECK((!everywhere.may_be_nan && everywhere.minimum > 0.99));
    CHECK((nowhere.may_be_nan && nowhere.minimum == 0 && nowhere.maximum == 0));
}

TEST_CASE("bounds: a condition narrows what it compares, and a decided one leaves out an arm")
{
    const char* guarded = R"(
        %x = input p_x
        %tenth = real 0.1
        %c = lt %x, %tenth
        %h = if %c { %zero = real 0 yield %zero } else { %one = real 1 %q = div %one, %x yield %q }
        return %h)";
    Interval whole = height("", guarded, {-1, 1});
    CHECK((!whole.may_be_nan && whole.minimum == 0 && whole.maximum >= 10 && whole.maximum < 10.001));
    Interval left = height("", guarded, {-1, 0.05});
    CHECK((left.minimum == 0 && left.maximum == 0));
}

TEST_CASE("bounds: facts bound each octave of a sum over a parameter's range")
{
    // facts that the body alone would not give: the callee is a wave of height 1 that says 0.5, over many periods
    const std::string noise = R"(
        function "noise" (%a: real, %b: real, %c: real) first 3 facts minimum -0.5 maximum 0.5 slope 3 proven {
          %s = add %a, %b
          %t = add %s, %c
          %w = sin %t
          %half = real 0.5
          %r = mul %w, %half
          return %r
        })";
    const std::string fbm = R"(
        %x = input p_x  %y = input p_y  %z = input p_z
        %n = parameter 0 i32
        %four = i32 4
        %trips = imin %n, %four
        %one = real 1  %zero = real 0  %two = real 2  %half = real 0.5
        %sum, %amplitude, %frequency = for %trips max 4 (%i, %s, %a, %f) from (%zero, %one, %one) {
          %u = mul %x, %f  %v = mul %y, %f  %w = mul %z, %f
          %h = call "noise" (%u, %v, %w)
          %d = mul %h, %a
          %t = add %s, %d
          %b = mul %a, %half  %g = mul %f, %two
          yield %t, %b, %g
        }
        return %sum)";
    Interval all = height(noise, fbm, {-100, 100});
    CHECK((!all.may_be_nan && all.maximum >= 0.5 * 1.875 && all.maximum < 0.5 * 1.875 + 1e-12));
    Interval two = height(noise, fbm, {-100, 100}, {1, 2});
    CHECK((two.maximum >= 0.75 && two.maximum < 0.75 + 1e-12));
    Interval unbounded = height(noise, fbm, {-infinity, infinity});
    CHECK((unbounded.maximum >= 0.9375 && unbounded.maximum < 0.9376 && unbounded.minimum > -0.9376));
    // near one point the slope says more than the range does: sin is close to 0 there
    Interval near = height(noise, fbm, {-1e-4, 1e-4});
    CHECK((near.maximum < 0.01 && near.minimum > -0.01));
}

TEST_CASE("bounds: the range of a table's cells within the index")
{
    Module module = parsed(R"(
        table "T" real [5, 1, 2, 9]
        function "f" (%i: i32) {
          %low = i32 0  %high = i32 3
          %a = imax %i, %low
          %b = imin %a, %high
          %r = table 0 %b
          return %r
        })");
    const Interval middle{1, 2}, all{-5, 100};
    Interval some = bounds_of(module, 0, {middle})[0];
    CHECK((some.minimum == 1 && some.maximum == 2));
    Interval every = bounds_of(module, 0, {all})[0];
    CHECK((every.minimum == 1 && every.maximum == 9));
}

TEST_CASE("bounds: work is limited, whatever the program asks for")
{
    Interval costly = height("", R"(
        %x = input p_x
        %n = i32 2000
        %r = for %n max 2000 (%i, %a) from (%x) {
          %s = for %n max 2000 (%j, %b) from (%a) { %t = sin %b yield %t }
          yield %s
        }
        return %r)",
                             {-1, 1});
    CHECK((costly.may_be_nan && costly.minimum == -infinity && costly.maximum == infinity));
}

TEST_CASE("bounds: a read of a table is one step, however many cells it may be of")
{
    std::string cells;
    for (int i = 0; i < 60'000; ++i) cells += (i > 0 ? "," : "") + std::to_string(i % 1000);
    const Module module = parsed("table \"T\" real [" + cells + R"(]
        function "f" (%i: i32) {
          %zero = real 0
          %n = i32 1000
          %r = for %n max 1000 (%k, %a) from (%zero) {
            %least = i32 0
            %most = i32 59999
            %b = imax %i, %least
            %c = imin %b, %most
            %t = table 0 %c
            %s = max %a, %t
            yield %s
          }
          return %r
        })");
    const Interval any{0, 60'000};
    const Interval found = bounds_of(module, 0, {any})[0];
    CHECK((found.minimum == 0 && found.maximum == 999 && !found.may_be_nan)); // well below a million operations
}

TEST_CASE("bounds: the cells between two of a table are those that a look at each finds")
{
    const double nan = std::nan("");
    for (size_t size : {1, 2, 15, 16, 17, 31, 32, 33, 100, 255, 256, 257, 1000}) {
        std::mt19937_64 random(size);
        Table table{"T", Type::real, {}, {}};
        for (size_t i = 0; i < size; ++i)
            table.reals.push_back(random() % 40 == 0 ? nan : std::uniform_real_distribution(-9.0, 9.0)(random));
        const CellRanges ranges(table);
        for (int round = 0; round < 300; ++round) {
            const size_t first = random() % size, last = first + random() % (size - first);
            Interval all{infinity, -infinity, false};
            for (size_t i = first; i <= last; ++i) {
                const double cell = table.reals[i];
                all.may_be_nan |= std::isnan(cell);
                if (!std::isnan(cell)) all = {std::min(all.minimum, cell), std::max(all.maximum, cell), all.may_be_nan};
            }
            const Interval found = ranges.over(first, last);
            CAPTURE(size, first, last);
            CHECK((found.minimum == all.minimum && found.maximum == all.maximum && found.may_be_nan == all.may_be_nan));
        }
    }
}

// sin(x / 10) written so that its body says nothing: only the declared slope does, from the middle of the box.
TEST_CASE("bounds: the slope that is declared bounds the value about the middle of a box")
{
    const Module module = parsed(R"(
        function "wave" (%x: real) first 1 facts minimum -1 maximum 1 slope 0.1 class C2 proven {
          %tenth = real 0.1 %a = mul %x, %tenth %big = real 10 %s = mul %x, %x %t = mul %s, %big
          %u = mul %x, %big %v = mul %u, %x %d = add %a, %t %e = sub %d, %v
          %h = sin %e
          return %h
        }
        function "body" () { %x = input p_x %h = call "wave" (%x) return %h }
        texture "t" { block 56 reads 0 writes 0 body "body" })");
    REQUIRE(verify(module) == "");
    BoundsBox box;
    box.input[0] = {2, 6};
    const Interval found = height_bounds(module, module.textures[0], box, 1);
    CAPTURE(found.minimum, found.maximum);
    CHECK((found.minimum <= std::sin(0.2) && found.maximum >= std::sin(0.6)));
    CHECK((found.minimum > std::sin(0.4) - 0.2001 && found.maximum < std::sin(0.4) + 0.2001));
}

TEST_CASE("bounds: fewer operations give wider bounds, that still hold")
{
    // |x| (10 - x), whose factors move together: 0 .. 25 over 0 .. 10
    const Bounded texture("", "%x = input p_x %ten = real 10 %a = abs %x %y = sub %ten, %x %h = mul %a, %y return %h",
                          {0, 10}, {1, 4}, "0");
    Interval wider{-infinity, infinity};
    for (uint64_t operations : {1, 100, 1'000, 100'000}) {
        std::function<HeightPlaces()> places_of;
        const Interval found =
            height_bounds(texture.module, texture.module.textures[0], texture.box, 4096, operations, &places_of);
        CAPTURE(operations, found.minimum, found.maximum);
        CHECK((found.minimum <= 0 && found.maximum >= 25));
        CHECK((found.minimum >= wider.minimum && found.maximum <= wider.maximum));
        if (operations == 1) CHECK(found.maximum == 100);
        if (operations == 100'000) CHECK(found.maximum < 26.5);
        const HeightPlaces places = places_of();
        CHECK((places.highest[0] >= 0 && places.highest[0] <= 10));
        wider = found;
    }
}

TEST_CASE("bounds: what may fault is told with the reason, and nothing of what cannot")
{
    using Why = Undefined::Why;
    struct {
        const char* body; // of x in -2 .. 2, u without bounds
        std::optional<Why> why;
    } const cases[] = {
        {"%h = log %x", Why::domain},
        {"%a = abs %x %h = log %a", Why::pole},
        {"%one = real 1 %d = div %one, %x %h = atan %d", Why::pole},
        {"%one = real 1 %a = abs %x %b = add %a, %one %h = div %one, %b", std::nullopt},
        {"%big = real 1000 %a = mul %x, %big %h = exp %a", Why::overflow},
        {"%big = real 1000 %a = mul %x, %big %e = exp %a %h = tanh %e", Why::overflow}, // the gradient's
        {"%big = real 1000 %a = mul %x, %big %e = exp %a %two = real 2 %h = min %e, %two", std::nullopt},
        {"%big = real 1e200 %a = mul %x, %big %s = sin %a %h = mul %s, %big", Why::derivative},
        {"%s = sin %u %v = mul %u, %u %h = mul %s, %v", std::nullopt},
        // the way on which x comes in is never taken, which the code of the gradient does not know: 0 times infinity
        {"%one = real 1 %zero = real 0 %c = lt %one, %zero %v = if %c { yield %x } else { yield %one } "
         "%d = div %v, %zero %h = atan %d",
         Why::pole},
        {"%one = real 1 %zero = real 0 %d = div %one, %zero %h = atan %d", std::nullopt}, // no gradient at all
        {"%s = sqrt %x %b = real 100 %h = max %s, %b", Why::domain}, // beside NaN, the mean of both gradients
        {"%one = real 1 %zero = real 0 %big = div %one, %zero %a = abs %x %y = add %a, %one %h = call \"turn\" (%y, "
         "%big)",
         Why::pole}, // a slope is promised of finite arguments alone: infinity times 0
        {"%one = real 1 %zero = real 0 %a = abs %x %y = add %a, %one %d = div %y, %zero %t = atan %d %h = call "
         "\"flat\" (%t)",
         Why::pole}, // beyond 1 a constant, and yet its derivative times a gradient that is no number
        {"%n = i32 2000 %h = for %n max 2000 (%i, %a) from (%x) { %s = for %n max 2000 (%j, %b) from (%a) "
         "{ %t = sin %b yield %t } yield %s }",
         Why::not_looked_at},
        {"%k = call \"flat\" (%x) %one = real 1 %c = lt %k, %one %v = select %c, %x, %one %h = log %v",
         Why::domain}, // behind a call whose result is only compared
        // 0 by convention where they have no bound, and a number beside it
        {"%a = abs %x %h = sqrt %a", std::nullopt},
        {"%a = abs %x %b = real 0.3 %h = pow %a, %b", std::nullopt},
        {"%half = real 0.5 %a = mul %x, %half %h = asin %a", std::nullopt},
        {"%h = length2 %x, %x", std::nullopt},
        {"%h = atan2 %x, %x", std::nullopt},
    };
    for (const auto& one : cases) {
        CAPTURE(one.body);
        Module module = parsed(std::string("function \"turn\" (%x: real, %by: real) first 1 facts minimum -2 maximum 2 "
                                           "slope 1 proven { %a = mul %x, %by %h = atan %a return %h } "
                                           "function \"flat\" (%x: real) { %one = real 1 %h = min %x, %one return %h } "
                                           "function \"body\" () { %x = input p_x %u = input uv_x ") +
                               one.body + " return %h } texture \"t\" { block 56 reads 0 writes 0 body \"body\" }");
        REQUIRE(verify(module) == "");
        BoundsBox box;
        std::fill(std::begin(box.input), std::end(box.input), Interval{-infinity, infinity});
        box.input[0] = {-2, 2};
        const std::vector<Undefined> found = undefined_in(module, module.textures[0], box);
        CHECK(found.empty() == !one.why.has_value());
        if (one.why && !found.empty()) CHECK(found[0].why == *one.why);
    }
}
