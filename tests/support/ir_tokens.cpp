#include "tests/support/ir_tokens.h"

namespace haptel::ir {

std::vector<Token> tokenize(std::string_view text)
{
    std::vector<Token> tokens;
    int line = 1;
    auto is_word = [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '.' ||
               c == '+' || c == '-' || c == ':';
    };
    for (size_t i = 0; i < text.size();) {
        char c = text[i];
        if (c == '\n') ++line;
        if (c == '#')
            while (i < text.size() && text[i] != '\n') ++i;
        else if (c == ' ' || c == '\t' || c == '\r' || c == '\n')
            ++i;
        else if (c == '"') {
            Token token{Token::Kind::string, "", line};
            for (++i; i < text.size() && text[i] != '"'; ++i) {
                if (text[i] == '\n') ++line;
                if (text[i] == '\\' && i + 1 < text.size()) {
                    ++i;
                    token.text += text[i] == 'n' ? '\n' : text[i];
                } else
                    token.text += text[i];
            }
            ++i;
            tokens.push_back(std::move(token));
        } else if (c == ':' || !is_word(c)) {
            if (c == '%') {
                size_t end = ++i;
                while (end < text.size() && is_word(text[end]) && text[end] != ':') ++end;
                tokens.push_back({Token::Kind::value, std::string(text.substr(i, end - i)), line});
                i = end;
            } else {
                tokens.push_back({Token::Kind::mark, std::string(1, c), line});
                ++i;
            }
        } else {
            size_t end = i;
            while (end < text.size() && is_word(text[end])) ++end;
            tokens.push_back({Token::Kind::word, std::string(text.substr(i, end - i)), line});
            i = end;
        }
    }
    tokens.push_back({Token::Kind::end, "", line});
    return tokens;
}

} // namespace haptel::ir
