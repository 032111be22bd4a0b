// What stands at the top of a file: imports, constants, functions, textures; and the small rules that all share.
#include "lang/syntax/grammar.h"

#include <algorithm>

namespace haptel::lang {

using namespace ast;

bool is_own_type(std::string_view word)
{
    constexpr std::string_view words[] = {"float", "int",  "uint", "bool", "vec2",  "vec3",
                                          "vec4",  "mat2", "mat3", "mat4", "image", "void"};
    return word == any_size || std::find(std::begin(words), std::end(words), word) != std::end(words);
}

bool is_type_word(std::string_view word)
{
    return is_own_type(word) || foreign_word(ForeignKind::type, word);
}

std::optional<Name> Grammar::name(std::string_view what)
{
    if (at(Token::name)) {
        Name result{std::string(text()), span()};
        advance();
        return result;
    }
    const std::string word = kind() >= Token::kw_texture ? std::string(text()) : std::string();
    Diagnostic& reported = error(span(), "syntax", "expected a name " + std::string(what) + found());
    if (!word.empty()) reported.hint = "'" + word + "' is a word of the language and cannot be a name";
    return std::nullopt;
}

// type = name ["[" [expression] "]"]
TypeName Grammar::type_name()
{
    TypeName type;
    skip_foreign_qualifiers();
    std::optional<Name> base = name("of a type");
    if (!base) return type;
    type.base = std::move(*base);
    if (const ForeignWord* foreign = foreign_word(ForeignKind::type, type.base.text)) {
        Diagnostic& reported = diagnostics.error(type.base.span, "foreign-word",
                                                 "'" + type.base.text + "' is not a type of Haptel", foreign->hint);
        if (!foreign->replacement.empty()) {
            if (foreign->is_exact) reported.fix = FixIt{type.base.span, std::string(foreign->replacement)};
            type.base.text = foreign->replacement;
        }
    }
    skip_type_arguments();
    array_suffix(type);
    return type;
}

void Grammar::array_suffix(TypeName& type)
{
    while (at(Token::left_bracket)) {
        const Span opener = span();
        if (type.is_array) {
            error(opener, "nested-table", "tables have one dimension",
                  "write the rows one behind the other and index by row * columns + column");
            type.base.text.clear(); // of no type: nothing more is said about it
        }
        const Nesting nesting(*this, Nesting::bracket);
        if (nesting.too_deep()) return skip_brackets();
        advance();
        type.is_array = true;
        type.array_size.reset();
        if (!at(Token::right_bracket))
            type.array_size = std::make_shared<ArraySize>(ArraySize{expression(), false, {}});
        close(Token::right_bracket, opener);
    }
}

// import = "import" string ";"
void Grammar::import_declaration(File& result)
{
    const Span first = span();
    advance();
    Import import;
    if (at(Token::string)) {
        const std::string_view quoted = text();
        import.path = quoted.substr(1, quoted.size() - 2);
        if (import.path.empty()) diagnostics.error(span(), "import", "expected a path between the quotes");
        advance();
        expect_semicolon("the import");
    } else { // "wood.oak": files are known by their paths, there are no modules
        Diagnostic& reported = error(span(), "import", "expected a path in quotes after 'import'" + found());
        std::string path;
        for (bool is_name = true; at(is_name ? Token::name : Token::dot); is_name = !is_name, advance())
            path += is_name ? text() : "/";
        reported.hint = "write the path of a file: import \"" + (path.empty() ? "wood/oak" : path) + ".haptel\";";
    }
    import.span = since(first);
    if (!import.path.empty()) result.imports.push_back(std::move(import));
}

// constants = "const" type name [...] "=" initializer {"," ...} ";"
void Grammar::constants(File& result)
{
    Statements made;
    declarations(made);
    if (lost) forget(made);
    for (StatementPtr& statement : made) {
        Declaration& declaration = std::get<Declaration>(statement->node);
        if (!declaration.initializer && !lost) {
            diagnostics.error(declaration.name.span, "syntax",
                              "expected '=' and the value of the constant '" + declaration.name.text + "'");
            declaration.initializer = make(declaration.name.span, ErrorExpression{});
        }
        result.constants.push_back({std::move(declaration), statement->span});
    }
}

// function = type name "(" [function_parameter {"," function_parameter}] ")" block
// variable = type name ...         is reported: only constants are global
void Grammar::function_or_variable(File& result)
{
    const Span first = span();
    const size_t first_token = position;
    if (kind(1) == Token::name && kind(2) != Token::left_paren && !body_follows()) {
        diagnostics.error(first, "global-variable", "a variable of a whole file must be constant",
                          "write 'const' before it, or make it a parameter of the texture");
        constants(result);
        if (!result.constants.empty()) result.constants.back().declaration.is_const = true;
        return;
    }
    if (one_size.empty() && takes_any_size()) return function_of_each_size(result);
    TypeName type = type_name();
    if (type.base.text.empty()) stand_again();
    std::optional<Name> function_name = lost ? std::nullopt : name("after '" + type.base.text + "'");
    if (function_name) function(result, std::move(type), std::move(*function_name), first_token);
}

// At a function: whether a type of its parameters is `any_size`.
bool Grammar::takes_any_size() const
{
    size_t ahead = 0;
    while (kind(ahead) == Token::name || kind(ahead) == Token::left_bracket || kind(ahead) == Token::right_bracket)
        ++ahead; // its result and name
    if (kind(ahead) != Token::left_paren) return false;
    for (uint32_t open = 0;; ++ahead) {
        const Token here = kind(ahead);
        if (here == Token::left_paren) ++open;
        if (here == Token::right_paren && --open == 0) return false;
        if (here == Token::left_brace || here == Token::semicolon || here == Token::end) return false;
        if (here == Token::name && text(ahead) == any_size && kind(ahead - 1) != Token::name) return true;
    }
}

// Each is a function of its own from here on. A mistake is found in each, and told once, since it is at one place.
void Grammar::function_of_each_size(File& result)
{
    const size_t first_token = position;
    for (const std::string_view size : sizes_of_any) {
        position = first_token;
        begin_declaration();
        if (size != sizes_of_any[0]) stand_again();
        one_size = size;
        function_or_variable(result);
    }
    one_size = {};
}

void Grammar::function(File& result, TypeName result_type, Name function_name, size_t doc_token)
{
    Function made;
    made.doc = doc_before(doc_token, &made.facts);
    if (function_name.text == "grad") {
        diagnostics.error(function_name.span, "reserved-name", "'grad' is the derivative of functions",
                          "choose another name");
    }
    const Span first = result_type.base.span;
    made.result = std::move(result_type);
    made.name = std::move(function_name);
    const uint32_t mistakes_before = mistakes;
    const Span opener = span();
    if (expect(Token::left_paren, "after the name of the function")) {
        const bool takes_void = text() == "void" && kind(1) == Token::right_paren;
        if (takes_void) advance();
        if (!at(Token::right_paren) && !at(Token::left_brace)) {
            do {
                const size_t first_position = position;
                made.parameters.push_back(function_parameter());
                if (ends_parameter(opener)) continue;
                is_head_damaged = true;
                find_next_parameter(first_position);
            } while (next_parameter());
        }
        close_head(opener);
    }
    if (lost && !made.parameters.empty()) made.parameters.back().type = {};
    is_head_damaged |= lost;
    if (at(Token::semicolon) && !lost) {
        advance();
        Diagnostic& reported = diagnostics.warning(
            since(first), "prototype", "functions may stand in any order: a prototype does nothing", "leave it out");
        reported.fix = FixIt{since(first), ""};
        return;
    }
    made.body = body_of("the function '" + made.name.text + "'");
    made.damage = take_damage(mistakes_before, made.body);
    result.lacks_functions |= is_head_damaged;
    made.span = since(first);
    result.functions.push_back(std::move(made));
}

// function_parameter = ["const"] ["in"] type name | type name "(" [type [name] {"," type [name]}] ")"
FunctionParameter Grammar::function_parameter()
{
    FunctionParameter parameter;
    const Span first = span();
    accept(Token::kw_const);
    accept(Token::kw_in); // as GLSL writes it: all parameters are
    if (at(Token::kw_out) || text() == "inout") {
        diagnostics.error(span(), "output-parameter", "a function cannot write its parameters",
                          "return the result; several results fit into a vector");
        advance();
    }
    parameter.type = type_name();
    if (lost) return parameter;
    if (at(Token::star) || at(Token::ampersand)) {
        error(span(), "no-pointers", "there are no pointers or references in Haptel");
        return parameter;
    }
    std::optional<Name> declared = name("after '" + parameter.type.base.text + "'");
    if (!declared) return parameter;
    parameter.name = std::move(*declared);
    array_suffix(parameter.type);
    if (at(Token::left_paren)) function_signature(parameter);
    parameter.span = since(first);
    if (at(Token::assign) && !lost) {
        error(span(), "default-argument", "parameters of functions have no default",
              "write a second function with fewer parameters that calls this one");
    }
    return parameter;
}

void Grammar::function_signature(FunctionParameter& parameter)
{
    const Span opener = span();
    parameter.is_function = true;
    advance();
    if (accept(Token::right_paren)) return;
    do {
        accept(Token::kw_in);
        parameter.signature.push_back(type_name());
        if (at(Token::name)) advance();
    } while (!lost && accept(Token::comma));
    close(Token::right_paren, opener, true);
}

// texture = "texture" name "(" [texture_parameter {"," texture_parameter}] ")" block
void Grammar::texture(File& result)
{
    Texture made;
    std::optional<ir::Facts> facts;
    made.doc = doc_before(position, &facts);
    if (facts)
        diagnostics.error(facts->span, "facts",
                          "facts belong to functions; those of a texture are found by the compiler");
    const Span first = span();
    const uint32_t mistakes_before = mistakes;
    advance();
    std::optional<Name> texture_name = name("after 'texture'");
    if (!texture_name) return;
    made.name = std::move(*texture_name);
    const Span opener = span();
    if (at(Token::left_brace)) {
        diagnostics.error(made.name.span, "syntax", "expected '(' after the name of the texture",
                          "write 'texture " + made.name.text + "()' if it has no parameters");
    } else if (expect(Token::left_paren, "after the name of the texture")) {
        if (!at(Token::right_paren) && !at(Token::left_brace)) {
            do {
                if (at(Token::right_paren)) break; // a comma behind the last parameter
                const size_t first_position = position;
                TextureParameter parameter = texture_parameter();
                if (!ends_parameter(opener)) {
                    forget(parameter);
                    is_head_damaged = true;
                    find_next_parameter(first_position);
                }
                if (!parameter.name.text.empty()) made.parameters.push_back(std::move(parameter));
            } while (next_parameter());
        }
        close_head(opener);
    } else {
        return;
    }
    made.body = body_of("the texture '" + made.name.text + "'");
    made.damage = take_damage(mistakes_before, made.body);
    made.span = since(first);
    result.textures.push_back(std::move(made));
}

// texture_parameter = ["out"] type name ["=" expression ["in" binary ".." binary]]
TextureParameter Grammar::texture_parameter()
{
    TextureParameter parameter;
    const Span first = span();
    parameter.doc = doc_before(position, nullptr);
    parameter.is_output = accept(Token::kw_out);
    if (const ForeignWord* foreign = foreign_word(ForeignKind::declaration, text());
        foreign && kind(1) == Token::name) {
        diagnostics.error(span(), "foreign-word", "there is no '" + std::string(text()) + "' in Haptel",
                          "leave it out");
        advance();
    }
    parameter.type = type_name();
    if (lost) return parameter;
    std::optional<Name> declared = name("after '" + parameter.type.base.text + "'");
    if (!declared) return parameter;
    parameter.name = std::move(*declared);
    array_suffix(parameter.type);
    const bool needs_default = !parameter.is_output && parameter.type.base.text != "image";
    if (accept(Token::assign)) {
        parameter.value = expression();
    } else if (needs_default && !lost && !is_type_word(parameter.type.base.text)) {
        parameter.value = make(parameter.name.span, ErrorExpression{}); // of no type: enough is said
    } else if (needs_default && !lost) {
        diagnostics.error(
            parameter.name.span, "missing-default", "the parameter '" + parameter.name.text + "' needs a default value",
            "for example " + parameter.type.base.text + " " + parameter.name.text + " = 1.0 in 0.0 .. 10.0");
        parameter.value = make(parameter.name.span, ErrorExpression{});
        lost = !at(Token::kw_in) && !at(Token::comma) && !at(Token::right_paren); // "float depth 1mm": enough is said
    }
    read_misspelt_in();
    if (!lost && accept(Token::kw_in)) {
        parameter.minimum = binary(1);
        if (!lost && at(Token::dot_dot)) {
            advance();
            parameter.maximum = binary(1);
        } else {
            error(span(), "range", "expected '..' and the upper end of the range" + found(),
                  "a range is written 0.2mm .. 5mm");
        }
        if (!parameter.maximum) parameter.maximum = make(previous_span(), ErrorExpression{});
    }
    parameter.span = since(first);
    return parameter;
}

} // namespace haptel::lang
