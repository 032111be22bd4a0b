// Where statements begin and end, how deep they stand, and which of them are broken into lists.
#include "lang/format/format.h"

#include "lang/format/format_page.h"
#include "lang/syntax/parser.h"

#include <algorithm>

namespace haptel::lang {

namespace {

constexpr size_t step = Page::step;

class Formatter {
public:
    explicit Formatter(std::vector<Piece> all) : pieces(std::move(all))
    {
        for (size_t i = 0; i + 1 < pieces.size(); ++i)
            if (begins_case(i)) find_end_of_label(i);
        for (size_t i = 0; i + 1 < pieces.size(); ++i) // a while stands as a for does
            if (pieces[i].kind == Token::name && pieces[i].text.ends_with("while") &&
                pieces[i + 1].kind == Token::left_paren && begins_statement(i))
                pieces[i].kind = Token::kw_for;
    }

    std::string run()
    {
        while (kind() != Token::end) top_level();
        page.put_above(pieces[at], 0);
        return page.text();
    }

private:
    Token kind() const { return pieces[at].kind; }
    bool begins_statement(size_t i) const
    {
        if (i == 0) return false;
        const Token before = pieces[i - 1].kind;
        return before == Token::left_brace || before == Token::right_brace || before == Token::semicolon ||
               before == Token::right_paren || before == Token::kw_else || pieces[i - 1].ends_label;
    }
    bool begins_case(size_t i) const { return pieces[i].kind == Token::kw_case || pieces[i].kind == Token::kw_default; }
    // The ':' that belongs to no '?'.
    void find_end_of_label(size_t i)
    {
        size_t choices = 0;
        for (; i + 1 < pieces.size(); i = opens(pieces[i].kind) ? behind_bracket(i) : i + 1) {
            if (pieces[i].kind == Token::question) ++choices;
            if (pieces[i].kind != Token::colon || choices-- > 0) continue;
            pieces[i].ends_label = pieces[i + 1].begins_statement = true;
            return;
        }
    }
    std::span<const Piece> part(size_t begin, size_t end) const
    {
        return std::span<const Piece>(pieces).subspan(begin, end - begin);
    }
    void put(size_t begin, size_t end, size_t indent) { page.put(part(begin, end), indent); }

    // Behind the bracket that closes the one at `from`.
    size_t behind_bracket(size_t from) const
    {
        size_t depth = 0;
        for (size_t i = from; i < pieces.size(); ++i) {
            if (opens(pieces[i].kind)) ++depth;
            if (closes(pieces[i].kind) && --depth == 0) return i + 1;
        }
        return pieces.size() - 1;
    }

    // Behind the ';' that ends the statement at `from`.
    size_t behind_statement(size_t from) const
    {
        for (size_t i = from; i + 1 < pieces.size();) {
            if (pieces[i].kind == Token::semicolon) return i + 1;
            i = opens(pieces[i].kind) ? behind_bracket(i) : i + 1;
        }
        return pieces.size() - 1;
    }

    void top_level()
    {
        if (kind() == Token::kw_struct) return structure();
        size_t opener = at;
        while (pieces[opener].kind != Token::left_paren && pieces[opener].kind != Token::semicolon) ++opener;
        const bool has_body = kind() != Token::kw_import && kind() != Token::kw_const &&
                              pieces[opener].kind == Token::left_paren &&
                              pieces[behind_bracket(opener)].kind == Token::left_brace;
        if (!has_body) return simple(0);
        page.blank_line();
        const size_t end = behind_bracket(opener);
        const bool begins_list = end > opener + 2 && pieces[opener + 1].begins_line;
        if (kind() == Token::kw_texture && (begins_list || !fits(part(at, end), 0))) {
            put(at, opener + 1, 0);
            parameters(opener, end);
        } else {
            put(at, end, 0);
        }
        at = end;
        block(0);
        if (kind() != Token::semicolon) page.blank_line();
    }

    // A member per line.
    void structure()
    {
        size_t begin = at;
        while (kind() != Token::left_brace) ++at;
        const size_t end = behind_statement(begin);
        page.blank_line();
        put(begin, ++at, 0);
        rest_of_block(0);
        put(at, end, 0);
        at = end;
        page.blank_line();
    }

    // Those of a texture, one per line, the ranges below one another.
    void parameters(size_t opener, size_t end)
    {
        struct Parameter {
            size_t begin, end, range; // range: of its "in", or `end`
        };
        std::vector<Parameter> all;
        size_t longest = 0;
        for (size_t i = opener + 1; i < end; i = all.back().end) {
            Parameter one{i, i, end};
            while (one.end < end && pieces[one.end].kind != Token::comma) {
                if (pieces[one.end].kind == Token::kw_in && one.range == end && one.end > i) one.range = one.end;
                one.end = opens(pieces[one.end].kind) ? behind_bracket(one.end) : one.end + 1;
            }
            one.end = std::min(one.end + 1, end); // the comma
            one.range = std::min(one.range, one.end);
            if (one.range < one.end) longest = std::max(longest, columns_of(part(one.begin, one.range)));
            all.push_back(one);
        }
        page.begin_list();
        for (const auto& [first, last, range] : all) {
            if (range < last) {
                pieces[range].lead = longest - columns_of(part(first, range));
                if (!fits(part(first, last), step)) pieces[range].lead = 0;
            }
            put(first, last, step);
        }
        page.end_list();
    }

    // From '{' on.
    void block(size_t indent)
    {
        put(at, at + 1, indent);
        ++at;
        rest_of_block(indent);
        put(at, at + 1, indent);
        ++at;
    }

    // Behind '{', to before '}'.
    void rest_of_block(size_t indent)
    {
        while (kind() != Token::right_brace && kind() != Token::end) statement(indent + step);
        pieces[at].blank_above = false;
        page.put_above(pieces[at], indent + step); // they belong to what stands above
        pieces[at].above.clear();
    }

    void statement(size_t indent)
    {
        if (kind() == Token::left_brace)
            block(indent);
        else if (begins_case(at))
            one_case(indent - step);
        else if (nests(at))
            controlled(indent);
        else
            simple(indent);
    }

    bool nests(size_t i) const
    {
        return pieces[i].kind == Token::kw_if || pieces[i].kind == Token::kw_for || pieces[i].kind == Token::kw_switch;
    }

    // Labels stand as deep as their switch, in the author's rows if all fit, else one per line; what they lead to
    // stands behind them if the author has it there in one line.
    void one_case(size_t indent)
    {
        std::vector<size_t> labels, rows;
        while (begins_case(at)) {
            if (labels.empty() || pieces[at].begins_line) rows.push_back(at);
            labels.push_back(at);
            while (!pieces[at++].ends_label) {
            }
        }
        const auto row_fits = [&](const size_t& row) {
            return fits(part(row, &row == &rows.back() ? at : *(&row + 1)), indent);
        };
        if (!std::ranges::all_of(rows, row_fits)) rows = labels;
        for (size_t r = 0; r + 1 < rows.size(); ++r) put(rows[r], rows[r + 1], indent);
        const size_t begin = rows.back();
        size_t end = at;
        bool is_short = true;
        while (pieces[end].kind != Token::right_brace && pieces[end].kind != Token::end && !begins_case(end)) {
            is_short &= !pieces[end].begins_line && !nests(end) && pieces[end].kind != Token::left_brace;
            end = opens(pieces[end].kind) ? behind_bracket(end) : end + 1;
        }
        if (is_short && fits(part(begin, end), indent)) {
            put(begin, end, indent);
            at = end;
        } else if (kind() == Token::left_brace) {
            put(begin, ++at, indent);
            rest_of_block(indent);
            put(at, at + 1, indent);
            ++at;
        } else {
            put(begin, at, indent);
        }
        while (at < end) statement(indent + step);
    }

    // if, for and switch: the brace in the line of the head, a single statement too where there is room.
    void controlled(size_t indent)
    {
        for (size_t begin = at;;) { // of the line, "} else" included
            const bool may_have_else = kind() != Token::kw_for && kind() != Token::kw_switch;
            if (kind() == Token::kw_else) ++at;
            const bool last = kind() != Token::kw_if && may_have_else;
            if (!last) at = behind_bracket(at + 1);
            if (kind() == Token::left_brace) {
                put(begin, at + 1, indent);
                ++at;
                rest_of_block(indent);
                begin = at++;
            } else {
                pieces[at].begins_statement = true;
                const size_t end = behind_statement(at);
                if (!nests(at) && fits(part(begin, end), indent)) {
                    put(begin, end, indent);
                    at = end;
                } else {
                    put(begin, at, indent);
                    statement(indent + step);
                }
                begin = at;
            }
            const bool goes_on = may_have_else && !last && kind() == Token::kw_else;
            const bool breaks = goes_on && (!pieces[at].above.empty() || (at > 0 && !pieces[at - 1].trailing.empty()));
            if (begin < at && (!goes_on || breaks)) {
                put(begin, at, indent);
                begin = at;
            }
            if (!goes_on) return;
        }
    }

    void simple(size_t indent)
    {
        const bool is_idle = kind() == Token::semicolon && at > 0 && pieces[at - 1].kind == Token::right_brace &&
                             pieces[at - 1].trailing.empty() && pieces[at].above.empty() && !pieces[at].has_comment;
        if (is_idle) { // "};", as after a struct
            page.append(pieces[at++]);
            if (indent == 0) page.blank_line();
            return;
        }
        const size_t end = std::max(behind_statement(at), at + 1);
        table(at, end, indent);
        at = end;
    }

    // A statement, with the elements of its tables on lines of their own where it does not fit one line.
    void table(size_t begin, size_t end, size_t indent)
    {
        for (;;) {
            size_t opener = begin + (pieces[begin].kind == Token::right_brace ? 1 : 0);
            while (opener < end && pieces[opener].kind != Token::left_brace) ++opener;
            if (opener == end) return put(begin, end, indent);
            const bool in_rows = pieces[opener + 1].begins_line;
            if (!in_rows && fits(part(begin, end), indent)) return put(begin, end, indent);
            const size_t closer = behind_bracket(opener) - 1;
            put(begin, opener + 1, indent);
            elements(opener + 1, closer, indent + step);
            begin = closer;
        }
    }

    // In the rows of the author if all fit, else as many in a line as fit. A row begins with an element: a line end
    // between the arguments of a call may be the formatter's own.
    void elements(size_t begin, size_t end, size_t indent)
    {
        std::vector<size_t> rows{begin};
        for (size_t i = begin; i < end;) {
            if (i > begin && pieces[i].begins_line && pieces[i - 1].kind == Token::comma) rows.push_back(i);
            i = opens(pieces[i].kind) ? behind_bracket(i) : i + 1;
        }
        rows.push_back(end);
        bool all_fit = true;
        for (size_t r = 0; r + 1 < rows.size(); ++r) all_fit = all_fit && fits(part(rows[r], rows[r + 1]), indent);
        if (!all_fit) rows = {begin, end};
        for (size_t r = 0; r + 1 < rows.size(); ++r) page.put(part(rows[r], rows[r + 1]), indent, 0);
    }

    std::vector<Piece> pieces;
    size_t at = 0;
    Page page;
};

} // namespace

std::optional<std::string> format(const SourceSet& sources, uint32_t file, Diagnostics& diagnostics)
{
    const TokenList list = lex(sources, file, diagnostics);
    parse(sources, file, list, diagnostics);
    if (diagnostics.has_errors()) return std::nullopt;
    if (list.has_directives) { // what they leave out is in no token
        diagnostics.error({file, 0, 0}, "preprocessor",
                          "a text with lines that begin with '#' has no layout of its own",
                          "haptel check --fix makes constants of some");
        return std::nullopt;
    }
    return Formatter(pieces_of(sources.file(file).text, list.tokens)).run();
}

} // namespace haptel::lang
