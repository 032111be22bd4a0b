#include "lang/text/diagnostic.h"

#include <algorithm>

namespace haptel::lang {

namespace {

constexpr size_t cell_limit = 100; // columns of a source line that are shown
constexpr size_t tab_width = 4;

struct Palette {
    const char *of_severity[3], *bold, *dim, *off;
};
constexpr Palette plain{{"", "", ""}, "", "", ""};
constexpr Palette ansi{{"\033[1;31m", "\033[1;35m", "\033[1;36m"}, "\033[1m", "\033[2m", "\033[0m"};

// Columns that a terminal gives to a code point: 0 for combining marks, 2 for East Asian wide ones and pictographs.
size_t columns_of(char32_t c)
{
    const auto within = [c](char32_t first, char32_t last) { return c >= first && c <= last; };
    if (c == '\t') return tab_width;
    if (within(0x300, 0x36F) || within(0x200B, 0x200D) || within(0xFE00, 0xFE0F)) return 0;
    const bool wide = within(0x1100, 0x115F) || within(0x2E80, 0xA4CF) || within(0xAC00, 0xD7A3) ||
                      within(0xF900, 0xFAFF) || within(0xFE30, 0xFE6F) || within(0xFF00, 0xFF60) ||
                      within(0xFFE0, 0xFFE6) || within(0x1F300, 0x1FAFF) || within(0x20000, 0x3FFFD);
    return wide ? 2 : 1;
}

// The line and its underline, cut to a window around [begin, end) where it is long.
struct Picture {
    std::string line, underline;
};

Picture draw(std::string_view line, uint32_t begin, uint32_t end)
{
    // A line of megabytes is cut before it is taken apart.
    const uint32_t near = static_cast<uint32_t>(4 * cell_limit);
    const uint32_t skipped = begin > near ? begin - near : 0;
    const bool tail_cut = line.size() - skipped > 3 * near;
    line = line.substr(skipped, 3 * near);
    std::vector<uint32_t> cells; // where its characters begin
    for (uint32_t at = 0; at < line.size(); at += decode_utf8(line, at).length) cells.push_back(at);

    const auto position = [&](uint32_t byte) {
        return static_cast<size_t>(std::ranges::lower_bound(cells, byte - skipped) - cells.begin());
    };
    const size_t first_marked = position(begin), end_marked = std::max(position(end), first_marked + 1);
    size_t first = 0, last = cells.size();
    if (cells.size() > cell_limit) {
        const size_t before = cell_limit / 4;
        first = first_marked > before ? std::min(first_marked - before, cells.size() - cell_limit) : 0;
        last = first + cell_limit;
    }
    Picture picture;
    if (first > 0 || skipped > 0) {
        picture.line = "...";
        picture.underline = "   ";
    }
    for (size_t i = first; i < std::max(last, first_marked + 1); ++i) {
        size_t columns = 1; // of a place at the end of the line
        if (i < cells.size()) {
            const CodePoint point = decode_utf8(line, cells[i]);
            columns = columns_of(point.value);
            picture.line +=
                point.value == '\t' ? std::string(tab_width, ' ') : printable(line.substr(cells[i], point.length));
        }
        if (i < end_marked) picture.underline += std::string(columns, i < first_marked ? ' ' : '~');
        if (i == first_marked && columns > 0) picture.underline[picture.underline.size() - columns] = '^';
    }
    if (last < cells.size() || tail_cut) picture.line += "...";
    return picture;
}

// Without its related places and its hint.
void append_place(std::string& out, const Diagnostic& said, const SourceSet& sources, const Palette& palette)
{
    const Span span = said.span;
    const char* const color = palette.of_severity[static_cast<size_t>(said.severity)];
    const std::string label = color + std::string(name_of(said.severity)) + ": " + palette.off;
    if (!sources.has(span.file)) { // about no file at all
        out += label + printable(said.message) + "\n";
        return;
    }
    const SourceFile& file = sources.file(span.file);
    const Position start = sources.position(span.file, span.begin);
    const std::string number = std::to_string(start.line);
    out += palette.bold + printable(file.name) + ":" + number + ":" + std::to_string(start.column) + ": " +
           palette.off + label + printable(said.message);
    if (!said.code.empty()) out += std::string(palette.dim) + " [" + said.code + "]" + palette.off;
    out += "\n";

    if (file.text.empty()) return; // empty, or not to be read: there is no line to show
    const std::string_view line = sources.line(span.file, start.line);
    const auto line_begin = static_cast<uint32_t>(line.data() - file.text.data());
    const auto in_line = [&](uint32_t byte) {
        return std::min(std::max(byte, line_begin) - line_begin, static_cast<uint32_t>(line.size()));
    };
    const Picture picture = draw(line, in_line(span.begin), in_line(span.end));
    const std::string margin(std::max<size_t>(number.size(), 4), ' ');
    out += margin.substr(number.size()) + number + " | " + picture.line + "\n";
    out += margin + " | " + color + picture.underline + palette.off + "\n";
}

} // namespace

std::string render(const std::vector<Diagnostic>& diagnostics, const SourceSet& sources, bool color)
{
    const Palette& palette = color ? ansi : plain;
    std::string out;
    for (const Diagnostic& diagnostic : diagnostics) {
        append_place(out, diagnostic, sources, palette);
        for (const Related& related : diagnostic.related)
            append_place(out, {Severity::note, {}, related.span, related.message, {}, {}, {}}, sources, palette);
        if (!diagnostic.hint.empty())
            out += std::string("     = ") + palette.bold + "hint: " + palette.off + printable(diagnostic.hint) + "\n";
    }
    return out;
}

} // namespace haptel::lang
