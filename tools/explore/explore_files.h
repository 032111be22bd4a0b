// What `haptel explore --out DIR` leaves: a trace of each hand as the run goes, its pictures and report.json at the
// end.
#pragma once

#include "runtime/servo/telemetry.h"
#include "tools/explore/explore_report.h"
#include "tools/plot/plot_run.h"

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace haptel::tools {

class ExploreFiles {
public:
    // Makes the folder and opens the trace; see error(). The first hand's files are trace.csv and so on, those of the
    // others trace_2.csv and so on.
    ExploreFiles(const std::filesystem::path& folder, std::size_t hand);

    void add(const runtime::TickRecord& record);

    // Closes the trace and draws the pictures.
    void finish(const std::string& scene, const runtime::ServoReport& servo, double force_limit_n,
                const plot::NormalBelow& surface);

    // Why something could not be written; empty: all is well.
    const std::string& error() const { return error_; }

private:
    std::filesystem::path path(const char* name, const char* extension) const;

    std::filesystem::path folder_;
    std::string suffix_; // of the names of its files
    std::ofstream trace_;
    // For the pictures. Long runs are thinned: of two neighbours the one with the larger force stays.
    std::vector<runtime::TickRecord> ticks_;
    uint64_t added_ = 0, stride_ = 1;
    std::string error_;
};

// report.json in the folder; returns why it could not be written, or nothing.
std::string write_report(const std::filesystem::path& folder, const ExploreOutcome& outcome);

} // namespace haptel::tools
