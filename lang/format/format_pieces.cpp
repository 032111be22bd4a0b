#include "lang/format/format_pieces.h"

#include <algorithm>

namespace haptel::lang {

namespace {

// The space between two tokens: comments and line ends.
class Gap {
public:
    Gap(std::string_view between, Piece* piece_before, Piece& piece_after)
        : text(between), before(piece_before), after(piece_after)
    {
    }

    void read()
    {
        while (at < text.size()) {
            if (text[at] == '\n' || text[at] == '\r')
                line_end();
            else if (text[at] == '/')
                comment();
            else
                ++at;
        }
        after.begins_line = lines > 0 || !before;
        after.blank_above = lines_above > 1;
        if (pending.empty()) return;
        if (after.kind == Token::right_brace && before && before->kind == Token::semicolon && lines == 0) {
            before->trailing = pending;
            return;
        }
        constexpr Token glued[] = {Token::comma, Token::semicolon, Token::right_paren, Token::right_bracket};
        const bool is_glued = std::find(std::begin(glued), std::end(glued), after.kind) != std::end(glued);
        after.text = pending + (is_glued ? "" : " ");
        after.has_comment = true;
    }

private:
    void line_end()
    {
        if (text.substr(at).starts_with("\r\n")) ++at;
        ++at;
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
    }

    void comment()
    {
        const bool block = text[at + 1] == '*';
        const size_t end = block ? text.find("*/", at + 2) + 2 : std::min(text.find_first_of("\r\n", at), text.size());
        std::string words;
        for (size_t i = at; i < end; ++i) {
            const bool pair = text[i] == '\r' && i + 1 < end && text[i + 1] == '\n';
            if (!pair) words += text[i] == '\r' ? '\n' : text[i];
        }
        while (words.ends_with(' ') || words.ends_with('\t')) words.pop_back();
        if (pending.empty()) blank = lines_above > 1;
        pending += (pending.empty() ? "" : " ") + words;
        at = end;
    }

    std::string_view text;
    Piece* before; // null: the file begins here
    Piece& after;
    size_t at = 0;
    size_t lines = 0;       // ended so far
    size_t lines_above = 0; // since the last comment
    std::string pending;    // comments of this line
    bool blank = false;     // an empty line above them
};

} // namespace

std::vector<Piece> pieces_of(std::string_view text, const std::vector<PlacedToken>& tokens)
{
    std::vector<Piece> pieces(tokens.size());
    size_t done = text.starts_with("\xEF\xBB\xBF") ? 3 : 0;
    for (size_t i = 0; i < tokens.size(); ++i) {
        const bool is_end = tokens[i].kind == Token::end; // a comment may end the file without a line end
        std::string between(text.substr(done, tokens[i].begin - done));
        if (is_end) between += '\n';
        pieces[i].kind = tokens[i].kind;
        Gap(between, i > 0 ? &pieces[i - 1] : nullptr, pieces[i]).read();
        pieces[i].text += text.substr(tokens[i].begin, tokens[i].end - tokens[i].begin);
        done = tokens[i].end;
    }
    return pieces;
}

bool opens(Token kind)
{
    return kind == Token::left_paren || kind == Token::left_bracket || kind == Token::left_brace;
}

bool closes(Token kind)
{
    return kind == Token::right_paren || kind == Token::right_bracket || kind == Token::right_brace;
}

size_t width_of(std::string_view text)
{
    return static_cast<size_t>(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

} // namespace haptel::lang
