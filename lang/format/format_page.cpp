#include "lang/format/format_page.h"

#include "lang/syntax/operators.h"

#include <algorithm>
#include <limits>

namespace haptel::lang {

namespace {

bool ends_operand(const Piece& piece)
{
    switch (piece.kind) {
    case Token::name:
    case Token::number:
    case Token::string:
    case Token::right_paren:
    case Token::right_bracket:
    case Token::right_brace:
    case Token::kw_true:
    case Token::kw_false: return true;
    default: return false;
    }
}

bool is_step(Token kind)
{
    return kind == Token::plus_plus || kind == Token::minus_minus;
}

bool follows_operand(std::span<const Piece> pieces, size_t i)
{
    return i > 0 && !pieces[i].begins_statement && ends_operand(pieces[i - 1]);
}

bool is_prefix(std::span<const Piece> pieces, size_t i)
{
    const Token kind = pieces[i].kind;
    if (kind == Token::bang || kind == Token::tilde) return true;
    return (kind == Token::minus || kind == Token::plus || is_step(kind)) && !follows_operand(pieces, i);
}

constexpr int never = std::numeric_limits<int>::max();

// How bad a line end before piece `i` is, brackets aside.
int cost_of_break(std::span<const Piece> pieces, size_t i)
{
    const Token before = pieces[i - 1].kind, here = pieces[i].kind;
    if (before == Token::left_paren) return 90;
    if (before == Token::left_brace) return 12;
    if (!is_spaced(pieces, i)) return never;
    if (pieces[i].begins_statement || before == Token::semicolon) return 5;
    if (before == Token::comma) return 10;
    if (here == Token::kw_in) return 15;
    if (here == Token::question || here == Token::colon) return 20;
    if (is_assignment(before)) return 180; // rather between the arguments of the one call that is the value
    if (before == Token::dot_dot) return 70;
    const Operator* ends = operator_of(before);
    return ends && !is_prefix(pieces, i - 1) ? 30 + ends->precedence : never;
}

// Where a broken line goes on: below the first piece inside of the innermost bracket, or of the value.
struct Anchor {
    size_t piece; // the first one inside
    size_t column;
};

} // namespace

bool is_spaced(std::span<const Piece> pieces, size_t i)
{
    const Token before = pieces[i - 1].kind, here = pieces[i].kind;
    if (pieces[i].begins_statement) return true;
    if (pieces[i].has_comment) return !opens(before);
    if (here == Token::comma || here == Token::semicolon || here == Token::right_paren || here == Token::right_bracket)
        return false;
    if (before == Token::left_paren || before == Token::left_bracket || before == Token::left_brace) return false;
    if (before == Token::dot) return false;
    if (here == Token::dot) return before == Token::number; // "1 .x" is not "1.x"
    if (is_prefix(pieces, i - 1)) return here == before;    // "- -x" is not "--x"
    if (is_step(here)) return is_prefix(pieces, i);
    if (here == Token::left_paren || here == Token::left_bracket) return !ends_operand(pieces[i - 1]);
    if (here == Token::right_brace && i > 1) return false;
    return true;
}

bool fits(std::span<const Piece> pieces, size_t indent, const std::vector<size_t>& lead)
{
    size_t column = indent;
    for (size_t i = 0; i < pieces.size(); ++i) {
        if (i > 0 && (!pieces[i].above.empty() || !pieces[i - 1].trailing.empty())) return false;
        column += width_of(pieces[i].text) + (i > 0 && is_spaced(pieces, i) ? 1 : 0) + (i < lead.size() ? lead[i] : 0);
        if (column > Page::width) return false;
    }
    return true;
}

void Page::put_above(const Piece& piece, size_t indent)
{
    for (const Remark& remark : piece.above) {
        if (remark.blank_above) blank_line();
        lines.push_back({std::string(indent, ' ') + remark.text, {}});
    }
    if (piece.blank_above) blank_line();
}

void Page::append(const Piece& piece)
{
    lines.back().text += piece.text;
    lines.back().trailing = piece.trailing;
}

void Page::blank_line()
{
    if (!lines.empty() && !lines.back().text.empty() && !lines.back().text.ends_with('{')) lines.push_back({});
}

void Page::put(std::span<const Piece> pieces, size_t indent, const std::vector<size_t>& lead, size_t hang)
{
    if (pieces.empty()) return;
    std::vector<Anchor> anchors;
    const auto space_before = [&](size_t i) {
        return (i > 0 && is_spaced(pieces, i) ? size_t(1) : size_t(0)) + (i < lead.size() ? lead[i] : 0);
    };
    const bool whole = fits(pieces, indent, lead);
    size_t begin = 0;
    while (begin < pieces.size()) {
        // Below what the line goes on with; not where that stands too far right, or is what begins here.
        size_t column = begin == 0 ? indent : indent + hang;
        if (begin > 0 && !anchors.empty() && anchors.back().piece < begin && anchors.back().column <= width * 6 / 10)
            column = anchors.back().column;
        if (begin > 0 && pieces[begin].kind == Token::left_brace) column = indent; // of a body, below a comment
        put_above(pieces[begin], column);

        // As many pieces as fit, up to the place where a line end hurts least.
        size_t end = pieces.size(), reached = column;
        int least = never, depth = 0;
        size_t best = pieces.size();
        for (size_t i = begin; i < pieces.size() && !whole; ++i) {
            if (i > begin) {
                if (!pieces[i - 1].trailing.empty() || !pieces[i].above.empty()) {
                    best = i;
                    break;
                }
                const int cost = cost_of_break(pieces, i);
                const int total = cost == never ? never : cost + 100 * depth;
                if (total != never && total <= least) {
                    least = total;
                    best = i;
                }
                reached += space_before(i);
            }
            reached += width_of(pieces[i].text);
            if (reached > width && best < pieces.size()) break;
            if (i + 1 == pieces.size() && reached <= width) best = pieces.size();
            if (opens(pieces[i].kind)) ++depth;
            if (closes(pieces[i].kind)) --depth;
        }
        end = best;

        std::string line(column, ' ');
        for (size_t i = begin; i < end; ++i) {
            if (i > begin) line.append(space_before(i), ' ');
            const size_t at = width_of(line);
            line += pieces[i].text;
            if (closes(pieces[i].kind))
                while (!anchors.empty() && anchors.back().piece > 0) {
                    const Token opener = pieces[anchors.back().piece - 1].kind;
                    anchors.pop_back();
                    if (opens(opener)) break;
                }
            if (pieces[i].kind == Token::comma) // of a declaration: the value before it ends
                while (!anchors.empty() && !opens(pieces[anchors.back().piece - 1].kind)) anchors.pop_back();
            const bool has_value = is_assignment(pieces[i].kind) || pieces[i].kind == Token::kw_return;
            if (opens(pieces[i].kind)) anchors.push_back({i + 1, at + width_of(pieces[i].text)});
            if (has_value) anchors.push_back({i + 1, at + width_of(pieces[i].text) + 1});
        }
        lines.push_back({line, pieces[end - 1].trailing});
        begin = end;
    }
}

void Page::end_list()
{
    size_t longest = 0;
    for (size_t i = list_begin; i < lines.size(); ++i)
        if (!lines[i].text.ends_with("*/") && !lines[i].text.starts_with("//"))
            longest = std::max(longest, width_of(lines[i].text));
    for (size_t i = list_begin; i < lines.size(); ++i) {
        lines[i].aligned = true;
        if (!lines[i].trailing.empty() && longest >= width_of(lines[i].text))
            lines[i].gap = longest - width_of(lines[i].text) + 2;
    }
}

// Trailing comments of lines in a row stand in one column, where the page is wide enough.
void Page::align_runs()
{
    for (size_t begin = 0; begin < lines.size();) {
        size_t end = begin, longest = 0, widest = 0;
        const size_t indent = lines[begin].text.find_first_not_of(' ');
        while (end < lines.size() && !lines[end].trailing.empty() && !lines[end].aligned &&
               lines[end].text.find_first_not_of(' ') == indent) {
            longest = std::max(longest, width_of(lines[end].text));
            widest = std::max(widest, width_of(lines[end].trailing));
            ++end;
        }
        if (longest + 1 + widest <= width)
            for (size_t i = begin; i < end; ++i) lines[i].gap = longest - width_of(lines[i].text) + 1;
        begin = std::max(end, begin + 1);
    }
}

std::string Page::text()
{
    align_runs();
    while (!lines.empty() && lines.back().text.empty()) lines.pop_back();
    std::string result;
    for (const Line& line : lines) {
        result += line.text;
        if (!line.trailing.empty()) result += std::string(line.gap, ' ') + line.trailing;
        result += '\n';
    }
    return result;
}

} // namespace haptel::lang
