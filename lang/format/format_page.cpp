#include "lang/format/format_page.h"

#include "lang/syntax/operators.h"

#include <algorithm>
#include <limits>

namespace haptel::lang {

namespace {

// Columns that a line of UTF-8 takes.
size_t width_of(std::string_view text)
{
    return static_cast<size_t>(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

bool ends_operand(const Piece& piece)
{
    constexpr Token ends[] = {Token::name, Token::number, Token::string, Token::kw_true, Token::kw_false};
    return closes(piece.kind) || std::ranges::find(ends, piece.kind) != std::end(ends);
}

bool is_step(Token kind)
{
    return kind == Token::plus_plus || kind == Token::minus_minus;
}

bool is_prefix(std::span<const Piece> pieces, size_t i)
{
    const Token kind = pieces[i].kind;
    if (kind == Token::bang || kind == Token::tilde) return true;
    const bool follows_operand = i > 0 && !pieces[i].begins_statement && ends_operand(pieces[i - 1]);
    return (kind == Token::minus || kind == Token::plus || is_step(kind)) && !follows_operand;
}

// Whether a space stands between piece `i` (> 0) and the one before.
bool is_spaced(std::span<const Piece> pieces, size_t i)
{
    const Token before = pieces[i - 1].kind, here = pieces[i].kind;
    if (pieces[i].begins_statement) return true;
    if (pieces[i].has_comment) return !opens(before);
    if (pieces[i].ends_label || here == Token::comma || here == Token::semicolon || here == Token::right_paren ||
        here == Token::right_bracket)
        return false;
    if (opens(before) || before == Token::dot) return false;
    if (here == Token::dot) return before == Token::number; // "1 .x" is not "1.x"
    if (is_prefix(pieces, i - 1)) return here == before;    // "- -x" is not "--x"
    if (is_step(here)) return is_prefix(pieces, i);
    if (here == Token::left_paren || here == Token::left_bracket) return !ends_operand(pieces[i - 1]);
    if (here == Token::right_brace && i > 1) return false;
    return true;
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

size_t space_before(std::span<const Piece> pieces, size_t i)
{
    return (i > 0 && is_spaced(pieces, i) ? 1 : 0) + pieces[i].lead;
}

// By a comment, above piece `i` (> 0).
bool is_broken(std::span<const Piece> pieces, size_t i)
{
    return !pieces[i].above.empty() || !pieces[i - 1].trailing.empty();
}

// Behind as many pieces from `begin` on as fit a line, or where a line end before that hurts least.
size_t end_of_line(std::span<const Piece> pieces, size_t begin, size_t column)
{
    int least = never, depth = 0;
    size_t best = pieces.size();
    for (size_t i = begin; i < pieces.size(); ++i) {
        if (i > begin) {
            if (is_broken(pieces, i)) return i;
            const int cost = cost_of_break(pieces, i);
            if (cost != never && cost + 100 * depth <= least) {
                least = cost + 100 * depth;
                best = i;
            }
            column += space_before(pieces, i);
        }
        column += width_of(pieces[i].text);
        if (column > Page::width && best < pieces.size()) return best;
        if (opens(pieces[i].kind)) ++depth;
        if (closes(pieces[i].kind)) --depth;
    }
    return column <= Page::width ? pieces.size() : best;
}

// Where a broken line goes on: below the first piece inside of the innermost bracket, or of the value.
struct Anchor {
    size_t piece; // the first one inside
    size_t column;
    bool is_value;
};

} // namespace

bool fits(std::span<const Piece> pieces, size_t indent)
{
    size_t column = indent;
    for (size_t i = 0; i < pieces.size(); ++i) {
        if (i > 0 && is_broken(pieces, i)) return false;
        column += space_before(pieces, i) + width_of(pieces[i].text);
        if (column > Page::width) return false;
    }
    return true;
}

size_t columns_of(std::span<const Piece> pieces)
{
    size_t columns = 0;
    for (size_t i = 0; i < pieces.size(); ++i) columns += space_before(pieces, i) + width_of(pieces[i].text);
    return columns;
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

void Page::put(std::span<const Piece> pieces, size_t indent, size_t hang)
{
    std::vector<Anchor> anchors;
    const bool whole = fits(pieces, indent);
    for (size_t begin = 0, end = 0; begin < pieces.size(); begin = end) {
        // Below what the line goes on with; not where that stands too far right, or is what begins here.
        size_t column = begin == 0 ? indent : indent + hang;
        if (!anchors.empty() && anchors.back().piece < begin && anchors.back().column <= width * 6 / 10)
            column = anchors.back().column;
        if (pieces[begin].kind == Token::left_brace) column = indent; // of a body, below a comment
        put_above(pieces[begin], column);

        end = whole ? pieces.size() : end_of_line(pieces, begin, column);
        std::string line(column, ' ');
        for (size_t i = begin; i < end; ++i) {
            const Token kind = pieces[i].kind;
            if (i > begin) line.append(space_before(pieces, i), ' ');
            line += pieces[i].text;
            if (closes(kind) || kind == Token::comma) // of a declaration: the value before it ends
                while (!anchors.empty() && anchors.back().is_value) anchors.pop_back();
            if (closes(kind) && !anchors.empty()) anchors.pop_back();
            const bool value_follows = is_assignment(kind) || kind == Token::kw_return;
            if (opens(kind) || value_follows)
                anchors.push_back({i + 1, width_of(line) + (value_follows ? 1 : 0), value_follows});
        }
        lines.push_back({line, pieces[end - 1].trailing});
    }
}

void Page::end_list()
{
    size_t longest = 0;
    for (size_t i = list_begin; i < lines.size(); ++i)
        if (!lines[i].text.ends_with("*/")) longest = std::max(longest, width_of(lines[i].text));
    for (size_t i = list_begin; i < lines.size(); ++i) lines[i].comment_column = longest + 2;
}

// Trailing comments of lines in a row stand in one column, where the page is wide enough.
void Page::align_runs()
{
    for (size_t begin = 0; begin < lines.size();) {
        size_t end = begin, longest = 0, widest = 0;
        const size_t indent = lines[begin].text.find_first_not_of(' ');
        while (end < lines.size() && !lines[end].trailing.empty() && lines[end].comment_column == 0 &&
               lines[end].text.find_first_not_of(' ') == indent) {
            longest = std::max(longest, width_of(lines[end].text));
            widest = std::max(widest, width_of(lines[end].trailing));
            ++end;
        }
        if (longest + 1 + widest <= width)
            for (size_t i = begin; i < end; ++i) lines[i].comment_column = longest + 1;
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
        const size_t end = width_of(line.text);
        if (!line.trailing.empty())
            result += std::string(std::max(line.comment_column, end + 1) - end, ' ') + line.trailing;
        result += '\n';
    }
    return result;
}

} // namespace haptel::lang
