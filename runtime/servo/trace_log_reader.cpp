#include "input/regular_file.h"
#include "runtime/servo/tick_columns.h"
#include "runtime/servo/trace_csv.h"
#include "runtime/servo/trace_log_layout.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <optional>
#include <string_view>
#include <utility>
#include <variant>

namespace haptel::runtime {

namespace {

struct LogColumn {
    std::optional<std::size_t> known; // of tick_columns
    std::size_t bytes;
};

struct LogHeader {
    std::vector<LogColumn> columns;
    std::size_t tick_bytes = 0;
    uint64_t sum = 0;
    std::array<bool, 3> has_tail{}; // of each axis
};

class LogReader {
public:
    explicit LogReader(const std::filesystem::path& path) : file_(path, trace_bytes_max), name_(path.string()) {}

    // Whether it begins as one, if only by its first bytes.
    bool is_one() { return is_more() && log_magic.starts_with(ahead_.substr(0, log_magic.size())); }

    TraceResult read()
    {
        result_.origin.emplace();
        if (read_header()) read_ticks();
        if (file_.refused().refusal != input::Refusal::none && result_.error.empty())
            fail("the recording " + file_.refused().why);
        return std::move(result_);
    }

private:
    bool fail(const std::string& why)
    {
        result_.error = name_ + ": " + why;
        return false;
    }
    bool header_is_damaged()
    {
        return fail("the header of the recording is damaged (bytes 0 to " + std::to_string(at_ - 1) +
                    "): nothing of it can be trusted");
    }

    bool is_more()
    {
        if (ahead_.empty()) ahead_ = {block_.data(), file_.read(block_.data(), block_.size())};
        return !ahead_.empty();
    }

    // As many bytes as there are, up to `count`.
    std::size_t fill(char* to, std::size_t count)
    {
        std::size_t filled = 0;
        while (filled < count && is_more()) {
            const std::size_t taken = ahead_.copy(to + filled, count - filled);
            ahead_.remove_prefix(taken);
            filled += taken;
        }
        at_ += filled;
        return filled;
    }
    bool fill_header(std::string& bytes, std::size_t count)
    {
        const std::size_t begin = bytes.size();
        bytes.resize(begin + count);
        if (fill(bytes.data() + begin, count) == count) return true;
        return fail("cut after " + std::to_string(at_) + " bytes, within its header: no tick is in it");
    }

    bool read_header()
    {
        std::string bytes;
        if (!fill_header(bytes, log_fixed_bytes)) return false;
        std::array<uint32_t, 4> numbers;
        std::memcpy(numbers.data(), bytes.data() + log_magic.size(), sizeof numbers);
        const auto [order, version, text_bytes, tick_bytes] = numbers;
        if (order == __builtin_bswap32(log_byte_order))
            return fail("recorded on a machine with the other byte order, which this one does not read. There, `haptel "
                        "replay FILE --csv trace.csv` writes it as text");
        if (order != log_byte_order) return header_is_damaged();
        if (version != log_version)
            return fail("a recording of version " + std::to_string(version) + ", and this Haptel reads version " +
                        std::to_string(log_version) +
                        ". With the Haptel that made it, `haptel replay FILE --csv trace.csv` writes it as text");
        if (text_bytes > log_text_max) return header_is_damaged();
        if (!fill_header(bytes, text_bytes)) return false;
        header_.sum = log_sum(bytes, 0);
        const std::string text = bytes.substr(log_fixed_bytes);
        bytes.clear();
        if (!fill_header(bytes, sizeof header_.sum)) return false;
        if (std::memcmp(bytes.data(), &header_.sum, sizeof header_.sum) != 0) return header_is_damaged();
        header_.tick_bytes = tick_bytes;
        return read_text(text);
    }

    bool read_text(std::string_view text)
    {
        std::size_t bytes = sizeof(uint64_t);
        std::array<bool, tick_column_count> present{};
        while (!text.empty()) {
            std::string_view line = text.substr(0, text.find('\n'));
            text.remove_prefix(std::min(line.size() + 1, text.size()));
            constexpr std::string_view column_word = "column ";
            if (!line.starts_with(column_word)) {
                read_line(line, *result_.origin);
                continue;
            }
            line.remove_prefix(column_word.size());
            if (!read_column(line, present)) return false;
            bytes += header_.columns.back().bytes;
        }
        for (const std::string_view name : log_columns_required)
            if (!present[*tick_column(name)])
                return fail("the recording has no column `" + std::string(name) + "`: it cannot be replayed");
        if (bytes != header_.tick_bytes)
            return fail("the columns of the recording take " + std::to_string(bytes) + " bytes a tick, but it says " +
                        std::to_string(header_.tick_bytes));
        header_.has_tail = {present[*tick_column("tail_x_m")], present[*tick_column("tail_y_m")],
                            present[*tick_column("tail_z_m")]};
        return true;
    }

    bool read_column(std::string_view line, std::array<bool, tick_column_count>& present)
    {
        const std::string_view type = line.substr(0, line.find(' '));
        const std::string_view name = line.substr(std::min(type.size() + 1, line.size()));
        if (type != "u64" && type != "f64" && type != "u32")
            return fail("column `" + std::string(name) + "` is of type `" + std::string(type) +
                        "`; this Haptel knows u64, u32 and f64");
        LogColumn column{tick_column(name), type == "u32" ? sizeof(uint32_t) : sizeof(uint64_t)};
        if (column.known) {
            TickRecord record;
            const std::string_view wanted = log_type_of(tick_fields(record)[*column.known]);
            if (type != wanted)
                return fail("column `" + std::string(name) + "` is of type `" + std::string(type) + "`, expected `" +
                            std::string(wanted) + "`");
            present[*column.known] = true;
        }
        header_.columns.push_back(column);
        return true;
    }

    void read_ticks()
    {
        std::string bytes(header_.tick_bytes, '\0');
        uint64_t sum = header_.sum;
        while (const std::size_t got = fill(bytes.data(), bytes.size())) {
            const std::size_t count = result_.records.size();
            if (got < bytes.size()) {
                result_.note = name_ + ": cut after " + std::to_string(at_) + " bytes, within a tick: the " +
                               std::to_string(count) + " ticks before it are there";
                return;
            }
            const std::string_view values(bytes.data(), bytes.size() - sizeof sum);
            sum = log_sum(values, sum);
            if (std::memcmp(values.data() + values.size(), &sum, sizeof sum) != 0) {
                fail("the tick after the first " + std::to_string(count) + " is damaged (bytes " +
                     std::to_string(at_ - bytes.size()) + " to " + std::to_string(at_ - 1) + ")");
                return;
            }
            add_tick(values);
        }
    }

    void add_tick(std::string_view values)
    {
        TickRecord& record = result_.records.emplace_back();
        const auto fields = tick_fields(record);
        for (const LogColumn& column : header_.columns) {
            if (column.known)
                std::visit([&](auto* value) { std::memcpy(value, values.data(), sizeof *value); },
                           fields[*column.known]);
            values.remove_prefix(column.bytes);
        }
        for (int axis = 0; axis < 3; ++axis)
            if (!header_.has_tail[axis]) record.tail_m[axis] = record.tip_m[axis];
    }

    input::RegularFile file_;
    std::string name_;
    std::string block_ = std::string(1 << 16, '\0');
    std::string_view ahead_; // of the block: read and not taken yet
    std::size_t at_ = 0;     // bytes taken
    LogHeader header_;
    TraceResult result_;
};

} // namespace

TraceResult read_trace(const std::filesystem::path& file)
{
    LogReader log(file);
    return log.is_one() ? log.read() : read_trace_csv(file);
}

} // namespace haptel::runtime
