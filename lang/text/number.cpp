#include "lang/text/number.h"

#include "lang/text/diagnostic.h"
#include "lang/text/near_name.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
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
constexpr std::string_view unit_list = "units are m, cm, mm, um, nm, deg, rad, s, ms, Hz and kHz";

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
    const std::string& a = decimal.digits;
    std::vector<int> product(a.size() + degree_digits.size(), 0); // least significant first
    for (size_t i = 0; i < a.size(); ++i) {
        int carry = 0;
        size_t place = a.size() - 1 - i;
        for (size_t j = degree_digits.size(); j-- > 0; ++place) {
            const int sum = product[place] + (a[i] - '0') * (degree_digits[j] - '0') + carry;
            product[place] = sum % 10;
            carry = sum / 10;
        }
        for (; carry > 0; ++place) {
            const int sum = product[place] + carry;
            product[place] = sum % 10;
            carry = sum / 10;
        }
    }
    Decimal result{{}, decimal.power + degree_power_of_ten};
    for (size_t i = product.size(); i-- > 0;) result.digits += static_cast<char>('0' + product[i]);
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
    number.kind = Number::Kind::integer;
    std::string_view digits = text.substr(2);
    if (!digits.empty() && (digits.back() == 'u' || digits.back() == 'U')) {
        number.kind = Number::Kind::unsigned_integer;
        digits.remove_suffix(1);
    }
    number.integer = read_digits(digits, 16, number.error);
    number.value = static_cast<double>(number.integer);
    return number;
}

std::string with_guess(std::string_view suffix)
{
    std::vector<std::string_view> names;
    for (const Unit& unit : units) names.push_back(unit.name);
    const std::string_view guess = nearest_name(suffix, names);
    return guess.empty() ? std::string(unit_list)
                         : "did you mean '" + std::string(guess) + "'? " + std::string(unit_list);
}

} // namespace

Number read_number(std::string_view text)
{
    if (text.starts_with("0x") || text.starts_with("0X")) return read_hex(text);

    Number number;
    Decimal decimal;
    size_t at = 0;
    const auto peek = [&](size_t ahead = 0) { return at + ahead < text.size() ? text[at + ahead] : '\0'; };
    while (is_digit(peek())) decimal.digits += text[at++];
    const size_t whole_digits = decimal.digits.size();
    bool real = false;
    if (peek() == '.') {
        real = true;
        for (++at; is_digit(peek()); ++at) {
            decimal.digits += text[at];
            --decimal.power;
        }
    }
    if (decimal.digits.empty()) {
        number.error = "expected a number";
        return number;
    }
    const size_t sign = peek(1) == '+' || peek(1) == '-' ? 1 : 0;
    if ((peek() == 'e' || peek() == 'E') && is_digit(peek(1 + sign))) {
        real = true;
        const bool negative = peek(1) == '-';
        int64_t exponent = 0;
        for (at += 1 + sign; is_digit(peek()); ++at)
            exponent = std::min<int64_t>(exponent * 10 + (text[at] - '0'), 1'000'000'000);
        decimal.power += negative ? -exponent : exponent;
    }

    const std::string_view suffix = text.substr(at);
    const bool has_e = suffix.starts_with('e') || suffix.starts_with('E');
    if (has_e && suffix.substr(1).find_first_not_of("+-") == suffix.npos) {
        number.error = "expected digits behind the exponent's '" + std::string(suffix) + "'";
        number.hint = "a thousandth is 1e-3";
        return number;
    }
    const auto unit = std::find_if(std::begin(units), std::end(units), [&](const Unit& u) { return u.name == suffix; });
    if (unit != std::end(units)) {
        number.unit = suffix;
        decimal.power += unit->power_of_ten;
        number.value = round_to_f64(suffix == "deg" ? times_degree(std::move(decimal)) : decimal);
    } else if (suffix.empty() || suffix == "u" || suffix == "U") {
        const bool is_unsigned = !suffix.empty();
        if (real && is_unsigned) number.error = "a number with a fraction or exponent cannot be unsigned";
        if (!real) {
            number.kind = is_unsigned ? Number::Kind::unsigned_integer : Number::Kind::integer;
            number.integer = read_digits(decimal.digits, 10, number.error);
            if (whole_digits > 1 && text[0] == '0') {
                number.error = "a whole number does not start with 0";
                number.hint = "there are no octal numbers; leave the 0 out";
            }
        }
        number.value = round_to_f64(decimal);
    } else if (suffix == "f" || suffix == "F" || suffix == "lf" || suffix == "LF") {
        number.value = round_to_f64(decimal);
    } else {
        number.value = round_to_f64(decimal);
        number.code = "unknown-unit";
        number.error = "unknown unit '" + printable(suffix) + "'";
        const bool micro = suffix.starts_with("\xC2\xB5") || suffix.starts_with("\xCE\xBC"); // the two Unicode letters
        number.hint = micro ? "write um for micrometres" : with_guess(suffix);
    }
    if (std::isinf(number.value)) {
        number.error = "this number is too large";
        number.value = std::numeric_limits<double>::max();
    }
    return number;
}

std::string_view si_unit(std::string_view unit)
{
    for (const Unit& known : units)
        if (known.name == unit) return known.si;
    return {};
}

} // namespace haptel::lang
