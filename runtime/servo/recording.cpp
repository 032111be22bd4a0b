#include "runtime/servo/recording.h"

#include <array>
#include <charconv>
#include <cstddef>
#include <fstream>
#include <ostream>
#include <span>
#include <variant>

namespace haptel::runtime {

namespace {

constexpr std::size_t column_count = 24;
constexpr std::size_t columns_required = 16; // the rest came later: traces without it are read

using Field = std::variant<uint64_t*, uint32_t*, double*>;

// Where the columns of trace_columns live in a record: the one list that reading and writing share.
std::array<Field, column_count> fields(TickRecord& r)
{
    return {&r.tick,     &r.time_s,       &r.tip_m.x,      &r.tip_m.y,      &r.tip_m.z,      &r.tail_m.x,
            &r.tail_m.y, &r.tail_m.z,     &r.force_n.x,    &r.force_n.y,    &r.force_n.z,    &r.contact,
            &r.depth_m,  &r.height_m,     &r.compute_ns,   &r.binding,      &r.interrupted,  &r.device_force_max_n,
            &r.waiting,  &r.torque_n_m.x, &r.torque_n_m.y, &r.torque_n_m.z, &r.grip_force_n, &r.degradation};
}

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

bool parse(std::string_view text, const Field& field)
{
    return std::visit(
        [text](auto* value) {
            const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), *value);
            return error == std::errc() && end == text.data() + text.size();
        },
        field);
}

} // namespace

void write_trace_header(std::ostream& out)
{
    out << trace_columns << '\n';
}

void write_trace_row(std::ostream& out, const TickRecord& record)
{
    TickRecord copy = record;
    std::array<char, column_count * 32> row;
    char* end = row.data();
    for (const Field& field : fields(copy)) {
        if (end != row.data()) *end++ = ',';
        end = std::visit([&](auto* v) { return std::to_chars(end, row.data() + row.size(), *v).ptr; }, field);
    }
    *end++ = '\n';
    out.write(row.data(), end - row.data());
}

TraceResult read_trace(const std::filesystem::path& file)
{
    TraceResult result;
    std::size_t line_number = 1;
    const auto fail = [&](const std::string& why) {
        result.error = file.string() + ":" + std::to_string(line_number) + ": " + why;
        return result;
    };

    std::ifstream in(file);
    std::string line;
    if (!in || !std::getline(in, line))
        return fail(
            "expected a trace (a CSV file as `haptel explore --out` writes it), but the file is missing or empty");
    const auto without_return = [&] {
        return std::string_view(line).substr(0, line.size() - (line.ends_with('\r') ? 1 : 0));
    };

    const std::vector<std::string_view> wanted = split(trace_columns);
    std::vector<std::size_t> column_of_cell; // column_count: ignored
    std::array<bool, column_count> present = {};
    for (const std::string_view name : split(without_return())) {
        std::size_t column = 0;
        while (column < wanted.size() && wanted[column] != name) ++column;
        column_of_cell.push_back(column);
        if (column < column_count) present[column] = true;
    }
    for (std::size_t column = 0; column < columns_required; ++column)
        if (!present[column]) return fail("the trace has no column `" + std::string(wanted[column]) + "`");

    while (std::getline(in, line)) {
        ++line_number;
        if (without_return().empty()) continue;
        const std::vector<std::string_view> cells = split(without_return());
        if (cells.size() != column_of_cell.size())
            return fail("expected " + std::to_string(column_of_cell.size()) + " values, found " +
                        std::to_string(cells.size()));
        TickRecord record;
        const auto into = fields(record);
        for (std::size_t i = 0; i < cells.size(); ++i)
            if (column_of_cell[i] < column_count && !parse(cells[i], into[column_of_cell[i]]))
                return fail("expected a number in column `" + std::string(wanted[column_of_cell[i]]) + "`, found `" +
                            std::string(cells[i]) + "`");
        result.records.push_back(record);
    }
    return result;
}

} // namespace haptel::runtime
