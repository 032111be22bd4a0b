// Words of other shading languages that Haptel spells differently or does without, and what to write instead.
#pragma once

#include <string_view>

namespace haptel::lang {

enum class ForeignKind { type, function, statement, declaration };

struct ForeignWord {
    ForeignKind kind;
    std::string_view word;
    std::string_view replacement; // a word that can stand in its place; empty: none
    std::string_view hint;        // what to write instead
};

// Null if `word` is not known as such a word.
const ForeignWord* foreign_word(ForeignKind kind, std::string_view word);

} // namespace haptel::lang
