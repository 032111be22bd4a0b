// Checks one body: of a function, of a texture, or of a global constant. One pass over its tree, in source order, with
// a little knowledge of flow: which variables are assigned for certain, and what the integers can be.
//
// check_expression.cpp, check_call.cpp, check_unknown_call.cpp, check_statement.cpp, check_array.cpp, check_loop.cpp
// and check_range.cpp hold the parts.
#pragma once

#include "lang/check/constant.h"
#include "lang/program/checked_program.h"
#include "lang/program/scope.h"
#include "lang/text/diagnostic.h"

#include <optional>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

namespace haptel::lang {

// What all bodies of a compilation share.
struct CheckContext {
    const SourceSet& sources;
    Diagnostics& diagnostics;
    CheckedProgram& program;
    ConstantEvaluator& constants;
    std::vector<const Symbol*> inputs;                    // by InputName
    std::set<std::string, std::less<>> unknown_functions; // those without a guess: each is reported once
    uint32_t near_searches = 200; // that are left: beyond, names that are unknown have no proposal
};

// 'text', as names stand in messages.
inline std::string quoted(std::string_view text)
{
    return "'" + std::string(text) + "'";
}

// The type of a name in source, or nothing if the name means no type.
std::optional<Type> type_named(std::string_view name);
// Reports what is no type; `what` it is for ("a parameter"). Arrays: the element, the caller looks at is_array.
Type resolve_type(CheckContext& context, const ast::TypeName& name);

// Where a type is named that cannot be image.
void report_image(CheckContext& context, const ast::TypeName& name);

// Parts of a variable, a bit each: components; of an array, elements.
inline constexpr uint64_t all_parts = ~uint64_t{0};
uint64_t parts_of(Type type);
uint64_t parts_at(Type type, int64_t index); // what an index picks; none if it is out of range

class BodyChecker {
public:
    BodyChecker(CheckContext& context, const FileScope& scope, bool is_library);

    void check_function(ast::Function& tree, FunctionInfo& info);
    void check_texture(ast::Texture& tree, CheckedTexture& texture);
    // Of a parameter or result: the type with the size in brackets, or the error that was reported.
    Type array_type(const ast::TypeName& name, Type element);
    // A global constant or table. Null after an error in its head.
    Symbol* check_global(ast::Declaration& declaration);
    // A constant number or bool outside of any body; nothing once a mistake was reported.
    std::optional<double> check_constant(ast::Expression& e, Type type, const std::string& where);

private:
    // The bit of a material output, HAPTEL_WRITES_*; 0 once a mistake was reported. check_texture.cpp
    uint32_t check_output(ast::TextureParameter& tree);

    struct Variable {
        uint64_t assigned = 0; // a bit per component; of an array, per element
        ir::IntRange range{INT32_MIN, INT32_MAX};
    };
    struct Flow {
        std::vector<Variable> variables; // by Symbol::slot; those declared last on a path may be missing on others
        bool reachable = true;
    };
    struct Binding {
        Symbol* symbol;
        size_t depth; // of the scope
    };
    struct Argument {
        bool is_function = false;
        std::vector<Candidate> functions; // that its name may mean
    };

    // ---- names
    void open_scope() { scope_marks.push_back(declared.size()); }
    void close_scope();
    Symbol& declare(const ast::Name& name, SymbolKind kind, Type type);
    Variable& new_variable(); // in a slot of its own
    Symbol* find_local(std::string_view name) const;
    const Symbol* find(std::string_view name) const;
    void mark_read(std::string_view name);
    void report_unused(const Symbol& symbol);
    bool may_be_unread(const std::string& name) const; // declared in text that could not be read
    void report_unknown_name(Span span, const std::string& name);

    // ---- expressions: each sets and returns the type, Type::error() once something was reported
    Type expression(ast::Expression& e);
    Type check(ast::Expression& e, ast::ErrorExpression& node);
    Type check(ast::Expression& e, ast::NumberLiteral& node);
    Type check(ast::Expression& e, ast::BoolLiteral& node);
    Type check(ast::Expression& e, ast::NameExpression& node);
    Type check(ast::Expression& e, ast::Unary& node);
    Type check(ast::Expression& e, ast::Chain& node);
    Type check(ast::Expression& e, ast::Conditional& node);
    Type check(ast::Expression& e, ast::CallExpression& node);
    Type check(ast::Expression& e, ast::GradCall& node);
    Type check(ast::Expression& e, ast::Member& node);
    Type check(ast::Expression& e, ast::Index& node);
    Type check(ast::Expression& e, ast::BraceList& node);
    Type read(ast::Expression& e, ast::NameExpression& node, uint64_t parts);
    void check_index(const ast::Expression& index, const ast::Expression& object);
    // Reports unless `e` has or becomes that type; `where` as a clause: " for 'x'".
    bool require(ast::Expression& e, Type wanted, const std::string& where);
    // Reports; the type of what is wrong.
    Type fail(Span span, ErrorCode code, std::string message, std::string_view hint = {});
    Type report_operator(ast::BinaryOp op, Span span, Type left, const ast::Expression& right);
    std::string excerpt(const ast::Expression& e) const;
    std::string operand(const ast::Expression& e) const; // to write something behind it

    // ---- calls
    Type constructor(ast::Expression& e, ast::CallExpression& call, Type type);
    std::optional<Candidate> resolve(const ast::Expression& e, const ast::Name& callee,
                                     std::vector<ast::ExpressionPtr>& arguments, uint32_t order, CallTarget& target,
                                     Type& if_unsure);
    Argument classify(ast::Expression& argument);
    const Candidate* passed_function(const Argument& argument, const ParameterInfo& parameter) const;
    std::optional<int> cost_of(const Candidate& candidate, const std::vector<ast::ExpressionPtr>& arguments,
                               const std::vector<Argument>& classes) const;
    void report_no_match(const ast::Expression& e, const ast::Name& callee,
                         const std::vector<ast::ExpressionPtr>& arguments, const std::vector<Argument>& classes,
                         const std::vector<Candidate>& candidates);
    void report_argument(const Candidate& candidate, size_t index, const ast::Expression& argument,
                         const Argument& argument_class);
    void report_unknown_function(const ast::Expression& e, const ast::Name& callee,
                                 const std::vector<ast::ExpressionPtr>& arguments,
                                 const std::vector<Argument>& classes);
    bool takes(std::string_view function, const std::vector<ast::ExpressionPtr>& arguments,
               const std::vector<Argument>& classes) const;
    std::optional<std::string> filled_in(std::string_view pattern,
                                         const std::vector<ast::ExpressionPtr>& arguments) const;

    // ---- statements
    void statement(ast::Statement& s);
    void statements(std::vector<ast::StatementPtr>& list);
    void body(ast::Statement& s); // in a scope of its own
    void check(ast::Statement& s, ast::Declaration& node);
    void check(ast::Statement& s, ast::Assignment& node);
    void check(ast::Statement& s, ast::ExpressionStatement& node);
    void check(ast::Statement& s, ast::Scope& node);
    void check(ast::Statement& s, ast::If& node);
    void check(ast::Statement& s, ast::For& node);
    void check(ast::Statement& s, ast::Break& node);
    void check(ast::Statement& s, ast::Return& node);
    void condition(ast::ExpressionPtr& e, const char* of_what);
    void merge(Flow& into, const Flow& other) const;
    void whole_body(ast::StatementPtr& tree, const ast::Name& name, Type result, const char* what,
                    const ast::Damage& body_damage);

    // ---- arrays, and variables with parts
    // What is assigned to, and which of its parts.
    struct Target {
        Symbol* symbol = nullptr; // null: reported
        uint64_t parts = 0;
        Type type;
    };
    Target target_of(ast::Expression& e);
    uint64_t parts_written(Type type, const std::vector<ast::Expression*>& accessors) const;
    Symbol* array(ast::Declaration& declaration, Type element);
    std::optional<uint32_t> size_of_array(const ast::TypeName& type);
    bool fits_body(Type type, Span span);
    Type array_constructor(ast::Expression& e, ast::BraceList& node);

    // ---- loops
    void plan(ast::Statement& s, ast::For& loop, Symbol& counter);
    void forget_ranges_assigned_in(const ast::Statement& s);

    // ---- integers
    ir::IntRange range(const ast::Expression& e) const;

    CheckContext& context;
    Diagnostics& diagnostics;
    const FileScope& scope;
    bool is_library;
    std::set<std::string, std::less<>> unknown_names; // each is reported once
    const ast::Damage* damage = nullptr;              // of the body
    bool in_damaged_body = false; // a syntax error was reported inside: what may follow from it is better not said

    std::unordered_map<std::string_view, std::vector<Binding>> by_name;
    std::vector<Symbol*> declared; // in order; scope_marks cut it
    std::vector<size_t> scope_marks;
    Flow flow;
    uint32_t slot_count = 0; // of variables declared so far: no slot is used twice
    uint32_t loop_depth = 0;
    bool is_global = false; // what is declared stands outside of any body
    Type result_type;
    std::string owner_name; // of the function or texture, for messages
    uint32_t reads = 0;
    std::vector<FunctionInfo::Mention> mentions;
};

// A parameter with its default and range as numbers; its symbol has no more than type and range, and no
// type after an error. check_texture.cpp
CheckedParameter check_texture_parameter(CheckContext& context, const FileScope& scope, ast::TextureParameter& tree);

} // namespace haptel::lang
