#include "lang/text/source.h"

#include <algorithm>

namespace haptel::lang {

namespace {

constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";

// Line ends are LF, CR LF and a lone CR.
std::vector<uint32_t> find_line_starts(std::string_view text)
{
    std::vector<uint32_t> starts{0};
    starts.reserve(text.size() / 32); // as texts go
    const bool has_returns = text.find('\r') != std::string_view::npos;
    const auto next_end = [&](size_t from) {
        return has_returns ? text.find_first_of("\r\n", from) : text.find('\n', from);
    };
    for (size_t end = next_end(0); end != std::string_view::npos; end = next_end(end + 1))
        if (text[end] == '\n' || end + 1 == text.size() || text[end + 1] != '\n')
            starts.push_back(static_cast<uint32_t>(end + 1));
    return starts;
}

} // namespace

CodePoint decode_utf8(std::string_view text, size_t at)
{
    constexpr CodePoint invalid{invalid_code_point, 1};
    const auto byte = [&](size_t i) { return static_cast<unsigned char>(text[at + i]); };
    const unsigned char lead = byte(0);
    if (lead < 0x80) return {lead, 1};
    const uint32_t length = lead >= 0xC2 && lead < 0xE0   ? 2
                            : lead >= 0xE0 && lead < 0xF0 ? 3
                            : lead >= 0xF0 && lead < 0xF5 ? 4
                                                          : 0;
    if (length == 0 || at + length > text.size()) return invalid;
    char32_t value = lead & (0x7Fu >> length);
    for (uint32_t i = 1; i < length; ++i) {
        if ((byte(i) & 0xC0) != 0x80) return invalid;
        value = value << 6 | (byte(i) & 0x3Fu);
    }
    const bool overlong = (length == 3 && value < 0x800) || (length == 4 && value < 0x10000);
    const bool surrogate = value >= 0xD800 && value <= 0xDFFF;
    if (overlong || surrogate || value > 0x10FFFF) return invalid;
    return {value, length};
}

std::string printable(std::string_view text)
{
    std::string result;
    result.reserve(text.size());
    for (size_t i = 0; i < text.size();) {
        const CodePoint point = decode_utf8(text, i);
        const bool control = point.value < 0x20 || (point.value >= 0x7F && point.value < 0xA0);
        // Characters that reorder the text around them would let a message say other than it means.
        const bool reorders =
            (point.value >= 0x202A && point.value <= 0x202E) || (point.value >= 0x2066 && point.value <= 0x2069);
        if (point.value == invalid_code_point || control || reorders)
            result += "\xEF\xBF\xBD";
        else
            result += text.substr(i, point.length);
        i += point.length;
    }
    return result;
}

uint32_t SourceSet::add(SourceFile file)
{
    std::vector<uint32_t> starts = find_line_starts(file.text);
    entries.push_back({std::move(file), std::move(starts)});
    return first + static_cast<uint32_t>(entries.size()) - 1;
}

const SourceSet::Entry* SourceSet::find(uint32_t index) const
{
    if (library && index >= library->first) return library->find(index);
    return index >= first && index - first < entries.size() ? &entries[index - first] : nullptr;
}

std::string_view SourceSet::text(Span span) const
{
    const Entry* entry = find(span.file);
    if (!entry || span.begin >= entry->file.text.size() || span.end <= span.begin) return {};
    return std::string_view(entry->file.text).substr(span.begin, span.end - span.begin);
}

uint32_t SourceSet::line_of(uint32_t file, uint32_t byte) const
{
    const Entry* entry = find(file);
    if (!entry) return 1;
    const auto after = std::upper_bound(entry->line_starts.begin(), entry->line_starts.end(), byte);
    return static_cast<uint32_t>(after - entry->line_starts.begin());
}

Position SourceSet::position(uint32_t file, uint32_t byte) const
{
    const Entry* entry = find(file);
    if (!entry) return {};
    const std::string_view text = entry->file.text;
    Position position{line_of(file, byte), 1};
    uint32_t at = entry->line_starts[position.line - 1];
    if (at == 0 && text.starts_with(byte_order_mark)) at = static_cast<uint32_t>(byte_order_mark.size());
    for (; at < std::min<size_t>(byte, text.size()); ++position.column) at += decode_utf8(text, at).length;
    return position;
}

std::string_view SourceSet::line(uint32_t file, uint32_t line_number) const
{
    const Entry* entry = find(file);
    if (!entry || line_number == 0 || line_number > entry->line_starts.size()) return {};
    const uint32_t begin = entry->line_starts[line_number - 1];
    const size_t end =
        line_number < entry->line_starts.size() ? entry->line_starts[line_number] : entry->file.text.size();
    std::string_view line = std::string_view(entry->file.text).substr(begin, end - begin);
    while (!line.empty() && (line.back() == '\n' || line.back() == '\r')) line.remove_suffix(1);
    if (begin == 0 && line.starts_with(byte_order_mark)) line.remove_prefix(byte_order_mark.size());
    return line;
}

} // namespace haptel::lang
