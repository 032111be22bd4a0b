#include "runtime/servo/trace_log.h"

#include "input/checksum.h"
#include "runtime/servo/tick_columns.h"
#include "runtime/servo/trace_log_layout.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <sys/stat.h>
#include <type_traits>
#include <unistd.h>
#include <variant>

namespace haptel::runtime {

namespace {

using Columns = std::vector<std::size_t>; // of tick_columns, in the order of the file

constexpr auto hand_over_interval = std::chrono::milliseconds(10);
constexpr std::size_t waiting_max = 1 << 18; // bytes

Columns all_columns()
{
    Columns columns(tick_column_count);
    for (std::size_t i = 0; i < columns.size(); ++i) columns[i] = i;
    return columns;
}

template <typename Value>
void append_value(std::string& bytes, Value value)
{
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

// Of two fields of one column.
bool same_bits(const TickField& a, const TickField& b)
{
    return std::visit([&](auto* value) { return std::memcmp(value, std::get<decltype(value)>(b), sizeof *value) == 0; },
                      a);
}

// Returns its checksum, which the first tick goes on from.
uint64_t append_header(std::string& bytes, const TraceOrigin& origin, const Columns& columns)
{
    TickRecord record;
    const auto fields = tick_fields(record);
    std::string text = to_text(origin);
    uint32_t tick_bytes = sizeof(uint64_t);
    for (const std::size_t column : columns) {
        text.append("column ")
            .append(log_type_of(fields[column]))
            .append(" ")
            .append(tick_columns[column])
            .append("\n");
        tick_bytes += static_cast<uint32_t>(log_size_of(fields[column]));
    }
    const std::size_t begin = bytes.size();
    bytes.append(log_magic);
    append_value(bytes, log_byte_order);
    append_value(bytes, log_version);
    append_value(bytes, static_cast<uint32_t>(text.size()));
    append_value(bytes, tick_bytes);
    bytes.append(text);
    const uint64_t sum = log_sum(std::string_view(bytes).substr(begin), 0);
    append_value(bytes, sum);
    return sum;
}

uint64_t append_tick(std::string& bytes, const TickRecord& record, const Columns& columns, uint64_t sum_before)
{
    TickRecord copy = record;
    const auto fields = tick_fields(copy);
    const std::size_t begin = bytes.size();
    for (const std::size_t column : columns)
        std::visit([&](const auto* value) { append_value(bytes, *value); }, fields[column]);
    const uint64_t sum = log_sum(std::string_view(bytes).substr(begin), sum_before);
    append_value(bytes, sum);
    return sum;
}

// Whether a recording may take its place.
bool is_empty_or_log(int file)
{
    std::array<char, log_magic.size()> begin{};
    const ssize_t count = pread(file, begin.data(), begin.size(), 0);
    return count == 0 || (count > 0 && log_magic.starts_with({begin.data(), static_cast<std::size_t>(count)}));
}

} // namespace

TraceLog::TraceLog(const std::filesystem::path& file, const TraceOrigin& origin) : name_(file.string())
{
    if (const char* const why = open_empty()) {
        fail(why);
        return;
    }
    sum_ = append_header(waiting_, origin, all_columns());
    hand_over();
}

// Returns why not.
const char* TraceLog::open_empty()
{
    // Not waiting for the other end of a pipe.
    const int descriptor = open(name_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NONBLOCK, 0666);
    if (descriptor >= 0) file_.reset(fdopen(descriptor, "r+b"));
    struct stat found = {};
    if (!file_ || fstat(descriptor, &found) != 0) return std::strerror(errno);
    if (!S_ISREG(found.st_mode)) return "it is not a regular file";
    if (!is_empty_or_log(descriptor))
        return "it is there already and is not a recording; remove it or choose another name";
    if (ftruncate(descriptor, 0) != 0) return std::strerror(errno);
    std::setvbuf(file_.get(), nullptr, _IONBF, 0); // what waits does so here
    return nullptr;
}

TraceLog::~TraceLog()
{
    hand_over();
}

void TraceLog::fail(const char* why)
{
    error_ = "cannot write the recording '" + name_ + "': " + why;
    waiting_.clear();
}

void TraceLog::add(const TickRecord& record)
{
    if (!error_.empty()) return;
    static const Columns all = all_columns();
    sum_ = append_tick(waiting_, record, all, sum_);
    if (waiting_.size() >= waiting_max) hand_over();
}

void TraceLog::keep_up()
{
    if (std::chrono::steady_clock::now() - handed_over_ >= hand_over_interval) hand_over();
}

void TraceLog::hand_over()
{
    handed_over_ = std::chrono::steady_clock::now();
    if (waiting_.empty() || !error_.empty()) return;
    if (std::fwrite(waiting_.data(), 1, waiting_.size(), file_.get()) != waiting_.size())
        return fail(std::strerror(errno));
    waiting_.clear();
}

std::string trace_log_bytes(const TraceOrigin& origin, std::span<const TickRecord> records)
{
    constexpr std::array<std::string_view, 4> of_the_machine = {"compute_ns", "woken_ns", "wake_late_ns", "binding"};
    std::array<bool, tick_column_count> tells{};
    for (const std::string_view name : log_columns_required) tells[*tick_column(name)] = true;
    for (const TickRecord& given : records) {
        TickRecord record = given, plain;
        plain.tail_m = record.tip_m;
        const auto values = tick_fields(record), defaults = tick_fields(plain);
        for (std::size_t i = 0; i < tick_column_count; ++i) tells[i] = tells[i] || !same_bits(values[i], defaults[i]);
    }
    for (const std::string_view name : of_the_machine) tells[*tick_column(name)] = false;
    Columns columns;
    for (std::size_t i = 0; i < tick_column_count; ++i)
        if (tells[i]) columns.push_back(i);
    std::string bytes;
    uint64_t sum = append_header(bytes, origin, columns);
    for (const TickRecord& record : records) sum = append_tick(bytes, record, columns, sum);
    return bytes;
}

} // namespace haptel::runtime
