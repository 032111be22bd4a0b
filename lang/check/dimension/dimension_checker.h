// The two classes that the check of dimensions is made of: DimensionChecker remembers what functions make of the
// dimensions they are called with, DimensionBody walks one body. Parts of the latter: dimension_expression.cpp,
// dimension_call.cpp, dimension_statement.cpp.
//
// It is a walk of its own, behind that of types: a body has one type for everything in it and is checked for types
// once, the library's once for all programs; its dimensions are others for each call, are tried on to find the argument
// at fault, and in loops are found in several passes.
#pragma once

#include "lang/check/constant.h"
#include "lang/check/dimension/dimension.h"
#include "lang/program/checked_program.h"
#include "lang/text/diagnostic.h"

#include <compare>
#include <map>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

namespace haptel::lang {

using Dimensions = std::vector<Dimension>;

// A value that is passed: two are alike if their dimensions are.
struct PassedValue {
    Dimension dimension = Dimension::any();
    const ast::Expression* written = nullptr; // null: none is passed
    bool is_given() const { return written; }
    bool operator==(const PassedValue& other) const { return std::is_eq(*this <=> other); }
    std::strong_ordering operator<=>(const PassedValue& other) const
    {
        if (is_given() != other.is_given()) return is_given() <=> other.is_given();
        return dimension <=> other.dimension;
    }
};

// A function that is called or passed, with what is bound of its arguments: as BoundFunction in lowering.
struct PassedFunction {
    FunctionReference function = {};            // of the source or built in; empty: it is not known
    std::vector<PassedValue> values = {};       // by parameter
    std::vector<PassedFunction> functions = {}; // what its parameters are that are functions
    std::strong_ordering operator<=>(const PassedFunction& other) const; // a default one would ask itself
    bool operator==(const PassedFunction& other) const { return std::is_eq(*this <=> other); }
    size_t size() const; // in functions and values
};
using PassedFunctions = std::vector<PassedFunction>;

// How to mend something.
struct DimensionHint {
    std::string text = {};
    bool changes_body = false; // it says what to write in the place of what stands there
};

struct DimensionFinding {
    Span span;
    std::string message;
    DimensionHint hint;
    std::vector<Related> related;
};

// A body for one choice of dimensions, or the result of looking at it.
struct DimensionInstance {
    std::string name;
    Dimension result = Dimension::any();
    Dimensions written;                      // of the parameters that it writes, in their order
    std::vector<DimensionFinding> findings;  // in code of the user's own
    std::vector<DimensionInstance*> callees; // whose findings are findings of the program too
    bool is_at_fault = false;                // library code that these dimensions do not go with
    bool is_reported = false;
    Span called_at;                    // the first call in code of the user's own
    std::string called_with;           // "a length and a plain number"; empty: nothing is known
    const uint32_t* choices = nullptr; // that the same body is looked at for; null: it has no parameters
};

constexpr uint32_t dimension_nesting_limit = 500; // as in lowering, which reports it: bounds the stack

class DimensionChecker {
public:
    explicit DimensionChecker(const SourceSet& all_sources) : sources(all_sources) {}

    // `arguments` by the parameters that are values, `passed` by those that are functions; no function is a parameter
    // any more, but it may be unknown.
    DimensionInstance& function(const FunctionInfo& info, const PassedFunctions& passed, const Dimensions& arguments);
    bool has_seen(const FunctionInfo& function) const { return choices.contains(&function); }
    // False once more work was spent than a program of sensible size can need: then everything fits.
    bool spend(size_t steps) { return (work += steps) <= work_max; }

    const SourceSet& sources;
    ConstantEvaluator constant_values;
    std::unordered_map<const Symbol*, Dimension> symbols; // constants, tables, parameters of the texture at hand
    Span user_call;                                       // in code of the user's own, the innermost under work
    uint32_t nesting = 0;                                 // of expressions and statements under work, over all bodies

private:
    struct Key {
        const FunctionInfo* function;
        PassedFunctions passed;
        Dimensions arguments;
        auto operator<=>(const Key&) const = default;
    };
    std::map<Key, DimensionInstance> instances;                // nodes stay where they are
    std::unordered_map<const FunctionInfo*, uint32_t> choices; // of dimensions, per function
    static constexpr size_t work_max = 1'000'000;              // expressions looked at; well below a second
    size_t work = 0;
};

class DimensionBody {
public:
    DimensionBody(DimensionChecker& all, DimensionInstance& made, bool in_library)
        : owner(all), instance(made), is_library(in_library)
    {
    }

    void function(const FunctionInfo& info, const PassedFunctions& passed, const Dimensions& arguments);
    void texture(const CheckedTexture& texture);
    void declaration(const ast::Declaration& node);

private:
    struct Origin {
        Dimension dimension = Dimension::any();
        Span span; // where a variable got it
    };
    struct Variable {
        Origin first;
        Origin other = {}; // what it is instead after another path that has come together with this one
        bool is_mixed() const { return !other.dimension.is_any(); }
    };
    struct Call {
        Span span;
        const std::string& name;
        std::vector<const ast::Expression*> values = {}; // that are passed
        Dimensions dimensions = {};                      // theirs
        PassedFunctions passed = {};
    };
    using Variables = std::vector<Variable>; // by Symbol::slot
    using Flow = std::optional<Variables>;   // nothing: not reached

    // ---- expressions
    Dimension expression(const ast::Expression& e);
    Dimension find(const ast::Expression& e);
    Dimension read(const Symbol& symbol, Span span);
    // What the operator makes of both; `whole` and `right_side` for messages.
    Dimension binary(ast::BinaryOp op, Dimension left, Dimension right, Span whole, const ast::Expression* left_side,
                     const ast::Expression& right_side);
    // The one dimension of all parts; `what` they make: "a vector".
    Dimension common(const std::vector<ast::ExpressionPtr>& parts, const std::string& what);
    Dimension parameter(const CheckedParameter& parameter);

    // ---- calls
    Dimension constructor(const ast::Expression& e, const ast::CallExpression& node);
    Dimension call(const ast::Expression& e, const std::string& name, const CallTarget& target,
                   const std::vector<ast::ExpressionPtr>& arguments, uint32_t order);
    Dimension built_in(const Call& call, const BuiltinOverload& overload);
    Dimension power(const Call& call);
    void blame_call(const Call& call, const FunctionInfo& callee);
    PassedFunction resolved(const FunctionReference& reference);
    void bind(PassedFunction& function, const CallTarget& target, const std::vector<ast::ExpressionPtr>& arguments);

    // ---- statements
    void statement(const ast::Statement& s);
    void assign(const ast::Statement& s, const ast::Assignment& node);
    void give(const ast::Expression& target, Dimension value, const ast::Expression& whence);
    void collect_written(Span where);
    void branch(const ast::If& node);
    void choice(const ast::Switch& node);
    void loop(const ast::For& node);
    void leave(const ast::Return& node, Span where);
    void body(const ast::Statement& tree, const Variables& start);
    static void merge(Flow& into, const Flow& other);
    void check_outputs();
    void settle(Variables& learnt, Variables& at_head);

    // ---- findings; library code is only marked as at fault
    void report(Span span, std::string message, DimensionHint hint = {}, std::vector<Related> related = {});
    // An argument or operand that should be something else, with how to mend it.
    // `who` expects it, `where` as a clause: " as argument 2".
    void report_expected(const std::string& who, const ast::Expression& e, Dimension expected, Dimension found,
                         const std::string& where = {});
    DimensionHint proposal(const ast::Expression& e, Dimension expected, Dimension found) const;

    DimensionChecker& owner;
    DimensionInstance& instance;
    bool is_library;
    PassedFunctions functions; // parameters that are functions, by Symbol::slot
    Flow flow;
    std::vector<Flow*> loop_exits, loop_turns; // innermost last: what break and what continue brings together
    std::unordered_map<const ast::For*, Variables> heads;
    bool heads_changed = false;
    const std::vector<CheckedOutput>* outputs = nullptr; // of a texture; null: this is a function
    const FunctionInfo* info_of = nullptr;               // the function
    Span returned_at;                                    // a value of the result's dimension
};

// The literal that `e` is, without a unit and perhaps with a sign: it may have been meant in any. Null: it is none.
const ast::Expression* bare_number(const ast::Expression& e);

// "a vector"
std::string described(Type type);

} // namespace haptel::lang
