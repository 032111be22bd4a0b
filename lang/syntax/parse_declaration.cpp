// What stands at the top of a file: imports, constants, functions, textures.
#include "lang/abi/outputs.h"
#include "lang/syntax/grammar.h"
#include "lang/text/limits.h"

#include <algorithm>

namespace haptel::lang {

using namespace ast;

// Imports may stand below what uses them.
void Grammar::find_prefixes()
{
    const std::vector<PlacedToken>& all = list.tokens;
    const auto word = [&](size_t i) { return sources.text({file, all[i].begin, all[i].end}); };
    bool is_import = false;
    for (size_t i = 0; i + 2 < all.size(); ++i) {
        if (all[i].kind == Token::kw_import || all[i].kind == Token::semicolon)
            is_import = all[i].kind == Token::kw_import;
        const bool has_prefix = is_import && all[i].kind == Token::name && word(i) == "as" &&
                                all[i + 1].kind == Token::name && all[i + 2].kind == Token::semicolon;
        if (has_prefix) import_prefixes.insert(word(i + 1));
    }
}

// How many tokens the name of a library's file takes here, "wood.oak"; 0: none stands here. "oak.haptel" lacks quotes.
size_t Grammar::library_file_ahead() const
{
    size_t last = 0;
    while (kind(last) == Token::name && kind(last + 1) == Token::dot) last += 2;
    return last > 0 && kind(last) == Token::name && text(last) != "haptel" ? last + 1 : 0;
}

// import = "import" (string | name "." name {"." name}) ["as" name] ";"
void Grammar::import_declaration(File& result)
{
    const Span first = span();
    advance();
    Import import;
    const size_t names = library_file_ahead();
    if (at(Token::string) || names > 0) {
        for (size_t i = 0; i < names; ++i) import.path += text(i);
        if (names == 0) import.path = text().substr(1, text().size() - 2);
        if (import.path.empty()) diagnostics.error(span(), "import", "expected a path between the quotes");
        advance(std::max<size_t>(names, 1));
        if (text() == "as") {
            advance();
            import.prefix = name("after 'as'");
        }
        if (!lost) expect_semicolon("the import");
    } else {
        Diagnostic& reported =
            error(span(), "import", "expected a path in quotes, or a file of a library, after 'import'" + found());
        std::string path;
        for (bool is_name = true; at(is_name ? Token::name : Token::dot); is_name = !is_name, advance())
            path += is_name ? text() : "/";
        if (path.ends_with("/haptel")) path.resize(path.size() - std::string_view("/haptel").size());
        std::string prefix;
        if (text() == "as" && kind(1) == Token::name) {
            import.prefix = {std::string(text(1)), span(1)};
            prefix = " as " + import.prefix.text;
        }
        reported.hint = "write the path of a file: import \"" + (path.empty() ? "wood/oak" : path) + ".haptel\"" +
                        prefix + "; or the name of an installed one: import wood.oak;";
    }
    import.span = since(first);
    if (!import.path.empty() || !import.prefix.text.empty()) result.imports.push_back(std::move(import));
}

// constants = "const" type name [...] "=" initializer {"," ...} ";"
void Grammar::constants(File& result)
{
    Statements made;
    declarations(made);
    if (lost) forget(made);
    for (StatementPtr& statement : made) {
        if (!std::holds_alternative<Declaration>(statement->node)) {
            diagnostics.error(statement->span, "assignment-in-expression", "a constant is not assigned to",
                              "declare each with its own value");
            continue;
        }
        Declaration& declaration = std::get<Declaration>(statement->node);
        if (!declaration.initializer && !lost) {
            diagnostics.error(declaration.name.span, "syntax",
                              "expected '=' and the value of the constant '" + declaration.name.text + "'");
            declaration.initializer = unknown(declaration.name.span);
        }
        result.constants.push_back({std::move(declaration), statement->span});
    }
}

// function = type name "(" [function_parameter {"," function_parameter}] ")" block
// variable = type name ...         is reported: only constants are global
void Grammar::function_or_variable(File& result)
{
    if (kind(1) == Token::name && kind(2) != Token::left_paren && !body_follows()) {
        diagnostics.warning(span(), "global-variable", "a variable of a whole file is read as a constant",
                            "write 'const' before it, or make it a parameter of the texture");
        constants(result);
        if (!result.constants.empty()) result.constants.back().declaration.is_const = true;
    } else {
        takes_any_size() ? function_of_each_size(result) : function(result);
    }
}

// At a function: whether a type of its parameters is `any_size`.
bool Grammar::takes_any_size() const
{
    size_t ahead = 0;
    while (kind(ahead) == Token::name || kind(ahead) == Token::left_bracket || kind(ahead) == Token::right_bracket)
        ++ahead; // its result and name
    if (kind(ahead) != Token::left_paren) return false;
    for (const size_t end = closer_ahead(ahead, list.tokens.size()); ahead < end; ++ahead)
        if (kind(ahead) == Token::name && text(ahead) == any_size && kind(ahead - 1) != Token::name) return true;
    return false;
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
        function(result);
    }
    one_size = {};
}

// The rest of a head behind '(': [parameter {"," parameter} [","]] ")"
template <class Parameter>
void Grammar::parameters(std::vector<Parameter>& into, Parameter (Grammar::*read)(), bool may_end_in_comma)
{
    const Span opener = previous_span();
    if (!at(Token::right_paren) && !at(Token::left_brace)) {
        do {
            const size_t first_position = position;
            into.push_back((this->*read)());
            if (ends_parameter(opener)) continue;
            forget(into.back());
            is_head_damaged = true;
            find_next_parameter(first_position);
        } while (next_parameter() && !(may_end_in_comma && at(Token::right_paren)));
    }
    close_head(opener);
}

void Grammar::function(File& result)
{
    Function made;
    const size_t first_token = position;
    are_types_behind = skip_word_of_function();
    if (lost) return;
    made.result = type_name();
    const Span first = made.result.base.span;
    if (made.result.base.text.empty()) stand_again();
    if (lost) return;
    made.name = name_after(made.result);
    if (made.name.text.empty()) return;
    made.doc = doc_before(first_token, &made.facts);
    has_own_grad |= made.name.text == "grad";
    const uint32_t mistakes_before = mistakes;
    if (expect(Token::left_paren, "after the name of the function")) {
        if (text() == "void" && kind(1) == Token::right_paren) advance();
        parameters(made.parameters, &Grammar::function_parameter, false);
    }
    is_head_damaged |= lost;
    if (are_types_behind && at(Token::arrow) && kind(1) == Token::name) advance(2);
    are_types_behind = false;
    if (at(Token::semicolon) && !lost) {
        advance();
        diagnostics
            .warning(since(first), "prototype", "functions may stand in any order: a prototype does nothing",
                     "leave it out")
            .fix = FixIt{since(first), ""};
        return;
    }
    made.body = body_of("the function '" + made.name.text + "'");
    made.damage = take_damage(mistakes_before, made.body);
    result.lacks_functions |= is_head_damaged;
    made.span = since(first);
    result.functions.push_back(std::move(made));
}

// function_parameter = ["const"] ["in" | "out" | "inout"] type name ["=" expression]
//                    | type name "(" [type [name] {"," type [name]}] ")"
FunctionParameter Grammar::function_parameter()
{
    FunctionParameter parameter;
    const Span first = span();
    accept(Token::kw_const);
    if (accept(Token::kw_out)) {
        parameter.passing = Passing::out;
    } else if (text() == "inout" && kind(1) == Token::name) {
        parameter.passing = Passing::inout;
        advance();
    } else {
        accept(Token::kw_in); // as GLSL writes it
    }
    read_type_behind_name(are_types_behind);
    parameter.type = type_name();
    if (lost) return parameter;
    parameter.name = name_after(parameter.type);
    if (parameter.name.text.empty()) return parameter;
    array_suffix(parameter.type);
    if (at(Token::left_paren)) function_signature(parameter);
    parameter.span = since(first);
    if (!lost && accept(Token::assign)) parameter.value = expression();
    parameter.span = since(first);
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

// texture = "texture" name "(" [texture_parameter {"," texture_parameter}] ")" block | preset
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
    made.name = name("after 'texture'");
    if (made.name.text.empty()) return;
    if (result.textures.size() + result.presets.size() == textures_max) {
        error(made.name.span, "too-large", "expected at most " + std::to_string(textures_max) + " textures in a file",
              "put the others into another file");
        // Trees of what is refused would cost more than all else: names alone are kept.
        result.unread.insert(made.name.text);
        for (size_t i = position; i < list.tokens.size(); ++i)
            if (list.tokens[i - 1].kind == Token::kw_texture && list.tokens[i].kind == Token::name)
                result.unread.emplace(sources.text({file, list.tokens[i].begin, list.tokens[i].end}));
        return give_up();
    }
    if (accept(Token::assign)) return preset(result, std::move(made), first);
    if (at(Token::left_brace)) {
        diagnostics.error(made.name.span, "syntax", "expected '(' after the name of the texture",
                          "write 'texture " + made.name.text + "()' if it has no parameters");
    } else if (expect(Token::left_paren, "after the name of the texture")) {
        parameters(made.parameters, &Grammar::texture_parameter, true);
        std::erase_if(made.parameters, [](const TextureParameter& one) { return one.name.text.empty(); });
    } else {
        return;
    }
    const size_t body = position;
    made.body = body_of("the texture '" + made.name.text + "'");
    made.damage = take_damage(mistakes_before, made.body);
    made.span = since(first);
    if (made.body && !made.damage.any) read_as_function(made, body);
    result.textures.push_back(std::move(made));
}

// preset = "texture" name "=" name "(" [name "=" expression {"," name "=" expression}] ")" ";"        Behind "=".
void Grammar::preset(File& result, Texture head, Span first)
{
    Preset made{std::move(head.doc),
                std::move(head.name),
                at_prefixed_name() ? prefixed_name() : name("of a texture"),
                {},
                {},
                {}};
    if (lost || !expect(Token::left_paren, "and other defaults of the texture")) return;
    made.values = arguments(&made.names);
    made.names.resize(made.values.size());
    if (!lost) expect_semicolon("the preset");
    made.span = since(first);
    if (!lost) result.presets.push_back(std::move(made));
}

// Read anew: a tree is checked for one use. What is told of both is told once, since it is at one place.
void Grammar::read_as_function(Texture& texture, size_t body)
{
    const size_t behind = position;
    position = body;
    texture.as_function = head_as_function(texture);
    texture.as_function.body = body_of("the texture '" + texture.name.text + "'");
    position = behind;
}

// texture_parameter = ["out"] type name ["=" expression ["in" (binary ".." binary | choices)]]
TextureParameter Grammar::texture_parameter()
{
    TextureParameter parameter;
    const Span first = span();
    parameter.doc = doc_before(position, nullptr);
    parameter.is_output = accept(Token::kw_out);
    if (foreign_word(ForeignKind::declaration, text()) && kind(1) == Token::name) {
        diagnostics.error(span(), "foreign-word", not_in_haptel(), "leave it out");
        advance();
    }
    parameter.type = type_name();
    if (lost) return parameter;
    parameter.name = name_after(parameter.type);
    if (parameter.name.text.empty()) return parameter;
    array_suffix(parameter.type);
    const bool needs_default = !parameter.is_output && parameter.type.base.text != "image";
    if (at(Token::assign) && kind(1) == Token::string && parameter.type.base.text == "string") { // told
        advance(2);
        parameter.value = unknown(previous_span());
    } else if (accept(Token::assign)) {
        parameter.value = expression();
        read_decimal_comma();
    } else if (needs_default && !lost && find_output(parameter.name.text)) {
        parameter.is_output = true;
        diagnostics.error(parameter.name.span, "missing-default",
                          "the parameter '" + parameter.name.text +
                              "' needs a default value; an output begins with 'out'",
                          "write out " + parameter.type.base.text + " " + parameter.name.text);
    } else if (needs_default && !lost) {
        parameter.value = unknown(parameter.name.span);
        if (const std::string& type = parameter.type.base.text; is_type_word(type)) { // else enough is said
            const std::string one = type.starts_with("vec") ? type + "(1.0)" : "1.0";
            diagnostics.error(parameter.name.span, "missing-default",
                              "the parameter '" + parameter.name.text + "' needs a default value",
                              "for example " + type + " " + parameter.name.text + " = " + one + " in 0.0 .. 10.0");
            lost = !at(Token::kw_in) && !at(Token::comma) && !at(Token::right_paren); // "float depth 1mm"
        }
    }
    skip_metadata();
    read_misspelt_in();
    if (!lost && accept(Token::kw_in)) at_choices() ? choices_of(parameter) : range_of(parameter);
    parameter.span = since(first);
    return parameter;
}

// Behind "in".
void Grammar::range_of(TextureParameter& parameter)
{
    if (at(Token::left_bracket))
        bracketed_range(parameter);
    else
        parameter.minimum = binary(1);
    read_decimal_comma();
    if (parameter.maximum) return; // told
    if (!lost && at(Token::dot_dot)) {
        advance();
        parameter.maximum = binary(1);
        read_decimal_comma();
    } else {
        error(span(), "range", "expected '..' and the upper end of the range" + found(),
              "a range is written 0.2mm .. 5mm");
    }
    if (!parameter.maximum) parameter.maximum = unknown(previous_span());
}

// choices = "{" name {"," name} [","] "}"
void Grammar::choices_of(TextureParameter& parameter)
{
    const Span opener = span();
    do {
        advance();
        if (at(Token::right_brace) && !parameter.choices.empty()) break;
        if (!at(Token::name)) {
            error(span(), "choices", "expected the name of a choice" + found(),
                  "choices are names, the first is 0: in {smooth, ribbed}");
            break;
        }
        parameter.choices.push_back({std::string(text()), span()});
        advance();
    } while (at(Token::comma));
    if (at(Token::assign))
        error(span(), "choices", "expected ',' or '}' behind the name of a choice" + found(),
              "choices count from 0 and have no other numbers");
    close(Token::right_brace, opener, true);
}

} // namespace haptel::lang
