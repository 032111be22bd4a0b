// Words of other shading languages that Haptel spells differently or does without, and what to write instead.
#pragma once

#include <string_view>

namespace haptel::lang {

enum class ForeignKind {
    type,
    function,
    name,
    operation, // "and" between operands, "not" before one
    statement,
    qualifier,   // before a type
    declaration, // at the top of a file
};

struct ForeignWord {
    ForeignKind kind;
    std::string_view word;
    // What can stand in its place; empty: nothing that is sure to mean the same. Of a function it may be a whole
    // expression, "clamp($1, 0.0, 1.0)", of its arguments.
    std::string_view replacement;
    std::string_view hint; // what to write instead
};

// Null if `word` is not known as such a word.
const ForeignWord* foreign_word(ForeignKind kind, std::string_view word);

} // namespace haptel::lang
