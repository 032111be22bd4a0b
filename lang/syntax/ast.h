// The tree that the parser makes and the checker annotates. Plain data; every node knows its span.
//
// Chains of binary operators of one precedence ("a + b - c + ...") are one flat node, so that a chain of 50 000 terms
// needs no recursion anywhere; other nesting is limited to 256 by the parser, so that recursion over the tree is
// bounded. A subtree that could not be parsed is an ErrorExpression or is left out; the diagnostics say why.
#pragma once

#include "lang/syntax/resolution.h"
#include "lang/syntax/type.h"
#include "lang/text/number.h"
#include "lang/text/source.h"

#include <algorithm>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <variant>
#include <vector>

namespace haptel::lang::ast {

struct Expression;
struct Statement;
struct Function;
using ExpressionPtr = std::unique_ptr<Expression>;
using StatementPtr = std::unique_ptr<Statement>;

struct Name {
    std::string text;
    Span span;
};

// The number between the brackets of an array's type.
struct ArraySize {
    ExpressionPtr written;
    bool is_checked = false;        // by the checker, which sets
    std::optional<uint32_t> number; // nothing after an error
};

// "vec3", "float[3]", "const float A[3][4]": the base name and, for arrays, the sizes (absent in `float A[] = {...}`).
// All names of one declaration have their type's sizes in common: each is read and checked once, however many they are.
struct TypeName {
    Name base;
    bool is_array = false;
    std::shared_ptr<ArraySize> array_size = {};
    bool has_rows = false; // "[3][4]"
    std::shared_ptr<ArraySize> row_size = {};
};

enum class UnaryOp { negate, plus, logical_not, bit_not };
enum class BinaryOp {
    add,
    subtract,
    multiply,
    divide,
    remainder,
    less,
    less_equal,
    greater,
    greater_equal,
    equal,
    not_equal,
    logical_and,
    logical_or,
    logical_xor,
    bit_and,
    bit_or,
    bit_xor,
    shift_left,
    shift_right,
};
struct ErrorExpression {};
// A literal as written; `value` is the f64 nearest to the decimal value times the unit's factor (SI).
struct NumberLiteral {
    using Kind = Number::Kind;
    Kind kind = Kind::real;
    double value = 0;     // real
    uint64_t integer = 0; // integer kinds, before range checking
    std::string unit;     // as written: "mm", "deg"; empty: none. A literal with a unit is real.
    std::string text;
};
struct BoolLiteral {
    bool value = false;
};
struct NameExpression {
    std::string name;
    const Symbol* symbol = nullptr; // set by the checker; null: a function, or an error
};
struct Unary {
    UnaryOp op;
    ExpressionPtr operand;
};
// first op[0] rest[0] op[1] rest[1] ...: evaluated from the left. All operators have the same precedence.
struct Chain {
    struct Link {
        BinaryOp op;
        Span op_span;
        ExpressionPtr operand;
    };
    ExpressionPtr first;
    std::vector<Link> rest;
};
struct Conditional {
    ExpressionPtr condition, when_true, when_false;
};
// Function, constructor, built-in or texture: the checker decides.
struct CallExpression {
    Name callee;
    std::vector<ExpressionPtr> arguments;
    std::vector<Name> names = {}; // by argument, "depth = 1mm"; no text: it has none. The checker clears them
    CallTarget target = {};       // set by the checker
    bool is_of_texture = false;   // for certain, though it may have no names
    // What a texture reads instead of an input, "p = q"; set by the checker, out of the arguments.
    std::vector<std::pair<InputName, ExpressionPtr>> inputs = {};
};
// An argument that a call leaves out; put there by the checker.
struct LeftOut {
    const ParameterInfo* parameter;
};
// grad(f)(args), grad(grad(f))(args): `order` counts the grads.
struct GradCall {
    Name function;
    uint32_t order = 1;
    std::vector<ExpressionPtr> arguments;
    CallTarget target = {}; // set by the checker
};
struct Member {
    ExpressionPtr object;
    Name member;
}; // of a struct, or a swizzle
struct Index {
    ExpressionPtr object, index;
};
// The elements of an array, in one of two forms: "{1.0, 2.0}", which only an initializer may be, or the constructor
// "float[2](1.0, 2.0)".
struct BraceList {
    std::vector<ExpressionPtr> elements;
    std::optional<TypeName> type = std::nullopt; // of the constructor, "float[2]"; none: braces
    bool is_damaged = false;                     // a syntax error was reported in it, so its length must not be checked
};

struct Expression {
    Span span;
    std::variant<ErrorExpression, NumberLiteral, BoolLiteral, NameExpression, Unary, Chain, Conditional, CallExpression,
                 GradCall, Member, Index, BraceList, LeftOut>
        node;
    Type type; // set by the checker; Type::error() where something was reported
};

// The expressions that `e` is made from, one level down, in source order.
std::vector<const Expression*> operands_of(const Expression& e);

// Whether the text of `e` has an operator outside of all parentheses, as "a + b" has. Then text appended to it, as
// ".x", would apply to its last operand alone: whoever builds a fix from it writes parentheses round it.
inline bool is_open(const Expression& e)
{
    const auto chain = std::get_if<Chain>(&e.node);
    const auto conditional = std::get_if<Conditional>(&e.node);
    const Expression* first = chain ? chain->first.get() : conditional ? conditional->condition.get() : nullptr;
    return first && first->span.begin == e.span.begin;
}

struct Declaration { // one name; "float a = 1, b;" makes two in a row
    bool is_const = false;
    TypeName type;
    Name name;
    ExpressionPtr initializer;      // may be null
    const Symbol* symbol = nullptr; // set by the checker
};
struct Assignment { // target: name, or members, swizzle or index of one. "++i;" and "i++;" are "i += 1".
    ExpressionPtr target;
    std::optional<BinaryOp> op; // in "+=" and its like; nothing: "="
    Span op_span;
    ExpressionPtr value;
};
struct ExpressionStatement {
    ExpressionPtr expression;
}; // a call that writes its arguments; else it does nothing, and the checker says so
struct Scope {
    std::vector<StatementPtr> statements;
};
// "if (a) .. else if (b) .. else ..": flat, so that a long chain does not nest. The last condition is null for `else`.
struct If {
    struct Arm {
        ExpressionPtr condition;
        StatementPtr body;
    };
    std::vector<Arm> arms;
};
struct For {
    StatementPtr init;
    ExpressionPtr condition;
    StatementPtr step;
    StatementPtr body;
    LoopPlan plan = {}; // set by the checker
}; // parts may be null
// "switch (e) { case 0: ... break; case 1: case 2: ... break; default: ... }"
struct Switch {
    struct Case {
        std::vector<ExpressionPtr> labels; // constant; null: "default"
        Span head;                         // from the first label to the last ':'
        StatementPtr body;                 // a Scope
        bool is_default() const
        {
            return std::ranges::any_of(labels, [](const ExpressionPtr& label) { return !label; });
        }
    };
    ExpressionPtr selector;
    std::vector<Case> cases;
};
struct Break {}; // of the innermost loop or switch
struct Continue {};
struct Return {
    ExpressionPtr value;
}; // may be null

struct Statement {
    Span span;
    std::vector<const Symbol*> written; // by calls in it; set by the checker
    std::variant<Declaration, Assignment, ExpressionStatement, Scope, If, For, Switch, Break, Continue, Return> node;
};

// The expressions that stand in `s` itself and not in a statement inside of it, in source order.
std::vector<const Expression*> expressions_of(const Statement& s);

// `look` at `s` and at every statement inside of it, in source order.
void for_each_in(const Statement& s, const std::function<void(const Statement&)>& look);
// What `part` is a member, component or element of; null: it is none.
const Expression* whole_of(const Expression& part);
// What is assigned to, or has the part that is: a name; null where it is none, which is a mistake.
const NameExpression* root_of(const Expression& target);

// Parameter of a function: a value, or a function ("float basis(vec3)") resolved at compile time.
struct FunctionParameter {
    TypeName type; // of a function parameter: its result
    Name name;
    Passing passing = Passing::in;
    bool is_function = false;
    std::vector<TypeName> signature; // argument types where is_function
    ExpressionPtr value;             // where a call leaves it out; may be null
    Span span;
};

// What syntax errors, already reported, leave unknown about a function or texture. The checker then does not report
// what may be a consequence of them, such as a missing return or an unknown name.
struct Damage {
    bool any = false;                          // an error somewhere in it
    bool in_head = false;                      // an error among its parameters: calls of it cannot be checked
    std::set<std::string, std::less<>> unread; // names in the text skipped after an error, which may have declared them
};

struct Function {
    std::string doc; // without the slashes, without @facts
    std::optional<ir::Facts> facts;
    TypeName result;
    Name name;
    std::vector<FunctionParameter> parameters;
    StatementPtr body; // a Scope; null where there is none, or where its braces do not fit
    Damage damage;
    Span span;
};

struct TextureParameter {
    std::string doc;
    TypeName type;
    Name name;
    bool is_output = false; // "out float stiffness_scale"
    // Default and range, which a preset of the texture has too; the range may be absent.
    std::shared_ptr<Expression> value, minimum, maximum;
    std::vector<Name> choices = {}; // in the place of a range: names of 0, 1, 2 ...
    Span span = {};
};

struct Texture {
    std::string doc;
    Name name;
    std::vector<TextureParameter> parameters;
    StatementPtr body;    // as in Function
    Function as_function; // what other textures call: the same parameters and body; no body after a mistake
    Damage damage;
    Span span;
};

// "texture oak = wood(depth = 40um);": a texture with other defaults. The checker makes it one of File::textures.
struct Preset {
    std::string doc;
    Name name, of;
    std::vector<Name> names; // by value
    std::vector<ExpressionPtr> values;
    Span span;
};

// What other textures call, still without its body.
Function head_as_function(const Texture& texture);

struct Constant {
    Declaration declaration;
    Span span;
}; // global const, tables too
struct Struct {
    struct Member {
        TypeName type;
        Name name;
    };
    Name name;
    std::vector<Member> members;
    Span span;
};
struct Import {
    std::string path; // "wood/oak.haptel", or "wood.oak" of a library
    Name prefix;      // "as oak": what stands before the file's names; none: they stand alone
    Span span;
};

struct File {
    Span language; // the number in "language 1;"; empty: the file does not say
    std::vector<Import> imports;
    std::vector<Struct> structs;
    std::vector<Constant> constants;
    std::vector<Function> functions;
    std::vector<Texture> textures;
    std::vector<Preset> presets;
    // Functions that could not be read may have any name, other declarations one of those that stand there.
    bool lacks_functions = false;
    std::set<std::string, std::less<>> unread;
};

} // namespace haptel::lang::ast
