// Checks one body: of a function, of a texture, or of a global constant. One pass over its tree, in source order, with
// a little knowledge of flow: which variables are assigned for certain, and what the integers can be.
//
// check_expression.cpp, check_struct.cpp, check_constructor.cpp, check_call.cpp, check_statement.cpp, check_switch.cpp,
// check_array.cpp, check_loop.cpp and check_range.cpp hold the parts.
#pragma once

#include "lang/check/constant.h"
#include "lang/program/checked_program.h"
#include "lang/program/scope.h"
#include "lang/syntax/foreign.h"
#include "lang/text/diagnostic.h"
#include "lang/text/near_name.h"

#include <map>
#include <optional>
#include <set>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

namespace haptel::lang {

// What all bodies of a compilation share.
struct CheckContext {
    const SourceSet& sources;
    Diagnostics& diagnostics;
    CheckedProgram& program;
    bool is_library; // nobody is told what is not used in it
    ConstantEvaluator constants = {};
    const std::vector<FileScope>* scopes = nullptr;            // by file; null before they are known
    std::vector<const Symbol*> inputs = {};                    // by InputName
    std::set<std::string, std::less<>> unknown_functions = {}; // those without a guess: each is reported once
    uint32_t near_searches = 200; // that are left: beyond, names that are unknown have no proposal
    uint32_t struct_depth = 0;    // of structs whose members are being looked up, one in the other
};

// 'text', as names stand in messages.
inline std::string quoted(std::string_view text)
{
    return "'" + std::string(text) + "'";
}

// "english, running or stack"
std::string list_of(const std::vector<ast::Name>& names);

// What was most likely meant by the name in `span`: as a hint, and as a fix where that is certain.
void propose(Diagnostic& reported, Span span, const NearName& near, bool fits = true);
void propose(Diagnostic& reported, Span span, const ForeignWord& word);

// Without being asked: what converts_implicitly(), and a whole number where a uint is wanted, which it is then.
bool converts(const ast::Expression& e, Type wanted);
void adopt_literal(ast::Expression& e, Type wanted);
Type operand_type(Type other); // what a literal beside it is
// The argument of a call at `where` that is not given.
ast::ExpressionPtr left_out(Span where, const ParameterInfo& parameter);

// The type of a name in source, or nothing if the name means no type.
std::optional<Type> type_named(std::string_view name);
// Of a struct, whose members are then known; the error that was reported where it has mistakes. `from` named it.
Type type_of_struct(CheckContext& context, StructDeclaration& declared, Span from);
// What an author calls `file`.
const FileScope& scope_of(const CheckContext& context, uint32_t file);
// Reports what is no type. Arrays: the element, the caller looks at is_array.
Type resolve_type(CheckContext& context, const ast::TypeName& name);
// Likewise what holds no value, with why it should: "a parameter holds a value".
Type value_type(CheckContext& context, const ast::TypeName& name, const std::string& why, bool may_be_image);

// Of an int or uint; of others that of an int.
inline ir::IntRange full_range(Type type)
{
    return ir::full_range(type == uint_type ? ir::Type::u32 : ir::Type::i32);
}

// Parts of a variable, a bit each: components; of an array, elements.
inline constexpr uint64_t all_parts = ~uint64_t{0};
uint64_t first_parts(uint32_t count);
uint64_t parts_of(Type type);
uint64_t parts_at(Type type, int64_t index); // what an index picks; none if it is out of range

class BodyChecker {
public:
    BodyChecker(CheckContext& shared, const FileScope& seen)
        : context(shared), diagnostics(shared.diagnostics), scope(seen)
    {
    }

    void check_function(ast::Function& tree, FunctionInfo& info);
    void check_texture(ast::Texture& tree, CheckedTexture& texture);
    void check_parameters(ast::Texture& tree, CheckedTexture& texture);
    // Of a parameter or result: the type with the size in brackets, or the error that was reported.
    Type array_type(const ast::TypeName& name, Type element);
    // That of a parameter of a function; empty after a mistake.
    std::vector<ConstantPart> check_default(ast::Expression& e, const ParameterInfo& parameter, Span where);
    // A global constant or table.
    Symbol& check_global(ast::Declaration& declaration);

private:
    // ---- textures
    void check_output(ast::TextureParameter& tree, CheckedTexture& texture);
    void check_parameter(ast::TextureParameter& tree, CheckedTexture& texture);
    const Choices* choices_of(const std::vector<ast::Name>& names);
    void declare_choices(const std::vector<ast::Name>& names);
    std::vector<double> check_constant(ast::Expression& e, Type type, const std::string& where, bool is_range);
    bool check_range(const ast::TextureParameter& tree, CheckedParameter& made, bool has_value,
                     const std::vector<double>& minimum, const std::vector<double>& maximum);

    struct Variable {
        uint64_t assigned = 0; // a bit per component; of an array, per element
        ir::IntRange range{INT32_MIN, INT32_MAX};
        ir::IntRange called = range; // the same, where calls seen so far are all that there are
        void hold(ir::IntRange whole) { range = called = whole; }
    };
    struct Flow {
        std::vector<Variable> variables; // by Symbol::slot; those declared last on a path may be missing on others
        bool reachable = true;
    };
    struct Argument;
    struct Call;
    // What is assigned to, and which of its parts.
    struct Target {
        Symbol* symbol = nullptr; // null: reported
        uint64_t parts = 0;
    };

    // ---- names
    void open_scope() { scope_marks.push_back(declared.size()); }
    void close_scope();
    Symbol& declare(const ast::Name& name, SymbolKind kind, Type type);
    Symbol* find_local(std::string_view name) const;
    const Symbol* find_choice(std::string_view name) const;
    const Symbol* find(std::string_view name) const;
    void mark_read(std::string_view name);
    bool may_be_unread(const std::string& name) const; // declared in text that could not be read
    void report_unknown_name(Span span, const std::string& name);

    // ---- expressions: each sets and returns the type, Type::error() once something was reported
    Type expression(ast::Expression& e);
    Type check(ast::Expression&, ast::ErrorExpression&) { return Type::error(); }
    Type check(ast::Expression& e, ast::NumberLiteral& node);
    Type check(ast::Expression&, ast::BoolLiteral&) { return bool_type; }
    Type check(ast::Expression& e, ast::NameExpression& node) { return read(e, node, all_parts); }
    Type check(ast::Expression& e, ast::Unary& node);
    Type check(ast::Expression& e, ast::Chain& node);
    Type check(ast::Expression& e, ast::Conditional& node);
    Type check(ast::Expression& e, ast::CallExpression& node);
    Type check(ast::Expression& e, ast::GradCall& node);
    Type check(ast::Expression& e, ast::Member& node) { return member(e, node, all_parts); }
    Type check(ast::Expression& e, ast::Index& node);
    uint64_t column_of(const ast::Expression& object, int64_t column) const;
    Type check(ast::Expression& e, ast::BraceList& node);
    Type check(ast::Expression&, ast::LeftOut& node) { return node.parameter->type; }
    Type read(ast::Expression& e, ast::NameExpression& node, uint64_t parts);
    Type member(ast::Expression& e, ast::Member& node, uint64_t parts);
    Type type_before_reading(const ast::Expression& e) const;
    Type member_of_struct(const ast::Expression& e, const ast::Member& node, Type object);
    // Reports unless `e` has or becomes that type, or is wrong already; `where` as a clause: " for 'x'".
    void require(ast::Expression& e, Type wanted, const std::string& where);
    // Reports; the type of what is wrong.
    Type fail(Span span, ErrorCode code, std::string message, std::string_view hint = {});
    void warn_of_whole_division(const ast::Expression& dividend, const ast::Chain::Link& link);
    Type report_operator(ast::BinaryOp op, Span span, Type left, const ast::Expression& right);
    std::string excerpt(const ast::Expression& e) const;
    std::string operand(const ast::Expression& e) const; // to write something behind it

    // ---- calls
    using Targets = std::vector<std::optional<Target>>; // by argument
    Type constructor(ast::Expression& e, ast::CallExpression& call, Type type);
    Type struct_constructor(ast::Expression& e, ast::CallExpression& call, Type type);
    Type texture_call(ast::Expression& e, ast::CallExpression& call);
    bool named_argument(ast::CallExpression& call, const FunctionInfo& callee, size_t index,
                        std::vector<ast::ExpressionPtr>& ordered, Targets& targets);
    // Outputs of a call: the arguments that stand where a function writes, and what it makes of them.
    void write(const Candidate& function, std::vector<ast::ExpressionPtr>& arguments, const Targets& targets,
               Span call);
    void require_outputs(Span where);
    void note_ranges(const FunctionInfo& callee, const std::vector<ast::ExpressionPtr>& arguments);
    bool is_left_open(const ast::Expression& e) const; // "_", an argument that is left open
    bool is_binding(const ast::Expression& e) const;   // "f(_, 2.0)", a function
    bool read_arguments(Call& call, std::vector<ast::ExpressionPtr>& arguments,
                        const std::vector<Candidate>& candidates, Targets* targets);
    std::optional<Argument> binding(ast::Expression& e);
    FunctionReference pass(Argument& argument, const Candidate& passed, uint32_t order,
                           std::vector<const FunctionInfo*> through);
    void check_again(ast::CallExpression& call);
    std::string found_for(const Argument& argument) const;
    std::string hint_to_bind(const Argument& argument, const ParameterInfo& wanted) const;
    std::optional<Candidate> resolve(const ast::Expression& e, const ast::Name& callee,
                                     std::vector<ast::ExpressionPtr>& arguments, uint32_t order, CallTarget& target,
                                     Type& result);
    std::vector<Candidate> functions_called(const std::string& name);
    void report_no_match(const Call& call, const std::vector<Candidate>& candidates);
    void report_unknown_function(const Call& call);
    void report_unknown_prefix(const Call& call, const PrefixedName& parts);
    void report_grad(Span span);
    bool takes(std::string_view function, const Call& call) const;
    std::string filled_in(std::string_view pattern, const Call& call) const;

    // ---- statements
    void statement(ast::Statement& s)
    {
        std::vector<const Symbol*>* const around = std::exchange(written_by_calls, &s.written);
        std::visit([&](auto& node) { check(s.span, node); }, s.node);
        written_by_calls = around;
    }
    void statements(std::vector<ast::StatementPtr>& list);
    void body(ast::Statement& s); // in a scope of its own
    void check(Span span, ast::Declaration& node);
    void check(Span span, ast::Assignment& node);
    void check(Span span, ast::ExpressionStatement& node);
    void check(Span span, ast::Scope& node);
    void check(Span span, ast::If& node);
    void check(Span span, ast::For& node);
    void check(Span span, ast::Switch& node);
    void labels(ast::Switch& node);
    void label(ast::Expression& e, Type selector, std::map<int64_t, Span>& seen);
    void check(Span span, ast::Break& node);
    void check(Span span, ast::Continue& node);
    void leave_loop(Span span, const char* what);
    void check(Span span, ast::Return& node);
    void condition(ast::ExpressionPtr& e, const char* of_what);
    void merge(Flow& into, const Flow& other) const;
    void whole_body(ast::StatementPtr& tree, const ast::Name& name, Type result, const char* what,
                    const ast::Damage& body_damage);

    // ---- arrays, and variables with parts
    Target target_of(ast::Expression& e, const char* where);
    uint64_t parts_written(Type type, const std::vector<const ast::Expression*>& accessors) const;
    Symbol& array(ast::Declaration& declaration, Type element);
    Type declared_array(ast::Declaration& declaration, Type element, std::vector<ConstantPart>& cells);
    Type array_of(ast::Expression& e, ast::BraceList& list, const ast::TypeName& written, Type element,
                  const std::string& name);
    Type in_body(Type type, Span span);
    std::optional<uint32_t> size_of_array(const std::shared_ptr<ast::ArraySize>& written);
    std::optional<Type> with_sizes(const ast::TypeName& written, Type element);
    bool is_row(ast::Expression& cell, ast::BraceList& list, const ast::TypeName& written, Type& row);
    bool add_cells(const ast::BraceList& list, Type element, std::vector<ConstantPart>* cells);

    // ---- loops
    std::vector<const ast::NameExpression*> assigned_in(const ast::StatementPtr& s) const;
    void add_written(const ast::Expression& e, std::vector<const ast::NameExpression*>& names) const;
    void plan(Span span, ast::For& loop, Symbol& counter);
    void plan_of_reals(ast::For& loop, LoopPlan made, bool is_upwards, const ast::Assignment& step);

    // ---- integers
    ir::IntRange range(const ast::Expression& e) const;
    ir::IntRange range_over_calls(const ast::Expression& e);
    void hold(Variable& variable, const ast::Expression& value);

    CheckContext& context;
    Diagnostics& diagnostics;
    const FileScope& scope;
    std::set<std::string, std::less<>> unknown_names; // each is reported once
    const Choices* choices = nullptr;                 // one of which is expected where the text is read; null: none is
    const ast::Damage* damage = nullptr;              // of the body
    bool in_damaged_body = false; // a syntax error was reported inside: what may follow from it is better not said

    std::unordered_map<std::string_view, std::vector<Symbol*>> by_name; // innermost last
    std::vector<Symbol*> declared;                                      // in order; scope_marks cut it
    std::vector<size_t> scope_marks;
    Flow flow;
    uint32_t slot_count = 0; // of variables declared so far: no slot is used twice
    uint32_t loop_depth = 0;
    Flow* switch_exit = nullptr;                            // of the switch that a break leaves; null: it leaves a loop
    uint64_t columns_read = all_parts;                      // of the array of arrays that is read next
    uint32_t choice_depth = 0;                              // of operands that may not be evaluated, or more than once
    std::vector<const Symbol*>* written_by_calls = nullptr; // in the innermost statement
    std::vector<const Symbol*> must_be_written;             // parameters of the function
    bool is_never_called = false;
    bool counts_calls = false; // range() tells Variable::called
    bool is_global = false;    // what is declared stands outside of any body
    Type result_type;
    std::string owner_name; // of the function or texture, for messages
    uint32_t reads = 0;
    std::vector<FunctionInfo::Mention> mentions;
};

} // namespace haptel::lang
