#include "tools/arguments/eval_table.h"

#include "input/regular_file.h"
#include "tools/arguments/quantity.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fmt/format.h>
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

// A length with a mistake in its unit is one, too.
bool begins_like_number(std::string_view cell)
{
    const size_t first = cell.find_first_not_of("+-.");
    return first != cell.npos && cell[first] >= '0' && cell[first] <= '9';
}

// A stream without lines may have no end either.
constexpr size_t longest_line = 1 << 20;

} // namespace

PointTable::PointTable(std::string file) : file_(std::move(file))
{
    const input::Refused look = input::look_at_regular_file(file_, UINTMAX_MAX);
    if (look.refusal == input::Refusal::none) in_.open(file_);
    if (in_.is_open())
        buffer_.resize(longest_line);
    else
        error_ = fmt::format("cannot read {}: it {}", file_, look.why.empty() ? std::strerror(errno) : look.why);
}

std::vector<PointTable::Row> PointTable::next(size_t count)
{
    std::vector<Row> rows;
    errno = 0;
    for (Row row; error_.empty() && rows.size() < count;) {
        if (!in_.getline(buffer_.data(), static_cast<std::streamsize>(buffer_.size()))) {
            report_end();
            break;
        }
        ++number_;
        if (read_line(row)) rows.push_back(std::move(row));
    }
    if (!error_.empty()) rows.clear();
    return rows;
}

bool PointTable::read_line(Row& row)
{
    constexpr std::string_view byte_order_mark = "\xef\xbb\xbf"; // spreadsheets begin with it
    std::string_view text = buffer_.data();
    if (number_ == 1 && text.starts_with(byte_order_mark)) text.remove_prefix(byte_order_mark.size());
    text = trimmed(text);
    if (text.empty()) return false;
    const std::vector<std::string_view> cells = cells_of(text);
    if (head_.empty()) {
        width_ = cells.size();
        const bool is_header = !begins_like_number(cells[0]);
        head_ = is_header ? std::string(text) : "x,y,z";
        for (size_t axis = 0; is_header && axis < 3; ++axis) {
            const auto found = std::find(cells.begin(), cells.end(), std::string_view("xyz").substr(axis, 1));
            if (found == cells.end()) {
                error_ = fmt::format("{}:{}: expected the columns x,y,z, found '{}'", file_, number_, shown(text));
                return false;
            }
            columns_[axis] = static_cast<size_t>(found - cells.begin());
        }
        if (is_header) return false;
    }
    row.text = text;
    for (int axis = 0; axis < 3; ++axis) {
        const size_t column = columns_[static_cast<size_t>(axis)];
        const Parsed<double> value = parse_length(column < cells.size() ? cells[column] : std::string_view{});
        if (!value) {
            error_ = fmt::format("{}:{}: column {}: {}", file_, number_, column + 1, value.error);
            return false;
        }
        row.p_m[axis] = value.value;
    }
    if (cells.size() != width_)
        error_ = fmt::format("{}:{}: expected {} columns as in the first line, found {}", file_, number_, width_,
                             cells.size());
    return error_.empty();
}

void PointTable::report_end()
{
    if (static_cast<size_t>(in_.gcount()) + 1 == longest_line)
        error_ = fmt::format("{}: a line in it is longer than any of a table of points", file_);
    else if (in_.bad())
        error_ = fmt::format("cannot read {}: {}", file_, std::strerror(errno != 0 ? errno : EIO));
    else if (head_.empty())
        error_ = fmt::format("{}: there are no points in it", file_);
}

} // namespace haptel::tools
