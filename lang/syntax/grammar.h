// The grammar of Haptel, one function per rule, each with its rule above it. Recursive descent; see parser.h for the
// promise and token_cursor.h for recovery.
#pragma once

#include "lang/syntax/ast.h"
#include "lang/syntax/foreign.h"
#include "lang/syntax/token_cursor.h"

#include <map>
#include <span>
#include <vector>

namespace haptel::lang {

// A type that stands for each of some: a function whose parameters name it is read once for each.
inline constexpr std::string_view any_size = "vecN", sizes_of_any[] = {"vec2", "vec3"};
// Those that are made of numbers stand first.
inline constexpr std::string_view own_types[] = {"float", "int",   "uint",  "bool",  "vec2",  "vec3",  "vec4",
                                                 "ivec2", "ivec3", "ivec4", "uvec2", "uvec3", "uvec4", "bvec2",
                                                 "bvec3", "bvec4", "mat2",  "mat3",  "mat4",  "image", "void"};
inline constexpr std::span types_of_numbers = std::span(own_types).first<19>();
bool is_own_type(std::string_view word);
// Those of other languages too.
bool is_type_word(std::string_view word);

class Grammar : private TokenCursor {
public:
    using TokenCursor::TokenCursor;

    ast::File parse_file();         // parser.cpp
    ir::Facts parse_facts(Span at); // parse_facts.cpp; the tokens are those of one "@facts" line

private:
    // parser.cpp
    void begin_declaration();
    void language_line(ast::File& result);
    bool top_level_name(ast::File& result);
    void report_stray(ast::File& result);
    void find_top_level(bool strayed);

    using Statements = std::vector<ast::StatementPtr>;

    // parse_declaration.cpp
    size_t library_file_ahead() const;
    void import_declaration(ast::File& result);
    void find_prefixes();
    void texture(ast::File& result);
    void read_as_function(ast::Texture& texture, size_t body);
    void preset(ast::File& result, ast::Texture head, Span first);
    ast::TextureParameter texture_parameter();
    void range_of(ast::TextureParameter& parameter);
    void choices_of(ast::TextureParameter& parameter);
    void constants(ast::File& result);
    void structure(ast::File& result);
    void function_or_variable(ast::File& result);
    bool takes_any_size() const;
    void function_of_each_size(ast::File& result);
    void function(ast::File& result);
    ast::FunctionParameter function_parameter();
    template <class Parameter>
    void parameters(std::vector<Parameter>& into, Parameter (Grammar::*read)(), bool may_end_in_comma);
    void function_signature(ast::FunctionParameter& parameter);

    // parse_statement.cpp
    void statement(Statements& into);
    ast::StatementPtr block();
    ast::StatementPtr rest_of_block(Span opener);
    ast::StatementPtr single_statement(std::string_view after);
    ast::StatementPtr if_statement();
    ast::StatementPtr for_statement();
    ast::StatementPtr while_statement();
    ast::StatementPtr switch_statement();
    ast::Switch::Case one_case();
    ast::StatementPtr return_statement();
    ast::StatementPtr assignment_or_expression();
    ast::StatementPtr chained(ast::Assignment left, Span first, size_t value);
    void declarations(Statements& into);
    void declaration_list(Statements& into);
    ast::ExpressionPtr initializer(Statements& before);
    bool at_declaration() const;
    bool is_used_as_name() const;
    bool at_top_level_start() const;

    // parse_recovery.cpp: heads
    void close_head(Span opener);
    ast::StatementPtr body_of(std::string_view what);
    bool ends_parameter(Span opener);
    bool next_parameter();
    void find_next_parameter(size_t first_position);
    bool at_choices() const;
    void find_body();
    bool body_follows() const;
    bool statements_follow() const;

    // parse_recovery.cpp: statements
    void find_footing();
    void forget(std::span<ast::StatementPtr> statements);
    void forget(ast::FunctionParameter& parameter) { parameter.type = {}; }
    void forget(ast::TextureParameter& parameter);
    void note_unread(size_t first_position);
    ast::Damage take_damage(uint32_t mistakes_before, ast::StatementPtr& body);

    // parse_macro.cpp
    void definition();
    struct Macro {
        Span name;
        bool takes_arguments = false;
        std::vector<std::string_view> parameters;
        size_t first = 0, end = 0; // tokens of the value
        bool is_open = false;      // told
    };
    // Where tokens stand that a macro's use is read from: of an argument, with what its own names stand for.
    struct Range {
        size_t first = 0, end = 0;
    };
    struct Use {
        const Macro* macro;
        std::vector<Range> arguments;
        const Use* around; // the macro that the arguments are written in; null: none
    };
    Macro* macro_here();
    ast::ExpressionPtr use_of(Macro& macro);
    std::vector<Range> macro_arguments();
    const Range* argument_here() const;
    ast::ExpressionPtr read_range(Range range, const Use* names, const std::string& what);
    std::string_view alias_of(std::string_view word) const;
    void leave_semicolon_out(Macro& macro);
    void note_constant(Span whole, const ast::Name& name, const Macro& macro);

    // parse_expression.cpp
    ast::ExpressionPtr expression();
    ast::ExpressionPtr conditional();
    ast::ExpressionPtr binary(int lowest_precedence);
    ast::ExpressionPtr unary();
    ast::ExpressionPtr postfix();
    ast::ExpressionPtr primary();
    ast::ExpressionPtr number();
    ast::ExpressionPtr brace_list(bool is_row = false);
    ast::ExpressionPtr name_or_call();
    bool at_prefixed_name(size_t ahead = 0, Token called_by = Token::left_paren) const;
    bool at_prefixed_type() const;
    ast::Name prefixed_name();
    ast::ExpressionPtr grad_call(Span first);
    std::vector<ast::ExpressionPtr> arguments(std::vector<ast::Name>* names = nullptr);
    ast::ExpressionPtr array_constructor(ast::Name type);
    bool makes_structs(std::string_view type) const;

    // parse_foreign.cpp
    void skip_foreign_qualifiers();
    void skip_type_arguments();
    bool skip_precision();
    void skip_foreign_declaration(std::string message, std::string_view hint, ErrorCode code = "foreign-word");
    void foreign_statement(const ForeignWord& word, Statements& into);
    void read_misspelt_keyword();
    void read_misspelt_in();
    void read_decimal_comma();
    void skip_metadata();
    void read_type_behind_name(bool is_told);
    bool skip_word_of_function();
    void read_foreign_operator();
    bool read_foreign_else();
    ast::ExpressionPtr parted_number(Span number);
    void bracketed_range(ast::TextureParameter& parameter);
    ast::ExpressionPtr cast();
    ast::ExpressionPtr method_call(ast::ExpressionPtr object);

    std::string not_in_haptel() const { return "there is no '" + std::string(text()) + "' in Haptel"; }

    // In a function that is written for vectors of any size, that of the size being read; and what a macro renames.
    std::string_view text(size_t ahead = 0) const
    {
        std::string_view word = TokenCursor::text(ahead);
        if (!macros.empty() && kind(ahead) == Token::name) word = alias_of(word);
        return word == any_size && !one_size.empty() ? one_size : word;
    }

    // Small rules that all share, parse_type.cpp and parse_facts.cpp
    ast::TypeName type_name();
    void array_suffix(ast::TypeName& type);
    ast::Name name(std::string_view what);     // empty, and reported, where there is none
    ast::Name name_after(ast::TypeName& type); // mends "q vec2"
    std::string doc_before(size_t token_index, std::optional<ir::Facts>* facts);
    ast::ExpressionPtr bound_before(size_t token_index);
    template <class Node>
    static ast::ExpressionPtr make(Span where, Node node)
    {
        auto made = std::make_unique<ast::Expression>();
        made->span = where;
        made->node = std::move(node);
        return made;
    }
    template <class Node>
    static ast::StatementPtr make_statement(Span where, Node node)
    {
        auto made = std::make_unique<ast::Statement>();
        made->span = where;
        made->node = std::move(node);
        return made;
    }
    static ast::ExpressionPtr unknown(Span where) { return make(where, ast::ErrorExpression{}); }

    std::map<std::string_view, Macro> macros; // by name; a name's text belongs to the sources
    const Use* macro_use = nullptr;           // whose value is being read
    size_t macro_tokens = 0;                  // read of all values so far
    mutable size_t alias_steps = 0;           // from a name to what it stands for; beyond many, it stands for itself

    std::set<std::string, std::less<>> struct_names; // of those that stand above
    std::set<std::string_view> import_prefixes;      // anywhere in the file
    bool has_own_grad = false;                       // a function of that name stands above
    uint32_t told_type = UINT32_MAX;                 // where a type begins of which enough is said
    bool are_types_behind = false;                   // in the head of this function, and that is told

    // Of the function or texture that is being read:
    std::string_view one_size;                 // what `any_size` stands for; empty: nothing
    std::set<std::string, std::less<>> unread; // as in Damage
    bool is_head_damaged = false;              // likewise
    bool is_misshapen = false;                 // its braces do not fit
    bool has_stray_brace = false;              // nor can they: one was found where none can stand
};

} // namespace haptel::lang
