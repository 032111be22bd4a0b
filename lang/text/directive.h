// Lines that begin with '#', as other shading languages write them: which of the text such lines leave out.
//
// #define and #undef are left to the grammar (parse_macro.cpp), since a value must be an expression here; #ifdef,
// #ifndef, #if and #elif with a condition of whole numbers, #else and #endif choose text; #version, #extension, #pragma
// and #line change nothing.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string_view>
#include <vector>

namespace haptel::lang {

class Conditions {
public:
    void define(std::string_view name, std::string_view value) { values.insert_or_assign(name, value); }
    void undefine(std::string_view name) { values.erase(name); }
    // What "#ifdef A", "#if !defined(A) && B > 2" say; nothing: it is something else. `line` without a comment.
    std::optional<bool> chosen(std::string_view word, std::string_view line) const;

    struct Open {                    // a choice whose end has not been met
        uint32_t begin = 0, end = 0; // of its word
        bool is_taken = false;       // one of its parts so far
    };
    std::vector<Open> open; // innermost last

private:
    class Reader;
    // Of values that conditions of this text may still read: a name may stand for two, and each of these for two.
    mutable uint32_t characters_left = 1 << 20;
    std::map<std::string_view, std::string_view> values{
        {"__VERSION__", "300"}}; // of GLSL: the language is nearest to that
};

} // namespace haptel::lang
