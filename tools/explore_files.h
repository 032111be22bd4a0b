// What `haptel explore --out DIR` leaves: trace.csv as the run goes, report.json and pictures at its end.
#pragma once

#include "runtime/telemetry.h"
#include "tools/explore_report.h"
#include "tools/plot_run.h"

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace haptel::tools {

class ExploreFiles {
public:
    // Makes the folder and opens the trace; see error().
    explicit ExploreFiles(const std::filesystem::path& folder);

    void add(const runtime::TickRecord& record);

    // Closes the trace and writes the rest.
    void finish(const ExploreOutcome& outcome, double force_limit_n, const plot::SurfaceBelow& surface);

    // Why something could not be written; empty: all is well.
    const std::string& error() const { return error_; }

private:
    std::filesystem::path folder_;
    std::ofstream trace_;
    // For the pictures. Long runs are thinned: of two neighbours the one with the larger force stays.
    std::vector<runtime::TickRecord> ticks_;
    uint64_t added_ = 0, stride_ = 1;
    std::string error_;
};

} // namespace haptel::tools
