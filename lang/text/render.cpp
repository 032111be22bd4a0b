#include "lang/text/diagnostic.h"

#include <algorithm>

namespace haptel::lang {

namespace {

constexpr size_t cell_limit = 100; // columns of a source line that are shown
constexpr size_t tab_width = 4;

struct Palette {
    std::string_view error, warning, note, bold, dim, off;
};
constexpr Palette plain{};
constexpr Palette ansi{"\033[1;31m", "\033[1;35m", "\033[1;36m", "\033[1m", "\033[2m", "\033[0m"};

// Columns that a terminal gives to a code point: 0 for combining marks, 2 for East Asian wide ones and pictographs.
size_t columns_of(char32_t c)
{
    const auto within = [c](char32_t first, char32_t last) { return c >= first && c <= last; };
    if (within(0x300, 0x36F) || within(0x200B, 0x200D) || within(0xFE00, 0xFE0F)) return 0;
    const bool wide = within(0x1100, 0x115F) || within(0x2E80, 0xA4CF) || within(0xAC00, 0xD7A3) ||
                      within(0xF900, 0xFAFF) || within(0xFE30, 0xFE6F) || within(0xFF00, 0xFF60) ||
                      within(0xFFE0, 0xFFE6) || within(0x1F300, 0x1FAFF) || within(0x20000, 0x3FFFD);
    return wide ? 2 : 1;
}

// One code point of the source line as it is shown.
struct Cell {
    uint32_t byte; // in the line
    std::string text;
    size_t columns;
};

std::vector<Cell> cells_of(std::string_view line)
{
    std::vector<Cell> cells;
    for (uint32_t i = 0; i < line.size();) {
        const CodePoint point = decode_utf8(line, i);
        if (point.value == '\t') {
            cells.push_back({i, std::string(tab_width, ' '), tab_width});
        } else {
            const bool shown = point.value != invalid_code_point;
            cells.push_back({i, printable(line.substr(i, point.length)), shown ? columns_of(point.value) : 1});
        }
        i += point.length;
    }
    return cells;
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
    std::vector<Cell> cells = cells_of(line.substr(skipped, 3 * near));

    const auto position = [&](uint32_t byte) {
        const auto at =
            std::find_if(cells.begin(), cells.end(), [&](const Cell& cell) { return cell.byte + skipped >= byte; });
        return static_cast<size_t>(at - cells.begin());
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
        const bool past_end = i >= cells.size(); // a place at the end of the line
        const size_t columns = past_end ? 1 : cells[i].columns;
        if (!past_end) picture.line += cells[i].text;
        if (i < end_marked) picture.underline += std::string(columns, i < first_marked ? ' ' : '~');
        if (i == first_marked && columns > 0) picture.underline[picture.underline.size() - columns] = '^';
    }
    if (last < cells.size() || tail_cut) picture.line += "...";
    return picture;
}

void append_place(std::string& out, Span span, std::string_view label, std::string_view color, std::string_view message,
                  std::string_view code, const SourceSet& sources, const Palette& palette)
{
    if (!sources.has(span.file)) { // about no file at all
        out += std::string(color) + std::string(label) + ": " + std::string(palette.off) + printable(message) + "\n";
        return;
    }
    const Position start = sources.position(span.file, span.begin);
    out += palette.bold;
    out += printable(sources.file(span.file).name) + ":" + std::to_string(start.line) + ":" +
           std::to_string(start.column) + ": ";
    out += palette.off;
    out += color;
    out += label;
    out += ": ";
    out += palette.off;
    out += printable(message);
    if (!code.empty()) out += std::string(palette.dim) + " [" + std::string(code) + "]" + std::string(palette.off);
    out += "\n";

    if (sources.file(span.file).text.empty()) return; // empty, or not to be read: there is no line to show
    const std::string_view line = sources.line(span.file, start.line);
    const auto line_begin = static_cast<uint32_t>(line.data() - sources.file(span.file).text.data());
    const auto line_size = static_cast<uint32_t>(line.size());
    const uint32_t begin = std::min(std::max(span.begin, line_begin) - line_begin, line_size);
    const uint32_t end = std::min(std::max(span.end, line_begin) - line_begin, line_size);
    const Picture picture = draw(line, begin, end);
    const std::string number = std::to_string(start.line);
    const std::string margin(std::max<size_t>(number.size(), 4), ' ');
    out += margin.substr(number.size()) + number + " | " + picture.line + "\n";
    out += margin + " | " + std::string(color) + picture.underline + std::string(palette.off) + "\n";
}

} // namespace

std::string render(const Diagnostic& diagnostic, const SourceSet& sources, bool color)
{
    const Palette& palette = color ? ansi : plain;
    std::string_view color_of_label;
    switch (diagnostic.severity) {
    case Severity::error: color_of_label = palette.error; break;
    case Severity::warning: color_of_label = palette.warning; break;
    case Severity::note: color_of_label = palette.note; break;
    }
    std::string out;
    append_place(out, diagnostic.span, name_of(diagnostic.severity), color_of_label, diagnostic.message,
                 diagnostic.code, sources, palette);
    for (const Related& related : diagnostic.related)
        append_place(out, related.span, "note", palette.note, related.message, {}, sources, palette);
    if (!diagnostic.hint.empty()) {
        out += "     = " + std::string(palette.bold) + "hint: " + std::string(palette.off) +
               printable(diagnostic.hint) + "\n";
    }
    return out;
}

std::string render(const std::vector<Diagnostic>& diagnostics, const SourceSet& sources, bool color)
{
    std::string out;
    for (const Diagnostic& diagnostic : diagnostics) out += render(diagnostic, sources, color);
    return out;
}

} // namespace haptel::lang
