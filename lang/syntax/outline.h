// What stands at the top of a file and under which names, before anything is parsed: so that of a long library only
// what a program names need be.
#pragma once

#include "lang/text/lexer.h"

#include <string_view>
#include <vector>

namespace haptel::lang {

class Outline {
public:
    // Names are views into the file's text, which outlives them.
    Outline(const SourceSet& sources, uint32_t file, TokenList tokens);

    // A declaration: tokens [begin, end) of the list.
    struct Part {
        size_t begin = 0, end = 0;
        std::vector<std::string_view> names; // declared here; some that are only read at the top may be among them
    };
    std::vector<Part> parts; // in the order of the text; nothing stands between them
    std::vector<std::string_view> mentions(const Part& part) const; // every name in it

    // The tokens of some parts, as of a file that holds nothing else: `wanted` by part. Places stay what they were.
    TokenList tokens_of(const std::vector<bool>& wanted) const;

private:
    std::string_view text;
    TokenList list;

    std::string_view text_of(const PlacedToken& token) const
    {
        return text.substr(token.begin, token.end - token.begin);
    }
};

} // namespace haptel::lang
