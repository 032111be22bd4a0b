// Facts of functions and textures as they are measured, in the words of a doc comment: a proposal to be confirmed by
// who knows the function, since a search proves nothing.
#pragma once

#include "jit/check/measure_facts.h"
#include "tools/arguments/texture_argument.h"
#include "tools/output/json.h"

#include <optional>
#include <string>
#include <vector>

namespace haptel::tools {

struct SuggestionOptions {
    double least = -8, greatest = 8; // of each component of a function's first argument
    double box_m = 0.05;             // of a texture: side of the cube round the origin
    double footprint_m = 0;
    uint32_t points = jit::default_search_points;
    uint64_t seed = 1;
    ParameterTexts values; // of further parameters, by name
};

struct Suggestion {
    std::string file, name;
    std::string head;    // "float ring(float x)", or "texture rock"
    std::string skipped; // why nothing was measured; empty: it was
    std::string where;   // "over -8 .. 8"
    jit::MeasuredFacts facts;
    bool is_texture = false;

    std::string text() const; // lines to put above the function, each behind "/// ", and its head
    Json to_json() const;
};

// "@facts value -1 .. 1, slope 6.284, curvature 39.48, class C1": four digits, outward.
std::string facts_line(const jit::MeasuredFacts& facts);

// Of the functions and textures of a file, or of the one of that name. What does not compile is said on standard error,
// and nothing is suggested.
std::vector<Suggestion> suggest_facts(const std::string& file, const std::string& name,
                                      const SuggestionOptions& options);

} // namespace haptel::tools
