// What there is to call, as data: the standard library's documented functions, from its own text, and the built-ins.
#pragma once

#include "tools/output/json.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace haptel::tools {

struct Facts {
    std::optional<double> value_minimum, value_maximum, slope, curvature;
    std::string continuity; // empty: not given
    std::string text;       // as written behind @facts
};

struct Overload {
    std::string signature; // "float perlin(vec3 q, int seed)"
    std::string doc;       // lines; the same for all overloads of a built-in
    std::optional<Facts> facts;
};

// A texture of the library's tests that calls a function: "stdlib/tests/FILE.haptel".
struct Example {
    std::string file, texture; // file without folder and ".haptel"
    std::string text;
    bool has_picture = true; // shows something in a plot
};

struct Entry {
    std::string name;
    std::string group; // file of the library without ".haptel", or "built in"
    std::vector<Overload> overloads;
    std::optional<Example> example;
    std::string summary() const; // first sentence of its doc
};

// In the order of the library's files, then the built-ins in theirs. Functions without a doc comment are the library's
// own.
std::vector<Entry> reference();

inline constexpr std::string_view built_in_group = "built in";

Json to_json(const Entry& entry);
std::string to_list(const std::vector<Entry>& entries); // a line each
std::string to_text(const Entry& entry);
std::string to_markdown(const std::vector<Entry>& entries); // the page docs/stdlib.md

} // namespace haptel::tools
