// Text to tokens. Takes any bytes: what cannot be a token is reported once per run and becomes one `invalid` token, at
// which the parser stays silent.
#pragma once

#include "lang/text/diagnostic.h"
#include "lang/text/limits.h"
#include "lang/text/source.h"

#include <set>
#include <string_view>
#include <vector>

namespace haptel::lang {

enum class Token : uint8_t {
    end,     // last token of every file, empty span
    invalid, // already reported
    name,
    number,   // with its unit suffix; not yet converted
    string,   // with its quotes
    define,   // "#define", with a value behind its name
    line_end, // of that
#define SYMBOL(name, spelling) name,
#define KEYWORD(name, spelling) name,
#include "lang/text/token.def"
#undef SYMBOL
#undef KEYWORD
};

// Whether a token is a bracket of any kind.
constexpr bool opens(Token kind)
{
    return kind == Token::left_paren || kind == Token::left_bracket || kind == Token::left_brace;
}
constexpr bool closes(Token kind)
{
    return kind == Token::right_paren || kind == Token::right_bracket || kind == Token::right_brace;
}

// "';'", "'texture'", "a name": for messages.
std::string_view describe(Token token);

struct PlacedToken {
    Token kind = Token::end;
    uint32_t begin = 0, end = 0; // bytes of the file
};

// A "///" line. It documents the token that follows it.
struct DocLine {
    Span span;             // without the line end
    uint32_t before_token; // index of the token after it
};

struct TokenList {
    std::vector<PlacedToken> tokens; // ends with Token::end
    std::vector<DocLine> docs;
    size_t count = 0;                      // of tokens, but for the last, and of comments
    bool has_directives = false;           // lines that begin with '#': not all of the text is in the tokens
    std::set<std::string_view> asked = {}; // names in those that choose text
};

// Stops early once `diagnostics` is full. More than `room` tokens and comments are an error, and none of them is kept.
TokenList lex(const SourceSet& sources, uint32_t file, Diagnostics& diagnostics, size_t room = tokens_max);

// Only the bytes of `part`: for what is written inside a comment.
TokenList lex(const SourceSet& sources, Span part, Diagnostics& diagnostics);

} // namespace haptel::lang
