// The hands of an exploration: a servo for each, on one scene, and what is written of them.
#pragma once

#include "runtime/files/scene_file.h"
#include "runtime/servo/servo_thread.h"
#include "runtime/servo/servo_turns.h"
#include "tools/plot/plot_run.h"
#include "tools/report/explore_files.h"
#include "tools/report/explore_report.h"
#include "tools/report/explore_status.h"

#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace haptel::tools {

class ExploreHands {
public:
    // An empty folder: nothing is written.
    ExploreHands(std::shared_ptr<const runtime::Scene> scene, std::vector<runtime::LoadedHand> hands,
                 const runtime::ServoOptions& options, const std::string& folder);

    // Wall clock: a thread each. Virtual clock: one thread, a tick each in turn.
    void start();
    bool running() const;
    void request_stop();
    // Another scene for all of them, from their next tick on. Returns why it is refused, or nothing.
    std::string publish(const std::shared_ptr<const runtime::Scene>& scene);
    // Frees the scenes that they have left.
    void collect();
    // Takes what the servos have told, at most a ring each. False: nothing.
    bool drain(ExploreStatus& status);
    // Waits for the end of all, and takes the rest.
    std::vector<HandOutcome> wait(ExploreStatus& status);
    // Writes what is left to write of the files.
    void finish(const ExploreOutcome& outcome);

    // Why something could not be written; empty: all is well.
    std::string error() const;

private:
    struct Hand {
        std::string device;
        runtime::Workspace workspace;
        double position_resolution_m = 0; // of its device; 0: not known
        HeightRange heights;              // that it felt
        UnfeltContact unfelt;
        std::unique_ptr<runtime::ServoThread> servo;
        std::optional<ExploreFiles> files;
    };

    std::shared_ptr<const runtime::Scene> scene_;
    std::string folder_;
    std::vector<Hand> hands_;
    std::vector<runtime::TickRecord> newest_;  // of each hand
    std::optional<runtime::ServoTurns> turns_; // of all servos; virtual clock only
    std::string report_error_;
};

} // namespace haptel::tools
