#include "lang/emit/helper_text.h"

namespace haptel::emit {

namespace {

bool is_word(char c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

// Whether the word stands in the text, not as a part of another.
bool names(std::string_view text, std::string_view word)
{
    for (size_t at = 0; (at = text.find(word, at)) != text.npos; at += word.size())
        if ((at == 0 || !is_word(text[at - 1])) &&
            (at + word.size() == text.size() || !is_word(text[at + word.size()])))
            return true;
    return false;
}

std::string replaced(std::string_view text, const Replacements& replacements)
{
    std::string made;
    for (size_t at = 0; at < text.size();) {
        size_t end = at + 1;
        if (is_word(text[at]))
            while (end < text.size() && is_word(text[end])) ++end;
        std::string_view word = text.substr(at, end - at);
        for (const auto& [name, value] : replacements)
            if (word == name) word = value;
        made += word;
        at = end;
    }
    return made;
}

} // namespace

void add(std::vector<Helper>& helpers, std::span<const HelperText> texts, const Replacements& replacements)
{
    for (const auto& [name, text] : texts) helpers.push_back({name, replaced(text, replacements)});
}

std::string called_by(std::string_view text, std::span<const Helper> helpers)
{
    std::string called;
    for (auto helper = helpers.rbegin(); helper != helpers.rend(); ++helper)
        if (names(text, helper->name) || names(called, helper->name)) called.insert(0, helper->text + "\n\n");
    return called;
}

} // namespace haptel::emit
