// Where names are looked up: the declarations of each file, and what of them a file sees.
#pragma once

#include "lang/program/builtins.h"
#include "lang/syntax/ast.h"
#include "lang/syntax/resolution.h"

#include <map>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace haptel::lang {

// A struct of the source. Its members are looked up when it is first named, so that it may hold one that stands below.
struct StructDeclaration {
    const ast::Struct* tree;
    StructInfo info = {};
    enum class State : uint8_t { untouched, in_work, done } state = State::untouched;
    bool is_valid = true; // false: it has mistakes, and values of it are not checked
};

// Global names of one file, or of the whole library.
struct Declarations {
    std::map<std::string, StructDeclaration*, std::less<>> structs;
    std::map<std::string, std::vector<FunctionInfo*>, std::less<>> functions;
    std::map<std::string, FunctionInfo*, std::less<>> textures;  // as functions
    std::map<std::string, const Symbol*, std::less<>> constants; // those above the place that is being checked
    std::set<std::string, std::less<>> constant_names;           // all, for a hint
    bool lacks_functions = false;                                // some could not be read
    std::set<std::string, std::less<>> unread;                   // names where declarations could not be read
};

// A function that a call may mean.
struct Candidate {
    explicit Candidate(const FunctionInfo& f) : function(&f), result(f.result), parameters(f.parameters) {}
    explicit Candidate(const BuiltinOverload& f) : function(&f), result(f.result), parameters(f.parameters) {}
    explicit Candidate(const Symbol& parameter) // that is a function
        : function(&parameter), result(parameter.type), parameters(parameter.parameters)
    {
    }

    FunctionReference function;
    Type result;
    std::span<const ParameterInfo> parameters;
};

// "fbm"; empty for no function.
std::string name_of(const FunctionReference& function);
// "float fbm(vec3 q, int octaves)", for messages.
std::string to_string(const Candidate& candidate);
// "float", "float(vec3)", "float f(vec3)"
std::string to_string(const ParameterInfo& parameter, const std::string& name = {}, std::string_view separator = ", ");
// "fbm(vec3,int)": name and types, as overloads are told apart.
std::string signature_of(const FunctionInfo& function);

// "oak.rings" is the name "rings" behind the prefix of an import; a name without one has no prefix.
struct PrefixedName {
    explicit PrefixedName(std::string_view written);
    std::string_view prefix, name;
};

// What one file sees: its own declarations first, then imports, then the library; the language's built-ins last. Behind
// the prefix of an import stand the declarations of that file and nothing else.
struct FileScope {
    std::vector<const Declarations*> layers;                           // nearest first
    std::map<std::string, const Declarations*, std::less<>> by_prefix; // null: the file could not be read

    // Every function of that name; of equal signatures only the nearest, so that a file may replace what it imports.
    std::vector<Candidate> functions(std::string_view name) const;
    FunctionInfo* texture(std::string_view name) const;        // null: none has that name
    StructDeclaration* structure(std::string_view name) const; // likewise
    const Symbol* constant(std::string_view name) const;       // likewise
    bool is_unread(std::string_view name) const;               // it may be declared in text that could not be read
    bool may_be_function(std::string_view name) const;         // likewise, and nothing is known of its head
    bool is_constant_below(std::string_view name) const;       // it is declared, but not yet
    // Those that a name with this prefix may be found in, nearest first.
    std::span<const Declarations* const> layers_of(std::string_view prefix) const;
};

} // namespace haptel::lang
