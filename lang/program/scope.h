// Where names are looked up: the declarations of each file, and what of them a file sees.
#pragma once

#include "lang/program/builtins.h"
#include "lang/syntax/resolution.h"

#include <map>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace haptel::lang {

// Global names of one file, or of the whole library.
struct Declarations {
    std::map<std::string, std::vector<FunctionInfo*>, std::less<>> functions;
    std::map<std::string, const Symbol*, std::less<>> constants; // those above the place that is being checked
    std::set<std::string, std::less<>> constant_names;           // all, for a hint
    bool lacks_functions = false;                                // some could not be read
    std::set<std::string, std::less<>> unread;                   // names where declarations could not be read
};

// A function that a call may mean.
struct Candidate {
    FunctionReference function;
    Type result;
    std::span<const ParameterInfo> parameters;
    uint32_t layer = 0; // of the scope it was found in, nearest first
};

Candidate candidate_of(const FunctionInfo& function);
Candidate candidate_of(const BuiltinOverload& overload);
Candidate candidate_of(const Symbol& function_parameter);

// "fbm"; empty for no function.
std::string name_of(const FunctionReference& function);
// "float fbm(vec3 q, int octaves)", for messages.
std::string to_string(const Candidate& candidate);
// "fbm(vec3,int)": name and types, as overloads are told apart.
std::string signature_of(const FunctionInfo& function);

// What one file sees: its own declarations first, then imports, then the library; the language's built-ins last.
class FileScope {
public:
    void add_layer(const Declarations& declarations) { layers.push_back(&declarations); }

    const Symbol* constant(std::string_view name) const;
    bool declares_constant_later(std::string_view name) const; // asked where constant(name) has found none
    bool is_function(std::string_view name) const;
    // Every function of that name; of equal signatures only the nearest, so that a file may replace what it imports.
    std::vector<Candidate> functions(std::string_view name) const;

    bool lacks_functions() const;                    // an unknown function may be one that could not be read
    bool may_be_unread(std::string_view name) const; // likewise a constant

    void collect_function_names(std::vector<std::string_view>& names) const;
    void collect_constant_names(std::vector<std::string_view>& names) const;

private:
    std::vector<const Declarations*> layers; // nearest first
};

} // namespace haptel::lang
