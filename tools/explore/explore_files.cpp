#include "tools/explore/explore_files.h"

#include "runtime/servo/trace_csv.h"

#include <fmt/format.h>
#include <system_error>

namespace haptel::tools {

namespace {

constexpr std::size_t ticks_max = std::size_t{1} << 20; // a quarter of an hour at 1 kHz, 170 MB

double squared_force(const runtime::TickRecord& tick)
{
    return glm::dot(tick.force_n, tick.force_n);
}

std::string cannot_write(const std::filesystem::path& file)
{
    return fmt::format("cannot write '{}'", file.string());
}

} // namespace

ExploreFiles::ExploreFiles(const std::filesystem::path& folder, std::size_t hand)
    : folder_(folder), suffix_(hand == 0 ? "" : fmt::format("_{}", hand + 1))
{
    std::error_code failed;
    std::filesystem::create_directories(folder, failed);
    trace_.open(path("trace", "csv"));
    if (!trace_) error_ = cannot_write(path("trace", "csv"));
    runtime::write_trace_header(trace_);
}

void ExploreFiles::add(const runtime::TickRecord& record)
{
    runtime::write_trace_row(trace_, record);
    if (added_++ % stride_ == 0)
        ticks_.push_back(record);
    else if (squared_force(record) > squared_force(ticks_.back()))
        ticks_.back() = record;
    if (ticks_.size() < ticks_max) return;
    for (std::size_t i = 0; i < ticks_max / 2; ++i)
        ticks_[i] = squared_force(ticks_[2 * i]) > squared_force(ticks_[2 * i + 1]) ? ticks_[2 * i] : ticks_[2 * i + 1];
    ticks_.resize(ticks_max / 2);
    stride_ *= 2;
}

std::filesystem::path ExploreFiles::path(const char* name, const char* extension) const
{
    return folder_ / fmt::format("{}{}.{}", name, suffix_, extension);
}

void ExploreFiles::finish(const std::string& scene, const runtime::ServoReport& servo, double force_limit_n,
                          const plot::NormalBelow& surface)
{
    const auto note = [&](const std::string& problem) {
        if (error_.empty()) error_ = problem;
    };
    trace_.close();
    if (!trace_) note(cannot_write(path("trace", "csv")));
    note(plot::draw_force(ticks_, scene, force_limit_n).write_png(path("force", "png").string()));
    note(plot::draw_path(ticks_, scene, surface).write_png(path("path", "png").string()));
    note(plot::draw_tick_histogram(servo.tick_ns, scene, 1 / servo.rate_hz)
             .write_png(path("tick_time", "png").string()));
}

std::string write_report(const std::filesystem::path& folder, const ExploreOutcome& outcome)
{
    std::ofstream report(folder / "report.json");
    report << to_text(to_json(outcome)) << '\n';
    report.close();
    return report ? "" : cannot_write(folder / "report.json");
}

} // namespace haptel::tools
