#include "tools/report/eval_table.h"

#include "tools/arguments/quantity.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fmt/format.h>
#include <fstream>
#include <string_view>

namespace haptel::tools {

namespace {

std::string_view trimmed(std::string_view text)
{
    const size_t first = text.find_first_not_of(" \t\r");
    return first == text.npos ? std::string_view{} : text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::vector<std::string_view> cells_of(std::string_view line)
{
    std::vector<std::string_view> cells;
    for (;;) {
        const size_t comma = line.find(',');
        cells.push_back(trimmed(line.substr(0, comma)));
        if (comma == line.npos) return cells;
        line.remove_prefix(comma + 1);
    }
}

// A foreign text as a message can show it, whatever it is.
std::string shown(std::string_view text)
{
    constexpr size_t most = 60;
    std::string result(text.substr(0, most));
    for (char& letter : result)
        if (static_cast<unsigned char>(letter) < ' ' || letter == 127) letter = '?';
    while (text.size() > most && !result.empty() && (result.back() & 0x80)) result.pop_back(); // no half of a letter
    return text.size() > most ? result + "..." : result;
}

// A stream without lines may have no end either.
constexpr size_t longest_line = 1 << 20;

} // namespace

PointTable read_points(const std::string& file)
{
    PointTable table;
    std::ifstream in(file);
    if (!in) {
        table.error = fmt::format("cannot read {}: {}", file, std::strerror(errno));
        return table;
    }
    constexpr std::string_view byte_order_mark = "\xef\xbb\xbf"; // spreadsheets begin with it
    std::array<size_t, 3> columns = {0, 1, 2};
    size_t width = 0; // cells of the first line, and of every other
    std::string line;
    errno = 0;
    std::vector<char> buffer(longest_line);
    for (size_t number = 1; in.getline(buffer.data(), static_cast<std::streamsize>(buffer.size())); ++number) {
        line = buffer.data();
        if (number == 1 && line.starts_with(byte_order_mark)) line.erase(0, byte_order_mark.size());
        const std::string_view text = trimmed(line);
        if (text.empty()) continue;
        const std::vector<std::string_view> cells = cells_of(text);
        if (table.header.empty()) {
            width = cells.size();
            const bool is_header = !parse_number(cells[0]);
            table.header = is_header ? std::string(text) : "x,y,z";
            for (size_t axis = 0; is_header && axis < 3; ++axis) {
                const auto found = std::find(cells.begin(), cells.end(), std::string_view("xyz").substr(axis, 1));
                if (found == cells.end()) {
                    table.error =
                        fmt::format("{}:{}: expected the columns x,y,z, found '{}'", file, number, shown(text));
                    return table;
                }
                columns[axis] = static_cast<size_t>(found - cells.begin());
            }
            if (is_header) continue;
        }
        PointTable::Row row{std::string(text), {}};
        for (int axis = 0; axis < 3; ++axis) {
            const size_t column = columns[static_cast<size_t>(axis)];
            const Parsed<double> value = parse_number(column < cells.size() ? cells[column] : std::string_view{});
            if (!value) {
                table.error = fmt::format("{}:{}: column {}: {}", file, number, column + 1, value.error);
                return table;
            }
            row.p_m[axis] = value.value;
        }
        if (cells.size() != width) {
            table.error = fmt::format("{}:{}: expected {} columns as in the first line, found {}", file, number, width,
                                      cells.size());
            return table;
        }
        table.rows.push_back(std::move(row));
    }
    if (static_cast<size_t>(in.gcount()) + 1 == longest_line)
        table.error = fmt::format("{}: a line in it is longer than any of a table of points", file);
    else if (in.bad())
        table.error = fmt::format("cannot read {}: {}", file, std::strerror(errno != 0 ? errno : EIO));
    else if (table.header.empty())
        table.error = fmt::format("{}: there are no points in it", file);
    return table;
}

} // namespace haptel::tools
