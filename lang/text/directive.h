// Lines that begin with '#', as other shading languages write them: which of the text such lines leave out.
//
// #define and #undef are left to the grammar (parse_macro.cpp), since a value must be an expression here; #ifdef,
// #ifndef, #if with 0, 1 or defined(NAME), #else and #endif choose text; #version, #extension, #pragma and #line change
// nothing.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string_view>
#include <vector>

namespace haptel::lang {

class Conditions {
public:
    void define(std::string_view name) { defined.insert(name); }
    void undefine(std::string_view name) { defined.erase(name); }
    // What "#ifdef A", "#if !defined(A)", "#if 0" say; nothing: it is something else. `line` without a comment.
    std::optional<bool> chosen(std::string_view word, std::string_view line) const;

    struct Open {                    // a choice whose end has not been met
        uint32_t begin = 0, end = 0; // of its word
        bool is_taken = false;       // one of its parts so far
    };
    std::vector<Open> open; // innermost last

private:
    std::set<std::string_view> defined;
};

} // namespace haptel::lang
