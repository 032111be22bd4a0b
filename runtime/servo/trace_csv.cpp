#include "runtime/servo/trace_csv.h"

#include "input/regular_file.h"
#include "runtime/servo/tick_columns.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <optional>
#include <ostream>
#include <string_view>
#include <variant>

namespace haptel::runtime {

namespace {

constexpr std::size_t columns_required = 16; // the rest came later: traces without it are read

std::vector<std::string_view> split(std::string_view line)
{
    std::vector<std::string_view> cells;
    while (true) {
        const std::size_t comma = line.find(',');
        cells.push_back(line.substr(0, comma));
        if (comma == std::string_view::npos) return cells;
        line.remove_prefix(comma + 1);
    }
}

bool parse(std::string_view text, const TickField& field)
{
    return std::visit(
        [text](auto* value) {
            const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), *value);
            return error == std::errc() && end == text.data() + text.size();
        },
        field);
}

// A file's lines one by one, so that a trace may be longer than memory holds of text.
class Lines {
public:
    explicit Lines(const std::filesystem::path& file) : file_(file, trace_bytes_max), bytes_(2 * longest) {}

    static constexpr std::size_t longest = 1 << 14; // a trace's are some 300 bytes

    // Without its end. False: the file has, or too_long(), or refused() tells why not.
    bool next(std::string_view& line)
    {
        while (true) {
            const std::string_view left(bytes_.data() + begin_, end_ - begin_);
            const std::size_t size = left.find('\n');
            if (size != left.npos || (is_end_ && !left.empty() && !too_long())) {
                line = left.substr(0, size);
                begin_ += std::min(line.size() + 1, left.size());
                if (line.ends_with('\r')) line.remove_suffix(1);
                return true;
            }
            if (is_end_ || too_long()) return false;
            std::copy(left.begin(), left.end(), bytes_.begin());
            begin_ = 0, end_ = left.size();
            const std::size_t got = file_.read(bytes_.data() + end_, bytes_.size() - end_);
            is_end_ = got == 0;
            end_ += got;
        }
    }
    bool too_long() const { return end_ - begin_ > longest; }
    const input::Refused& refused() const { return file_.refused(); }

private:
    input::RegularFile file_;
    std::vector<char> bytes_;
    std::size_t begin_ = 0, end_ = 0;
    bool is_end_ = false;
};

} // namespace

void write_trace_header(std::ostream& out)
{
    for (std::size_t column = 0; column < tick_column_count; ++column)
        out << (column ? "," : "") << tick_columns[column];
    out << '\n';
}

void write_trace_row(std::ostream& out, const TickRecord& record)
{
    TickRecord copy = record;
    std::array<char, tick_column_count * 32> row;
    char* end = row.data();
    for (const TickField& field : tick_fields(copy)) {
        if (end != row.data()) *end++ = ',';
        end = std::visit([&](auto* v) { return std::to_chars(end, row.data() + row.size(), *v).ptr; }, field);
    }
    *end++ = '\n';
    out.write(row.data(), end - row.data());
}

TraceResult read_trace_csv(const std::filesystem::path& file)
{
    TraceResult result;
    std::size_t line_number = 1;
    const auto fail = [&](const std::string& why) {
        result.error = file.string() + ":" + std::to_string(line_number) + ": " + why;
        return result;
    };

    Lines lines(file);
    const auto why_no_line = [&]() -> std::string {
        if (lines.refused().refusal != input::Refusal::none) return "the trace " + lines.refused().why;
        if (lines.too_long())
            return "a line of more than " + std::to_string(Lines::longest) + " bytes is none of a trace";
        return line_number == 1 ? "the file is empty" : "";
    };
    std::string_view line;
    if (!lines.next(line))
        return fail("expected a trace (a CSV file as `haptel explore --out` writes it), but " + why_no_line());

    std::vector<std::optional<std::size_t>> column_of_cell; // none: ignored
    std::array<bool, tick_column_count> present = {};
    for (const std::string_view name : split(line)) {
        column_of_cell.push_back(tick_column(name));
        if (column_of_cell.back()) present[*column_of_cell.back()] = true;
    }
    for (std::size_t column = 0; column < columns_required; ++column)
        if (!present[column]) return fail("the trace has no column `" + std::string(tick_columns[column]) + "`");

    while (++line_number, lines.next(line)) {
        if (line.empty()) continue;
        const std::vector<std::string_view> cells = split(line);
        if (cells.size() != column_of_cell.size())
            return fail("expected " + std::to_string(column_of_cell.size()) + " values, found " +
                        std::to_string(cells.size()));
        TickRecord record;
        const auto into = tick_fields(record);
        for (std::size_t i = 0; i < cells.size(); ++i)
            if (const auto column = column_of_cell[i]; column && !parse(cells[i], into[*column]))
                return fail("expected a number in column `" + std::string(tick_columns[*column]) + "`, found `" +
                            std::string(cells[i]) + "`");
        result.records.push_back(record);
    }
    if (const std::string why = why_no_line(); !why.empty()) return fail(why);
    return result;
}

} // namespace haptel::runtime
