#include "lang/syntax/outline.h"

#include "lang/syntax/grammar.h"

#include <utility>

namespace haptel::lang {

// A part ends at the ';' or, but for constants, at the '}' that stands in no bracket. Where brackets do not fit, parts
// are few and long.
Outline::Outline(const SourceSet& sources, uint32_t file, TokenList tokens)
    : text(sources.file(file).text), list(std::move(tokens))
{
    Part part;
    int64_t depth = 0;
    for (size_t i = 0; list.tokens[i].kind != Token::end; ++i) {
        const PlacedToken& token = list.tokens[i];
        if (opens(token.kind)) ++depth;
        if (closes(token.kind)) --depth;
        if (depth != 0) continue;
        if (token.kind == Token::name && !is_own_type(text_of(token))) part.names.push_back(text_of(token));
        const bool is_constant = list.tokens[part.begin].kind == Token::kw_const;
        if (token.kind != Token::semicolon && (token.kind != Token::right_brace || is_constant)) continue;
        part.end = i + 1;
        parts.push_back(std::exchange(part, {i + 1, 0, {}}));
    }
    part.end = list.tokens.size() - 1;
    if (part.begin < part.end) parts.push_back(std::move(part));
}

std::vector<std::string_view> Outline::mentions(const Part& part) const
{
    std::vector<std::string_view> names;
    for (size_t i = part.begin; i < part.end; ++i)
        if (list.tokens[i].kind == Token::name) names.push_back(text_of(list.tokens[i]));
    return names;
}

TokenList Outline::tokens_of(const std::vector<bool>& wanted) const
{
    TokenList some;
    auto doc = list.docs.begin();
    for (size_t i = 0; i < parts.size(); ++i) {
        if (!wanted[i]) continue;
        const Part& part = parts[i];
        while (doc != list.docs.end() && doc->before_token < part.begin) ++doc;
        for (; doc != list.docs.end() && doc->before_token < part.end; ++doc)
            some.docs.push_back(
                {doc->span, static_cast<uint32_t>(doc->before_token - part.begin + some.tokens.size())});
        some.tokens.insert(some.tokens.end(), list.tokens.begin() + static_cast<ptrdiff_t>(part.begin),
                           list.tokens.begin() + static_cast<ptrdiff_t>(part.end));
    }
    some.tokens.push_back(list.tokens.back());
    return some;
}

} // namespace haptel::lang
