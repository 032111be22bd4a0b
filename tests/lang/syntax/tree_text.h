// The tree as text, so that a test of the parser is one screen: text in, text out. Prefix form: "a + b * 2" is
// (+ a (* b 2)); a chain is flat: "a + b - c" is (+ a b - c).
#pragma once

#include "lang/syntax/ast.h"
#include "lang/text/diagnostic.h"

#include <string>
#include <string_view>

namespace haptel::lang {

std::string tree_text(const ast::Expression& expression);
std::string tree_text(const ast::Statement& statement);
std::string tree_text(const ast::File& file);

struct Parsed {
    SourceSet sources;
    Diagnostics diagnostics;
    ast::File file;
    std::string
    messages() const; // "line:column-end_column code: message" per line; the end only where it differs by more than 1
};

Parsed parse_text(std::string_view text);

// The tree of an expression, or the messages if there are any.
std::string expression_tree(std::string_view text);
// Of the statements of a body.
std::string body_tree(std::string_view text);

} // namespace haptel::lang
