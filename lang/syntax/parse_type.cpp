// Names, and types as they are written.
#include "lang/syntax/grammar.h"

#include <algorithm>

namespace haptel::lang {

using namespace ast;

bool is_own_type(std::string_view word)
{
    return word == any_size || std::ranges::find(own_types, word) != std::end(own_types);
}

bool is_type_word(std::string_view word)
{
    return is_own_type(word) || foreign_word(ForeignKind::type, word);
}

Name Grammar::name(std::string_view what)
{
    Name result{std::string(text()), span()};
    if (accept(Token::name)) return result;
    const bool is_word = kind() >= Token::kw_texture;
    Diagnostic& reported = error(span(), "syntax", "expected a name " + std::string(what) + found());
    if (is_word) reported.hint = "'" + result.text + "' is a word of the language and cannot be a name";
    return {};
}

Name Grammar::name_after(TypeName& type)
{
    if (at(Token::star) || at(Token::ampersand))
        error(span(), "no-pointers", "there are no pointers or references in Haptel");
    Name result = name("after '" + type.base.text + "'");
    if (is_own_type(result.text) && !type.is_array && !is_type_word(type.base.text)) { // "cell float"
        diagnostics.error(since(type.base.span), "syntax", "the type comes first",
                          "write " + result.text + " " + type.base.text);
        std::swap(type.base, result);
    }
    return result;
}

// type = name ["[" [expression] "]" ["[" [expression] "]"]]
TypeName Grammar::type_name()
{
    TypeName type;
    skip_foreign_qualifiers();
    type.base = at_prefixed_type() ? prefixed_name() : name("of a type");
    if (type.base.text.empty()) return type;
    if (const ForeignWord* foreign = foreign_word(ForeignKind::type, type.base.text)) {
        if (type.base.span.begin != told_type) {
            Diagnostic& reported = diagnostics.error(type.base.span, "foreign-word",
                                                     "'" + type.base.text + "' is not a type of Haptel", foreign->hint);
            if (!foreign->replacement.empty() && foreign->is_exact)
                reported.fix = FixIt{type.base.span, std::string(foreign->replacement)};
        }
        if (!foreign->replacement.empty()) type.base.text = foreign->replacement;
    }
    skip_type_arguments();
    array_suffix(type);
    return type;
}

// As in GLSL "float[4] a[3]" is "float a[3][4]".
void Grammar::array_suffix(TypeName& type)
{
    std::vector<std::shared_ptr<ArraySize>> sizes; // null: it is counted
    const size_t known = type.has_rows ? 2 : type.is_array ? 1 : 0;
    while (at(Token::left_bracket)) {
        const Span opener = span();
        if (sizes.size() + known == 2) {
            error(opener, "nested-table", "tables have at most two dimensions",
                  "write the rows one behind the other and index by row * columns + column");
            type.base.text.clear(); // of no type: nothing more is said about it
        }
        const Nesting nesting(*this, Nesting::bracket);
        advance();
        sizes.push_back(nullptr);
        if (!at(Token::right_bracket)) sizes.back() = std::make_shared<ArraySize>(ArraySize{expression(), false, {}});
        close(Token::right_bracket, opener);
    }
    if (sizes.empty()) return;
    if (type.is_array) sizes.push_back(type.array_size);
    type.is_array = true;
    type.array_size = sizes[0];
    type.has_rows |= sizes.size() > 1;
    if (sizes.size() > 1) type.row_size = sizes[1];
}

} // namespace haptel::lang
