#include "lang/syntax/parser.h"

#include "lang/syntax/grammar.h"
#include "lang/text/near_name.h"

#include <algorithm>

namespace haptel::lang {

using namespace ast;

File parse(const SourceSet& sources, uint32_t file, Diagnostics& diagnostics)
{
    return parse(sources, file, lex(sources, file, diagnostics), diagnostics);
}

File parse(const SourceSet& sources, uint32_t file, TokenList tokens, Diagnostics& diagnostics)
{
    return Grammar(sources, file, std::move(tokens), diagnostics).parse_file();
}

// file = [language] {import | constants | struct | texture | function | macro | ";"}
File Grammar::parse_file()
{
    File result;
    const auto leave_unread = [&](size_t from) {
        note_unread(from);
        result.unread.merge(unread);
        result.lacks_functions = true;
    };
    const auto skip = [&](std::string message, std::string_view hint) { // what it declares may be used below
        const size_t from = position;
        skip_foreign_declaration(std::move(message), hint);
        note_unread(from);
        result.unread.merge(unread);
    };
    find_prefixes();
    while (!at(Token::end)) {
        begin_declaration();
        const size_t first_position = position;
        if (accept(Token::semicolon) || skip_precision()) continue;
        bool strayed = false;
        skip_foreign_qualifiers();
        if (text() == "language" && kind(1) == Token::number) { // elsewhere it is a name like any other
            language_line(result);
        } else if (at(Token::define)) {
            definition();
        } else if (at(Token::kw_import)) {
            import_declaration(result);
        } else if (at(Token::kw_const)) {
            constants(result);
        } else if (at(Token::kw_struct)) {
            structure(result);
        } else if (at(Token::kw_texture)) {
            texture(result);
        } else if ((at(Token::kw_in) || at(Token::kw_out)) && kind(1) == Token::name) {
            skip("a file has no inputs and outputs of its own",
                 at(Token::kw_in) ? "the point of contact is p, its normal n, its mesh coordinates uv"
                                  : "a texture returns its height: return 1mm;");
        } else if (const ForeignWord* word = at(Token::name) ? foreign_word(ForeignKind::declaration, text()) : nullptr;
                   word && word->replacement.empty()) {
            skip(not_in_haptel(), word->hint);
        } else if (text() == "void" && text(1) == "main" && kind(2) == Token::left_paren) {
            skip("a file of Haptel has no main()", "write texture name() { return ...; }: it returns the height at p");
        } else {
            strayed = !at(Token::name) || !top_level_name(result);
        }
        if (strayed) report_stray(result);
        if (lost) {
            find_top_level(strayed);
            leave_unread(first_position);
            stand_again();
        }
        if (position == first_position) advance();
    }
    if (given_up < position) leave_unread(given_up);
    return result;
}

// Forgets what was found out about the one before.
void Grammar::begin_declaration()
{
    lost = false;
    unread.clear();
    is_head_damaged = is_misshapen = has_stray_brace = false;
    depth = Nesting::bracket;
}

// language = "language" number ";"       first of all; which number it may be is asked where the text is compiled
void Grammar::language_line(File& result)
{
    if (position > 0)
        slip(span(), "language-version", "the version of the language stands before all else in a file",
             "make it the first line");
    advance();
    result.language = span();
    advance();
    expect_semicolon("the version of the language");
}

// Statements outside of any body: a '}' too many above, or a slip.
void Grammar::report_stray(File& result)
{
    const bool statement_like = kind() >= Token::kw_if || at(Token::name) || at(Token::right_brace);
    Diagnostic& reported =
        error(span(), "syntax", "expected a texture, function, constant, struct or import" + found());
    if (!statement_like) return;
    reported.hint = "statements stand inside functions and textures; is there a '}' too many above?";
    // Then the body above has ended too early.
    const uint32_t end_of_function = result.functions.empty() ? 0 : result.functions.back().span.end;
    const uint32_t end_of_texture = result.textures.empty() ? 0 : result.textures.back().span.end;
    const auto spoil_last = [&](auto& all) {
        for (auto& above : all)
            if (above.span.end == std::max(end_of_function, end_of_texture)) {
                above.damage.any = true;
                above.body = nullptr;
            }
    };
    spoil_last(result.functions); // of every size
    spoil_last(result.textures);
}

// A name at the top: a function's type; or a slip. False if nothing at all can begin like this.
bool Grammar::top_level_name(File& result)
{
    const ForeignWord* foreign = foreign_word(ForeignKind::declaration, text()); // read as another word
    std::string_view guess =
        is_type_word(text()) ? std::string_view{} : near_name(text(), {"texture", "import", "const"}).name;
    if (foreign) guess = foreign->replacement;
    const bool follows = kind(1) == Token::name || (guess == "import" && kind(1) == Token::string);
    if (!guess.empty() && follows) {
        Diagnostic& reported = slip(span(), foreign ? ErrorCode("foreign-word") : ErrorCode("syntax"),
                                    "expected 'texture' or the type of a function" + found(),
                                    foreign ? foreign->hint : "did you mean '" + std::string(guess) + "'?");
        if (!foreign) reported.fix = FixIt{span(), std::string(guess)};
        if (guess == "const") list.tokens[position].kind = Token::kw_const;
        if (guess == "texture") list.tokens[position].kind = Token::kw_texture;
        guess == "texture" ? texture(result) : guess == "import" ? import_declaration(result) : constants(result);
        return true;
    }
    if (kind(1) != Token::name && kind(1) != Token::left_bracket && !is_type_word(text()) && !body_follows())
        return false;
    if (statements_follow()) return false;
    function_or_variable(result);
    return true;
}

// After a mistake: before the next declaration, or behind the ';' or '}' that ends this one; but statements that have
// strayed here have many of those, and end only where a declaration begins.
void Grammar::find_top_level(bool strayed)
{
    uint32_t open_braces = 0;
    if (!strayed && previous_kind() == Token::right_brace) return;
    for (; !at(Token::end) && !at_texture_or_import(); advance()) {
        if (at(Token::left_brace)) ++open_braces;
        const bool closes = at(Token::right_brace) && open_braces > 0 && --open_braces == 0;
        if (!strayed && (closes || (at(Token::semicolon) && open_braces == 0))) {
            advance();
            return;
        }
        if (open_braces == 0 && on_new_line() && (at(Token::kw_const) || at(Token::kw_struct) || at_top_level_start()))
            return;
    }
}

} // namespace haptel::lang
