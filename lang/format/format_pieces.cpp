// Tokens and the space between them to pieces.
#include "lang/format/format_page.h"

namespace haptel::lang {

namespace {

std::string with_plain_line_ends(std::string_view text)
{
    std::string plain;
    for (size_t i = 0; i < text.size(); ++i)
        if (text[i] != '\r')
            plain += text[i];
        else if (!text.substr(i + 1).starts_with('\n'))
            plain += '\n';
    return plain;
}

// The comments and line ends in the space between two tokens. `before` is null where the file begins.
void read_space(std::string_view text, Piece* before, Piece& after)
{
    size_t lines = 0, lines_above = 0; // ended so far; since the last comment
    std::string pending;               // comments of this line
    bool blank = false;                // an empty line above them
    for (size_t at = 0; at < text.size();) {
        if (text[at] == '\n') {
            if (!pending.empty()) {
                if (lines == 0 && before)
                    before->trailing = pending;
                else
                    after.above.push_back({pending, blank});
                pending.clear();
                lines_above = 0;
            }
            ++lines;
            ++lines_above;
            ++at;
        } else if (text[at] == '/') {
            const size_t end = text[at + 1] == '*' ? text.find("*/", at + 2) + 2 : text.find('\n', at);
            const std::string_view comment = text.substr(at, end - at);
            if (pending.empty())
                blank = lines_above > 1;
            else
                pending += ' ';
            pending += comment.substr(0, comment.find_last_not_of(" \t") + 1);
            at = end;
        } else {
            ++at;
        }
    }
    after.begins_line = lines > 0 || !before;
    after.blank_above = lines_above > 1;
    if (pending.empty()) return;
    if (after.kind == Token::right_brace && before && before->kind == Token::semicolon && lines == 0) {
        before->trailing = pending;
        return;
    }
    const bool is_glued = after.kind == Token::comma || after.kind == Token::semicolon ||
                          after.kind == Token::right_paren || after.kind == Token::right_bracket;
    after.text = pending + (is_glued ? "" : " ");
    after.has_comment = true;
}

} // namespace

std::vector<Piece> pieces_of(std::string_view text, const std::vector<PlacedToken>& tokens)
{
    std::vector<Piece> pieces(tokens.size());
    size_t done = text.starts_with("\xEF\xBB\xBF") ? 3 : 0;
    for (size_t i = 0; i < tokens.size(); ++i) {
        std::string space = with_plain_line_ends(text.substr(done, tokens[i].begin - done));
        if (tokens[i].kind == Token::end) space += '\n'; // a comment may end the file without a line end
        pieces[i].kind = tokens[i].kind;
        read_space(space, i > 0 ? &pieces[i - 1] : nullptr, pieces[i]);
        pieces[i].text += text.substr(tokens[i].begin, tokens[i].end - tokens[i].begin);
        done = tokens[i].end;
    }
    return pieces;
}

} // namespace haptel::lang
