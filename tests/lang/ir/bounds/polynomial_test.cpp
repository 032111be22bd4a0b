// Values that stand in sums of products more than once: against closed forms, and against values in long double.
#include "lang/ir/bounds/bounds.h"
#include "tests/lang/ir/ir_support.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

using namespace ir_test;

namespace {

// Of an entry of p, in one evaluation: nothing is cut.
Interval height(const std::string& body, const Interval (&p)[3])
{
    const Module module = parsed("function \"body\" () {\n" + body + R"(
    }
    texture "t" {
      block 56 reads 0 writes 0
      body "body"
    })");
    REQUIRE(verify(module) == "");
    BoundsBox box;
    for (size_t i = 0; i < 3; ++i) box.input[i] = p[i];
    return height_bounds(module, module.textures[0], box, 1);
}

constexpr const char* inputs =
    "%x = input p_x %y = input p_y %t = input p_z %one = real 1 %two = real 2 %three = real 3 ";

void check_range(const std::string& body, const Interval (&p)[3], double minimum, double maximum)
{
    CAPTURE(body);
    const Interval found = height(inputs + body, p);
    const double size = std::max({std::fabs(minimum), std::fabs(maximum), 1.0});
    CHECK(found.minimum <= minimum);
    CHECK(found.maximum >= maximum);
    CHECK(found.minimum > minimum - 1e-12 * size);
    CHECK(found.maximum < maximum + 1e-12 * size);
}

// A random sum of products of x, y, t and constants, none squared where `is_affine`, with cosine and sine of t in the
// place of t where `of_circle`: as text, and as what it means.
struct Expression {
    std::string text;
    std::string name;
    std::function<long double(const long double (&)[3])> value;
    uint32_t in = 0; // which of x, y, t, or cosine and sine of it, stand in it, a bit each
};

class Maker {
public:
    Maker(uint32_t seed, bool affine, bool circle = false) : random(seed), is_affine(affine), of_circle(circle) {}

    Expression make(int depth)
    {
        if (depth == 0 || below(5) == 0) return leaf();
        Expression a = make(depth - 1), b = make(depth - 1);
        const char* op = below(2) == 0 ? "mul" : below(2) == 0 ? "add" : "sub";
        if (is_affine && *op == 'm' && (a.in & b.in)) op = "add";
        Expression made;
        made.name = fresh();
        made.text = a.text + b.text + made.name + " = " + op + " " + a.name + ", " + b.name + "\n";
        made.in = a.in | b.in;
        made.value = [op, a, b](const long double(&at)[3]) {
            const long double left = a.value(at), right = b.value(at);
            return *op == 'm' ? left * right : *op == 'a' ? left + right : left - right;
        };
        return made;
    }
    double real(double low, double high) { return std::uniform_real_distribution(low, high)(random); }

private:
    Expression leaf()
    {
        static constexpr const char* names[] = {"%x", "%y", "%t"};
        if (below(4) == 0) {
            const double constant = std::round(real(-8, 8)) / 2;
            Expression made{"", fresh(), [constant](const long double(&)[3]) { return constant; }, 0};
            made.text = made.name + " = real " + std::to_string(constant) + "\n";
            return made;
        }
        const size_t which = below(3);
        if (which == 2 && of_circle) {
            if (below(2) == 0) return {"", "%cos", [](const long double(&at)[3]) { return std::cos(at[2]); }, 1u << 2};
            return {"", "%sin", [](const long double(&at)[3]) { return std::sin(at[2]); }, 1u << 3};
        }
        return {"", names[which], [which](const long double(&at)[3]) { return at[which]; }, 1u << which};
    }
    size_t below(size_t end) { return std::uniform_int_distribution<size_t>(0, end - 1)(random); }
    std::string fresh() { return "%v" + std::to_string(count++); }

    std::mt19937 random;
    bool is_affine, of_circle;
    int count = 0;
};

} // namespace

TEST_CASE("bounds: a mixture lies between what is mixed, and a smooth step between 0 and 1")
{
    const char* const mix = "%s = sub %one, %t %a = mul %x, %s %b = mul %y, %t %h = add %a, %b return %h";
    check_range(mix, {{2, 3}, {-1, 5}, {0, 1}}, -1, 5);
    check_range(mix, {{0, 1}, {0, 1}, {0, 1}}, 0, 1);
    check_range(mix, {{0, 1}, {0, 1}, {-1, 2}}, -1, 2); // beyond both: 2 x - y at t = -1, 2 y - x at 2
    check_range("%d = sub %y, %x %b = mul %t, %d %h = add %x, %b return %h", {{0, 1}, {0, 1}, {0, 1}}, 0, 1);
    const char* const cubic =
        "%u = mul %two, %t %v = sub %three, %u %a = mul %t, %t %h = mul %a, %v return %h"; // t t (3 - 2 t)
    check_range(cubic, {{0, 0}, {0, 0}, {0, 1}}, 0, 1);
    check_range(cubic, {{0, 0}, {0, 0}, {0.25, 0.5}}, 0.15625, 0.5);
    const char* const quintic =
        "%six = real 6 %ten = real 10 %fif = real 15 %a = mul %t, %six %b = sub %a, %fif "
        "%c = mul %t, %b %d = add %c, %ten %e = mul %t, %t %f = mul %e, %t %h = mul %f, %d return %h";
    check_range(quintic, {{0, 0}, {0, 0}, {0, 1}}, 0, 1);
    check_range(quintic, {{0, 0}, {0, 0}, {0.5, 0.75}}, 0.5, 0.896484375);
}

TEST_CASE("bounds: what is turned about the origin is no farther from it than before")
{
    const char* const turned = "%c = cos %t %s = sin %t %a = mul %x, %c %b = mul %y, %s %h = add %a, %b return %h";
    check_range(turned, {{-4, 3}, {-3, 2}, {-10, 10}}, -5, 5);
    check_range(turned, {{3, 3}, {4, 4}, {0, 7}}, -5, 5);
    check_range(turned, {{1, 2}, {0, 1}, {0, 0}}, 1, 2);                         // not turned
    check_range(turned, {{1, 1}, {0, 0}, {1, 2}}, std::cos(2.0), std::cos(1.0)); // a part of the circle
    check_range("%c = costurn %t %s = sinturn %t %a = mul %x, %s %b = mul %y, %c %h = sub %a, %b return %h",
                {{-4, 4}, {-3, 3}, {-1, 1}}, -5, 5);
    // 3 cos + 4 sin + 1 stands alone; x + cos sin is within a half of x
    check_range("%four = real 4 %c = cos %t %s = sin %t %a = mul %three, %c %b = mul %four, %s %e = add %a, %b "
                "%h = add %e, %one return %h",
                {{0, 0}, {0, 0}, {-10, 10}}, -4, 6);
    check_range("%c = cos %t %s = sin %t %a = mul %c, %s %h = add %a, %x return %h", {{1, 2}, {0, 0}, {-10, 10}}, 0.5,
                2.5);
}

TEST_CASE("bounds: factors that together are too small for a number do not make a sum nothing")
{
    // (1e-162 x) (2e-162 x) of x near e^375, and a square that is 0 in doubles, times what makes it a number again
    const Interval small = height(
        "%a = real 1e-162 %b = real 2e-162 %x = input p_x %c = mul %x, %a %d = mul %x, %b %h = mul %c, %d return %h",
        {{7e162, 8e162}, {0, 0}, {0, 0}});
    CHECK((small.minimum <= 98 && small.maximum >= 128));
    const Interval lost = height("%x = input p_x %a = real 1e300 %c = mul %x, %x %h = mul %c, %a return %h",
                                 {{0, 1e-170}, {0, 0}, {0, 0}});
    CHECK((lost.minimum <= 0 && lost.maximum >= 1e-40)); // and code has 0
}

TEST_CASE("bounds: sums of products hold what they are, however they are written")
{
    size_t sharper = 0;
    for (uint32_t seed = 0; seed < 6000; ++seed) {
        const bool of_circle = seed >= 3000;
        const bool is_affine = seed % 2 == 0;
        Maker maker(seed, is_affine, of_circle);
        const Expression made = maker.make(4);
        Interval p[3];
        for (Interval& at : p) {
            const double middle = maker.real(-3, 3), reach = seed % 5 == 0 ? 0 : maker.real(0, 2);
            at = {middle - reach, middle + reach};
        }
        CAPTURE(seed, made.text);
        const Interval found = height("%x = input p_x %y = input p_y %t = input p_z %cos = cos %t %sin = sin %t\n" +
                                          made.text + "return " + made.name,
                                      p);
        double least = infinity, most = -infinity;
        for (int i = 0; i < 60; ++i) {
            long double at[3];
            for (int k = 0; k < 3; ++k)
                at[k] = i < 8 ? (i >> k & 1 ? p[k].maximum : p[k].minimum) : maker.real(p[k].minimum, p[k].maximum);
            const auto value = static_cast<double>(made.value(at));
            least = std::min(least, value);
            most = std::max(most, value);
        }
        REQUIRE(found.minimum <= least);
        REQUIRE(found.maximum >= most);
        // linear in each, it is least and greatest at corners, which are among the places
        const double size = std::max({std::fabs(least), std::fabs(most), 1.0});
        sharper += is_affine && !of_circle && found.maximum - most < 1e-9 * size && least - found.minimum < 1e-9 * size;
    }
    CHECK(sharper > 1450); // of 1500; what is left has more terms than are written out
}
