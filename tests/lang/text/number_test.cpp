#include "lang/text/number.h"
#include "tests/support/catch.h"

#include <cmath>
#include <cstdlib>

using namespace haptel::lang;

// strtod is correctly rounded in glibc: the decimal with its point shifted by hand is the truth.
static bool same_as(std::string_view text, const char* decimal)
{
    const Number number = read_number(text);
    return number.error.empty() && number.value == std::strtod(decimal, nullptr);
}

TEST_CASE("a number with a unit is rounded once")
{
    CHECK(same_as("0.8mm", "0.0008"));
    CHECK(read_number("0.8mm").value == 0.0008);
    CHECK(4.1 * 0.001 != 0.0041); // what a product would give
    CHECK(same_as("4.1mm", "0.0041"));
    CHECK(same_as("60um", "0.00006"));
    CHECK(same_as("3nm", "3e-9"));
    CHECK(same_as("12.5cm", "0.125"));
    CHECK(same_as("2m", "2"));
    CHECK(same_as("1.7kHz", "1700"));
    CHECK(same_as("250Hz", "250"));
    CHECK(same_as("4.1ms", "0.0041"));
    CHECK(same_as("1e-3mm", "1e-6"));
    CHECK(same_as("2.5E+2um", "2.5e-4"));
    CHECK(same_as(".5s", "0.5"));
    CHECK(same_as("1.rad", "1"));
    for (int thousandths = 1; thousandths < 4000; ++thousandths) {
        const std::string digits = std::to_string(thousandths);
        CHECK(same_as(digits + "um", (digits + "e-6").c_str()));
        CHECK(same_as(digits + "e-3mm", (digits + "e-6").c_str()));
    }
}

TEST_CASE("degrees are the f64 nearest to the exact product")
{
    CHECK(read_number("180deg").value == 3.14159265358979323846);
    CHECK(read_number("90deg").value == 1.57079632679489661923);
    CHECK(read_number("1deg").value == 0.017453292519943295769);
    CHECK(read_number("0deg").value == 0.0);
    // A long double holds 11 more bits than a double: its product is off by less than 1/1000 of a double's spacing.
    const long double degree = 3.14159265358979323846264338327950288L / 180;
    for (int tenths = 1; tenths < 3600; tenths += 7) {
        const double value = read_number(std::to_string(tenths) + "e-1deg").value;
        const long double exact = static_cast<long double>(tenths) / 10 * degree;
        const double spacing = std::nextafter(value, 10.0) - value;
        CHECK(std::fabs(static_cast<double>(exact - static_cast<long double>(value))) <= 0.501 * spacing);
    }
}

TEST_CASE("whole numbers keep their kind")
{
    using Kind = Number::Kind;
    CHECK(read_number("7").kind == Kind::integer);
    CHECK(read_number("7u").kind == Kind::unsigned_integer);
    CHECK(read_number("0xFFu").kind == Kind::unsigned_integer);
    CHECK(read_number("0xFf").integer == 255);
    CHECK(read_number("0").integer == 0);
    CHECK(read_number("4294967295").integer == 4294967295u);
    CHECK(read_number("99999999999999999999").integer == UINT64_MAX);
    CHECK(read_number("7f").kind == Kind::real);
    CHECK(read_number("7mm").kind == Kind::real);
    CHECK(read_number("7mm").unit == "mm");
    CHECK(read_number("1.0f").value == 1.0);
    CHECK(read_number("1e2").kind == Kind::real);
}

TEST_CASE("extreme numbers")
{
    CHECK(same_as("1.7976931348623157e308", "1.7976931348623157e308"));
    CHECK(same_as("5e-324", "5e-324"));
    CHECK(same_as("1e-400", "0"));
    CHECK(same_as("1000000e-400", "0"));
    CHECK(same_as("0.1e-99999999999999999999", "0"));
    CHECK(same_as("0e99999999999999999999", "0"));
    CHECK(same_as("1e310um", "1e304"));
    CHECK(read_number("1e400").error == "this number is too large");
    CHECK(read_number("1e400").code.string() == "number");
    CHECK(read_number("1e99999999999999999999m").error == "this number is too large");
    // Exponents that are 0 or 1 to whoever counts in 32 or 64 bits.
    for (const char* wrapped : {"4294967296", "4294967297", "18446744073709551616", "18446744073709551617"}) {
        CAPTURE(wrapped);
        CHECK(read_number(std::string("1e") + wrapped).error == "this number is too large");
        CHECK(same_as(std::string("1e-") + wrapped, "0"));
    }
    const std::string long_one = "0." + std::string(1000, '0') + "1e1001"; // exactly 1
    CHECK(read_number(long_one).value == 1.0);
    CHECK(read_number(long_one + "deg").value == read_number("1deg").value);
}

TEST_CASE("what is no number says so")
{
    CHECK(read_number("").error == "expected a number");
    CHECK(read_number("mm").error == "expected a number");
    CHECK(read_number(".").error == "expected a number");
    CHECK(read_number("1mn").error == "unknown unit 'mn'");
    CHECK(read_number("1mn").code.string() == "unknown-unit");
    CHECK(read_number("1mn").hint == "did you mean 'mm'? units are m, cm, mm, um, nm, deg, rad, s, ms, Hz and kHz");
    CHECK(read_number("1khz").hint == "did you mean 'kHz'? units are m, cm, mm, um, nm, deg, rad, s, ms, Hz and kHz");
    CHECK(read_number("1\xC2\xB5m").hint == "write um for micrometres");
    CHECK(read_number("1inch").error == "unknown unit 'inch'");
    CHECK(read_number("007").error == "a whole number does not start with 0");
    CHECK(read_number("1.5u").error == "a number with a fraction or exponent cannot be unsigned");
    CHECK(read_number("0x").error == "expected hexadecimal digits after '0x'");
    CHECK(read_number("0xg").error == "expected hexadecimal digits after '0x'");
    CHECK(read_number("1 mm").error == "unknown unit ' mm'");
}
