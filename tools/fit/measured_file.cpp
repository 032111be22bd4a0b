#include "tools/fit/measured_file.h"

#include "input/regular_file.h"
#include "jit/picture/image_file.h"
#include "jit/picture/picture.h"
#include "tools/arguments/quantity.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <numeric>
#include <optional>
#include <sstream>
#include <string_view>
#include <utility>

namespace haptel::tools {

namespace {

constexpr uintmax_t table_bytes_max = 1u << 30;
constexpr double uneven_max = 0.01; // of the distance of two samples: clocks are written with that many digits

constexpr std::pair<std::string_view, jit::Stroke::Of> measured_columns[] = {
    {"force_n", jit::Stroke::Of::force},
    {"fz_n", jit::Stroke::Of::force},
    {"acceleration_m_per_s2", jit::Stroke::Of::acceleration}};

std::vector<std::string_view> columns_in(std::string_view line)
{
    std::vector<std::string_view> cells;
    if (line.ends_with('\r')) line.remove_suffix(1);
    for (std::size_t comma; (comma = line.find(',')) != std::string_view::npos; line.remove_prefix(comma + 1))
        cells.push_back(line.substr(0, comma));
    cells.push_back(line);
    return cells;
}

std::optional<std::size_t> column_of(const std::vector<std::string_view>& header, std::string_view name)
{
    const auto found = std::ranges::find(header, name);
    if (found == header.end()) return std::nullopt;
    return static_cast<std::size_t>(found - header.begin());
}

std::string unreadable(const std::string& file, const input::Refused& refused)
{
    return fmt::format("cannot read '{}': it {}", file, refused.why);
}

MeasuredStroke no_stroke(std::string error, std::string hint = {})
{
    return {{}, std::move(error), std::move(hint)};
}

} // namespace

MeasuredHeights read_heights(const std::string& file, double pixel_m, double white_m)
{
    const input::FileBytes bytes = input::read_regular_file(file, jit::image_bytes_max);
    if (bytes.refused.refusal != input::Refusal::none) return {{}, unreadable(file, bytes.refused), {}};
    jit::Picture picture = jit::read_picture(bytes.bytes);
    if (!picture.error.empty()) return {{}, fmt::format("'{}': {}", file, picture.error), picture.hint};
    MeasuredHeights read;
    read.map.columns = static_cast<std::size_t>(picture.width);
    read.map.rows = static_cast<std::size_t>(picture.height);
    read.map.pixel_m = pixel_m;
    read.map.heights_m = std::move(picture.gray);
    for (double& height : read.map.heights_m) {
        height *= white_m;
        if (!std::isfinite(height)) return {{}, fmt::format("'{}' has a pixel that is no finite number", file), {}};
    }
    return read;
}

MeasuredStroke read_stroke(const std::string& file)
{
    const input::FileBytes bytes = input::read_regular_file(file, table_bytes_max);
    if (bytes.refused.refusal != input::Refusal::none) return no_stroke(unreadable(file, bytes.refused));
    std::string_view text = bytes.bytes;
    const auto next_line = [&] {
        const std::size_t end = std::min(text.find('\n'), text.size());
        const std::string_view line = text.substr(0, end);
        text.remove_prefix(std::min(end + 1, text.size()));
        return line;
    };
    const std::vector<std::string_view> header = columns_in(next_line());
    const std::optional<std::size_t> time = column_of(header, "time_s");
    MeasuredStroke read;
    std::optional<std::size_t> value;
    for (const auto& [name, of] : measured_columns)
        if (!value && (value = column_of(header, name))) read.stroke.of = of;
    if (!time || !value)
        return no_stroke(fmt::format(
            "{}:1: expected the columns time_s and force_n, fz_n or acceleration_m_per_s2, found {}", file,
            fmt::join(header.begin(),
                      header.begin() + static_cast<std::ptrdiff_t>(std::min<std::size_t>(header.size(), 8)), ", ")));
    std::vector<double> times_s, values;
    for (std::size_t number = 2; !text.empty(); ++number) {
        const std::vector<std::string_view> cells = columns_in(next_line());
        if (cells.size() == 1 && cells[0].empty()) continue;
        for (const std::size_t column : {*time, *value}) {
            const Parsed<double> parsed = parse_number(column < cells.size() ? cells[column] : "");
            if (!parsed) return no_stroke(fmt::format("{}:{}: {}: {}", file, number, header[column], parsed.error));
            (column == *time ? times_s : values).push_back(parsed.value);
        }
    }
    if (times_s.size() < 2) return no_stroke(fmt::format("'{}' has no two samples", file));
    std::vector<double> apart_s;
    for (std::size_t i = 1; i < times_s.size(); ++i) apart_s.push_back(times_s[i] - times_s[i - 1]);
    std::vector<double> sorted_s = apart_s;
    std::ranges::sort(sorted_s);
    if (!(sorted_s[sorted_s.size() / 2] > 0)) return no_stroke(fmt::format("the times in '{}' do not grow", file));
    const double gap_s = 1.5 * sorted_s[sorted_s.size() / 2]; // where samples are left out
    const auto within = std::ranges::subrange(sorted_s.begin(), std::ranges::lower_bound(sorted_s, gap_s));
    const double step_s = std::reduce(within.begin(), within.end()) / static_cast<double>(within.size());
    read.stroke.passes = {{values[0]}};
    for (std::size_t i = 1; i < times_s.size(); ++i) {
        const bool is_gap = apart_s[i - 1] >= gap_s;
        if (!is_gap && std::abs(apart_s[i - 1] - step_s) > std::max(uneven_max * step_s, 1e-9))
            return no_stroke(fmt::format("{}:{}: expected a sample each {:.6g} s, found one after {:.6g} s", file,
                                         i + 2, step_s, apart_s[i - 1]),
                             "a spectrum needs samples at even distances: resample the recording");
        if (is_gap) read.stroke.passes.emplace_back();
        read.stroke.passes.back().push_back(values[i]);
    }
    read.stroke.rate_hz = 1 / step_s;
    return read;
}

bool is_stroke_file(const std::string& file)
{
    return std::filesystem::path(file).extension() == ".csv";
}

} // namespace haptel::tools
