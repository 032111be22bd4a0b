#include "tools/explore_files.h"

#include "runtime/recording.h"

#include <fmt/format.h>
#include <system_error>

namespace haptel::tools {

namespace {

constexpr std::size_t ticks_max = std::size_t{1} << 20; // a quarter of an hour at 1 kHz, 170 MB

double squared_force(const runtime::TickRecord& tick)
{
    return glm::dot(tick.force_n, tick.force_n);
}

} // namespace

ExploreFiles::ExploreFiles(const std::filesystem::path& folder) : folder_(folder)
{
    std::error_code failed;
    std::filesystem::create_directories(folder, failed);
    trace_.open(folder / "trace.csv");
    if (!trace_) error_ = fmt::format("cannot write '{}'", (folder / "trace.csv").string());
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

void ExploreFiles::finish(const ExploreOutcome& outcome, double force_limit_n, const plot::SurfaceBelow& surface)
{
    const auto note = [&](const std::string& problem) {
        if (error_.empty()) error_ = problem;
    };
    trace_.close();
    if (!trace_) note(fmt::format("cannot write '{}'", (folder_ / "trace.csv").string()));

    std::ofstream report(folder_ / "report.json");
    report << to_text(to_json(outcome)) << '\n';
    report.close();
    if (!report) note(fmt::format("cannot write '{}'", (folder_ / "report.json").string()));

    const double period_s = 1 / outcome.servo.rate_hz;
    note(plot::draw_force(ticks_, outcome.scene, force_limit_n).write_png((folder_ / "force.png").string()));
    note(plot::draw_path(ticks_, outcome.scene, surface).write_png((folder_ / "path.png").string()));
    note(plot::draw_tick_histogram(outcome.servo.tick_ns, outcome.scene, period_s)
             .write_png((folder_ / "tick_time.png").string()));
}

} // namespace haptel::tools
