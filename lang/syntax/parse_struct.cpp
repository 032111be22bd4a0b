// Structs.
#include "lang/syntax/grammar.h"

#include <utility>

namespace haptel::lang {

using namespace ast;

// struct = "struct" name "{" {type declarator {"," declarator} ";"} "}" ";"      without initializers
void Grammar::structure(File& result)
{
    Struct made;
    const Span first = span();
    advance();
    made.name = name("after 'struct'");
    const Span opener = span();
    if (lost || !expect(Token::left_brace, "and the members of the struct")) return;
    const uint32_t mistakes_before = mistakes;
    while (!at(Token::right_brace) && !at(Token::end) && !at(Token::kw_struct) && !at_top_level_start()) {
        const size_t first_position = position;
        Statements members;
        declarations(members);
        for (const StatementPtr& member : members) {
            auto declared = std::get_if<Declaration>(&member->node);
            if (!declared || declared->initializer || declared->is_const)
                error(member->span, "struct", "a member of a struct is declared without a value, and without 'const'",
                      "values are given where the struct is made: " + made.name.text + "(...)");
            else
                made.members.push_back({std::move(declared->type), std::move(declared->name)});
        }
        if (lost) {
            find_footing();
            note_unread(first_position);
            stand_again();
        }
        if (position == first_position) advance();
    }
    if (!close(Token::right_brace, opener)) return;
    made.span = since(first);
    struct_names.insert(made.name.text);
    if (mistakes != mistakes_before) result.unread.insert(made.name.text); // enough is said of it
    result.unread.merge(unread);
    const std::string name_of_type = made.name.text;
    if (mistakes == mistakes_before) result.structs.push_back(std::move(made));
    if (at(Token::name) && !on_new_line() && kind(1) != Token::left_paren && kind(1) != Token::name) {
        error(span(), "struct", "a struct is declared on its own" + found(),
              "close it with ';' and write const " + name_of_type + " " + std::string(text()) + " = " + name_of_type +
                  "(...);");
    } else {
        expect_semicolon("the struct");
    }
}

} // namespace haptel::lang
