#include "lang/text/number.h"

#include "lang/text/diagnostic.h"
#include "lang/text/near_name.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <vector>

namespace haptel::lang {

namespace {

// A power of ten is a shift of the decimal exponent and costs no rounding.
struct Unit {
    std::string_view name;
    int power_of_ten;
    std::string_view si;
};
constexpr Unit units[] = {{"m", 0, "m"},   {"cm", -2, "m"},   {"mm", -3, "m"},   {"um", -6, "m"},
                          {"nm", -9, "m"}, {"rad", 0, "rad"}, {"deg", 0, "rad"}, {"s", 0, "s"},
                          {"ms", -3, "s"}, {"Hz", 0, "Hz"},   {"kHz", 3, "Hz"}};

// pi/180 = digits * 10^-51
constexpr std::string_view degree_digits = "17453292519943295769236907684886127134428718885417";
constexpr int degree_power_of_ten = -51;

// digits * 10^power
struct Decimal {
    std::string digits;
    int64_t power = 0;
};

// Product in decimal: nothing is rounded but what lies beyond 800 digits, more than any f64 needs to be told from its
// neighbours.
Decimal times_degree(Decimal decimal)
{
    constexpr size_t digits_that_count = 800;
    decimal.digits.erase(0, decimal.digits.find_first_not_of('0'));
    if (decimal.digits.size() > digits_that_count) {
        decimal.power += static_cast<int64_t>(decimal.digits.size() - digits_that_count);
        decimal.digits.resize(digits_that_count);
    }
    std::vector<int> product(decimal.digits.size() + degree_digits.size(), 0); // most significant first
    for (size_t i = 0; i < decimal.digits.size(); ++i)
        for (size_t j = 0; j < degree_digits.size(); ++j)
            product[i + j + 1] += (decimal.digits[i] - '0') * (degree_digits[j] - '0');
    for (size_t i = product.size(); i-- > 1; product[i] %= 10) product[i - 1] += product[i] / 10;
    Decimal result{{}, decimal.power + degree_power_of_ten};
    for (const int digit : product) result.digits += static_cast<char>('0' + digit);
    return result;
}

// Nearest f64; infinity above the largest.
double round_to_f64(const Decimal& decimal)
{
    const size_t leading = decimal.digits.find_first_not_of('0');
    if (leading == std::string::npos) return 0;
    const std::string text = decimal.digits.substr(leading) + "e" + std::to_string(decimal.power);
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc::result_out_of_range) return value;
    const int64_t magnitude = static_cast<int64_t>(decimal.digits.size() - leading) + decimal.power;
    return magnitude > 0 ? std::numeric_limits<double>::infinity() : 0.0;
}

uint64_t read_digits(std::string_view digits, int base, std::string& error)
{
    uint64_t value = 0;
    const auto [end, status] = std::from_chars(digits.data(), digits.data() + digits.size(), value, base);
    if (status == std::errc::result_out_of_range) return std::numeric_limits<uint64_t>::max();
    if (end != digits.data() + digits.size() || digits.empty()) error = "expected hexadecimal digits after '0x'";
    return value;
}

Number read_hex(std::string_view text)
{
    Number number;
    std::string_view digits = text.substr(2);
    const bool is_unsigned = digits.ends_with('u') || digits.ends_with('U');
    if (is_unsigned) digits.remove_suffix(1);
    number.kind = is_unsigned ? Number::Kind::unsigned_integer : Number::Kind::integer;
    number.integer = read_digits(digits, 16, number.error);
    number.value = static_cast<double>(number.integer);
    return number;
}

const Unit* unit_named(std::string_view name)
{
    const auto found = std::ranges::find(units, name, &Unit::name);
    return found == std::end(units) ? nullptr : found;
}

std::string hint_at_units(std::string_view suffix)
{
    if (suffix.starts_with("\xC2\xB5") || suffix.starts_with("\xCE\xBC")) return "write um for micrometres"; // both mu
    std::vector<std::string_view> names;
    for (const Unit& unit : units) names.push_back(unit.name);
    const std::string guess(near_name(suffix, names).name);
    return (guess.empty() ? "" : "did you mean '" + guess + "'? ") +
           "units are m, cm, mm, um, nm, deg, rad, s, ms, Hz and kHz";
}

} // namespace

Number read_number(std::string_view text)
{
    if (text.starts_with("0x") || text.starts_with("0X")) return read_hex(text);

    Number number;
    size_t at = 0;
    const auto peek = [&](size_t ahead = 0) { return at + ahead < text.size() ? text[at + ahead] : '\0'; };
    const auto take_digits = [&] {
        const size_t begin = at;
        while (is_digit(peek())) ++at;
        return text.substr(begin, at - begin);
    };
    const std::string_view whole = take_digits();
    bool is_real = peek() == '.';
    if (is_real) ++at;
    const std::string_view fraction = is_real ? take_digits() : std::string_view{};
    Decimal decimal{std::string(whole) + std::string(fraction), -static_cast<int64_t>(fraction.size())};
    if (decimal.digits.empty()) {
        number.error = "expected a number";
        return number;
    }
    const size_t sign = peek(1) == '+' || peek(1) == '-' ? 1 : 0;
    if ((peek() == 'e' || peek() == 'E') && is_digit(peek(1 + sign))) {
        is_real = true;
        const bool negative = peek(1) == '-';
        int64_t exponent = 0;
        at += 1 + sign;
        for (const char digit : take_digits())
            exponent = std::min<int64_t>(exponent * 10 + (digit - '0'), 1'000'000'000);
        decimal.power += negative ? -exponent : exponent;
    }

    const std::string_view suffix = text.substr(at);
    const bool has_e = suffix.starts_with('e') || suffix.starts_with('E');
    if (has_e && suffix.substr(1).find_first_not_of("+-") == suffix.npos) {
        number.error = "expected digits behind the exponent's '" + std::string(suffix) + "'";
        number.hint = "a thousandth is 1e-3";
        return number;
    }
    const bool is_unsigned = suffix == "u" || suffix == "U";
    if (const Unit* unit = unit_named(suffix)) {
        number.unit = suffix;
        decimal.power += unit->power_of_ten;
    } else if (is_unsigned && is_real) {
        number.error = "a number with a fraction or exponent cannot be unsigned";
    } else if (is_unsigned || (suffix.empty() && !is_real)) {
        number.kind = is_unsigned ? Number::Kind::unsigned_integer : Number::Kind::integer;
        number.integer = read_digits(decimal.digits, 10, number.error);
        if (whole.size() > 1 && whole[0] == '0') {
            number.error = "a whole number does not start with 0";
            number.hint = "there are no octal numbers; leave the 0 out";
        }
    } else if (!suffix.empty() && suffix != "f" && suffix != "F" && suffix != "lf" && suffix != "LF") {
        number.code = "unknown-unit";
        number.error = "unknown unit '" + printable(suffix) + "'";
        number.hint = hint_at_units(suffix);
    }
    number.value = round_to_f64(suffix == "deg" ? times_degree(decimal) : decimal);
    if (std::isinf(number.value)) {
        number.error = "this number is too large";
        number.value = std::numeric_limits<double>::max();
    }
    return number;
}

std::string_view si_unit(std::string_view unit)
{
    const Unit* known = unit_named(unit);
    return known ? known->si : std::string_view{};
}

} // namespace haptel::lang
