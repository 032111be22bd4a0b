#include "lang/text/directive.h"

#include "lang/text/number.h"

#include <algorithm>
#include <charconv>
#include <iterator>

namespace haptel::lang {
namespace {

bool is_part_of_name(char c)
{
    return c == '_' || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || is_digit(c);
}

constexpr uint32_t nesting_max = 64; // of parentheses, and of names that stand for names

struct Operator {
    std::string_view text;
    int precedence;
};
// Longer ones before those that they begin with.
constexpr Operator operators[] = {{"||", 1}, {"&&", 2}, {"==", 6}, {"!=", 6}, {"<=", 7}, {">=", 7},
                                  {"<<", 8}, {">>", 8}, {"|", 3},  {"^", 4},  {"&", 5},  {"<", 7},
                                  {">", 7},  {"+", 9},  {"-", 9},  {"*", 10}, {"/", 10}, {"%", 10}};

} // namespace

// What stands behind "#if": whole numbers, names, which are what #define says or 0, and operators, as in C.
class Conditions::Reader {
public:
    Reader(const Conditions& known, std::string_view line, uint32_t depth) : names(known), text(line), nesting(depth) {}

    std::optional<int64_t> whole()
    {
        const int64_t value = binary(1);
        skip_spaces();
        return is_sound && at == text.size() ? std::optional(value) : std::nullopt;
    }

private:
    void skip_spaces()
    {
        for (;;) {
            while (at < text.size() && std::string_view(" \t\r\n\\").find(text[at]) != text.npos) ++at;
            if (!text.substr(at).starts_with("/*")) return;
            at = std::min(text.find("*/", at + 2), text.size() - 2) + 2;
        }
    }
    bool take(std::string_view word)
    {
        skip_spaces();
        if (!text.substr(at).starts_with(word)) return false;
        at += word.size();
        return true;
    }
    int64_t fail()
    {
        is_sound = false;
        return 0;
    }

    int64_t binary(int lowest)
    {
        int64_t left = unary();
        while (is_sound) {
            skip_spaces();
            const auto is_next = [&](const Operator& one) { return text.substr(at).starts_with(one.text); };
            const auto op = std::ranges::find_if(operators, is_next);
            if (op == std::end(operators) || op->precedence < lowest) break;
            at += op->text.size();
            const bool is_decided = op->text == "&&" ? !left : op->text == "||" && left;
            unread += is_decided;
            left = applied(op->text, left, binary(op->precedence + 1));
            unread -= is_decided;
        }
        return left;
    }

    int64_t applied(std::string_view op, int64_t a, int64_t b)
    {
        const auto wrapped = [](uint64_t value) { return static_cast<int64_t>(value); };
        const auto x = static_cast<uint64_t>(a), y = static_cast<uint64_t>(b);
        if (op == "||") return a || b;
        if (op == "&&") return a && b;
        if (op == "==") return a == b;
        if (op == "!=") return a != b;
        if (op == "<=") return a <= b;
        if (op == ">=") return a >= b;
        if (op == "<") return a < b;
        if (op == ">") return a > b;
        if (op == "+") return wrapped(x + y);
        if (op == "-") return wrapped(x - y);
        if (op == "*") return wrapped(x * y);
        if (op == "&") return a & b;
        if (op == "|") return a | b;
        if (op == "^") return a ^ b;
        if (op == "<<") return y < 64 ? wrapped(x << y) : 0;
        if (op == ">>") return y < 64 ? a >> y : a < 0 ? -1 : 0;
        if (b == 0) return unread > 0 ? 0 : fail();
        if (b == -1) return op == "/" ? wrapped(0 - x) : 0;
        return op == "/" ? a / b : a % b;
    }

    int64_t unary()
    {
        if (++nesting > nesting_max) return fail();
        const int64_t value = inner();
        --nesting;
        return value;
    }
    int64_t inner()
    {
        if (take("!")) return !unary();
        if (take("-")) return static_cast<int64_t>(0 - static_cast<uint64_t>(unary()));
        if (take("+")) return unary();
        if (take("~")) return ~unary();
        if (take("(")) {
            const int64_t value = binary(1);
            return take(")") ? value : fail();
        }
        skip_spaces();
        const size_t begin = at;
        while (at < text.size() && is_part_of_name(text[at])) ++at;
        const std::string_view word = text.substr(begin, at - begin);
        if (word.empty()) return fail();
        return is_digit(word[0]) ? number(word) : word == "defined" ? is_defined() : value_of(word);
    }
    int64_t is_defined()
    {
        const bool is_open = take("(");
        skip_spaces();
        const size_t begin = at;
        while (at < text.size() && is_part_of_name(text[at])) ++at;
        const std::string_view name = text.substr(begin, at - begin);
        if (name.empty() || is_digit(name[0]) || (is_open && !take(")"))) return fail();
        return names.values.contains(name);
    }
    int64_t number(std::string_view word)
    {
        const bool is_hex = word.starts_with("0x") || word.starts_with("0X");
        if (is_hex) word.remove_prefix(2);
        while (!word.empty() && std::string_view("uUlL").find(word.back()) != word.npos) word.remove_suffix(1);
        int64_t value = 0;
        const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value,
                                                  is_hex                  ? 16
                                                  : word.starts_with('0') ? 8
                                                                          : 10);
        return error == std::errc() && end == word.data() + word.size() ? value : fail();
    }
    int64_t value_of(std::string_view name)
    {
        const auto known = names.values.find(name);
        if (known == names.values.end() || unread > 0) return 0;
        if (names.characters_left < known->second.size() + 1) return fail();
        names.characters_left -= static_cast<uint32_t>(known->second.size()) + 1;
        const auto value = Reader(names, known->second, nesting + 1).whole();
        return value ? *value : fail();
    }

    const Conditions& names;
    const std::string_view text;
    size_t at = 0;
    uint32_t nesting;
    uint32_t unread = 0; // operators round it whose left side has decided
    bool is_sound = true;
};

std::optional<bool> Conditions::chosen(std::string_view word, std::string_view line) const
{
    const size_t first = line.find_first_not_of(" \t"), last = line.find_last_not_of(" \t\r");
    const std::string_view asked = first == line.npos ? "" : line.substr(first, last - first + 1);
    if (word == "#ifdef") return values.contains(asked);
    if (word == "#ifndef") return !values.contains(asked);
    const std::optional<int64_t> value = Reader(*this, asked, 0).whole();
    return value ? std::optional(*value != 0) : std::nullopt;
}

} // namespace haptel::lang
