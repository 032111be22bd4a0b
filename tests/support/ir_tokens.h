// Words of the IR's text form.
#pragma once

#include <bit>
#include <charconv>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace haptel::ir {

struct Token {
    enum class Kind { end, word, string, value, mark } kind = Kind::end; // numbers are words
    std::string text;
    int line = 1;
};

std::vector<Token> tokenize(std::string_view text);

struct Failure {
    std::string message;
};

// One token at a time; what does not fit is a Failure.
class TokenReader {
protected:
    explicit TokenReader(std::string_view text) : tokens(tokenize(text)) {}

    std::vector<Token> tokens;
    size_t next = 0;

    const Token& token() const { return tokens[next]; }
    std::string found() const { return token().kind == Token::Kind::end ? "the end" : "'" + token().text + "'"; }
    [[noreturn]] void fail(std::string message) const { throw Failure{std::move(message)}; }

    bool is(std::string_view text) const
    {
        return (token().kind == Token::Kind::word || token().kind == Token::Kind::mark) && token().text == text;
    }
    bool accept(std::string_view text)
    {
        if (!is(text)) return false;
        ++next;
        return true;
    }
    void expect(std::string_view text)
    {
        if (!accept(text)) fail("expected '" + std::string(text) + "', found " + found());
    }
    std::string take(Token::Kind kind, std::string_view what)
    {
        if (token().kind != kind) fail("expected " + std::string(what) + ", found " + found());
        return tokens[next++].text;
    }
    std::string string() { return take(Token::Kind::string, "a name in quotes"); }

    template <typename Number>
    Number number(std::string_view what)
    {
        if (token().kind != Token::Kind::word) fail("expected " + std::string(what) + ", found " + found());
        const std::string& text = token().text;
        Number value{};
        auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (error != std::errc() || end != text.data() + text.size())
            fail("expected " + std::string(what) + ", found " + found());
        ++next;
        return value;
    }
    uint32_t count() { return number<uint32_t>("a count"); }
    double real()
    {
        if (token().kind == Token::Kind::word && token().text.starts_with("nan:")) {
            uint64_t bits = 0;
            const std::string& text = token().text;
            std::from_chars(text.data() + 4, text.data() + text.size(), bits, 16);
            ++next;
            return std::bit_cast<double>(bits);
        }
        return number<double>("a number");
    }
};

} // namespace haptel::ir
