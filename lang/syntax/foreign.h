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

// Words with one meaning.
struct ForeignWord {
    ForeignKind kind;
    std::string_view words; // with a space between
    // What they are read as; empty: nothing is near enough. Of a function it may be a whole expression,
    // "clamp($1, 0.0, 1.0)", of its arguments.
    std::string_view replacement;
    std::string_view hint; // what to write instead
    bool is_exact = true;  // the replacement means the same wherever the word can stand: it may be written
};

// Null if `word` is not known as such a word.
const ForeignWord* foreign_word(ForeignKind kind, std::string_view word);

} // namespace haptel::lang
