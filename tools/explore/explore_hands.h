// The hands of an exploration: a servo for each, on one scene, and what is written of them.
#pragma once

#include "runtime/files/scene_file.h"
#include "runtime/servo/servo_thread.h"
#include "runtime/servo/servo_turns.h"
#include "runtime/servo/trace_log.h"
#include "tools/control/controlled.h"
#include "tools/explore/explore_files.h"
#include "tools/explore/explore_report.h"
#include "tools/explore/explore_status.h"
#include "tools/plot/plot_run.h"

#include <chrono>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace haptel::tools {

// What is kept of a run. An empty name: nothing there.
struct ExploreKept {
    std::string folder;          // for traces, pictures and the report
    std::string recording;       // of the first hand; those of the others have their number in the name
    runtime::TraceOrigin origin; // of the recordings; their device and hand are filled in
};

class ExploreHands {
public:
    ExploreHands(std::shared_ptr<const runtime::Scene> scene, std::vector<runtime::LoadedHand> hands,
                 const runtime::ServoOptions& options, ExploreKept kept);

    // Wall clock: a thread each. Virtual clock: one thread, a tick each in turn.
    void start();
    bool running() const;
    void request_stop();
    // No force, while all goes on; and back again.
    void withhold_force(bool is_withheld);
    bool is_force_withheld() const;
    // As of the last drain.
    std::vector<ControlledHand> felt() const;

    // Of all hands: a recording ends, or another begins in a file that its number is in the name of. Returns why not,
    // or nothing and the first file.
    ControlAnswer start_recording();
    ControlAnswer stop_recording();

    // Another scene for all of them, from their next tick on. Returns why it is refused, or nothing.
    std::string publish(const std::shared_ptr<const runtime::Scene>& scene);
    // Frees the scenes that they have left.
    void collect();
    // A recording cannot be written any more: the run is worth nothing to whoever wanted it.
    bool is_recording_lost() const;
    // Takes what the servos have told, at most a ring each. False: nothing. To be called every few milliseconds: what
    // is recorded goes to the file from here.
    bool drain(ExploreStatus& status);
    // What devices say of themselves that they did not say before, a line each; looks ten times a second.
    std::string take_messages();
    // Waits for the end of all, and takes the rest.
    std::vector<HandOutcome> wait(ExploreStatus& status);
    // Writes what is left to write of the files.
    void finish(const ExploreOutcome& outcome);

    // Why something could not be written; empty: all is well.
    std::string error() const;

private:
    struct Hand {
        runtime::DeviceInfo device;
        std::string device_state;
        runtime::Workspace workspace;
        HeightRange heights; // that it felt
        UnfeltContact unfelt;
        std::unique_ptr<runtime::ServoThread> servo;
        std::optional<ExploreFiles> files;
        runtime::TraceOrigin origin; // of its recordings
        std::unique_ptr<runtime::TraceLog> recording;
    };

    std::string take_file(std::size_t hand) const; // of the recording that is written now

    std::shared_ptr<const runtime::Scene> scene_;
    std::string folder_, recording_;
    std::size_t takes_ = 1; // recordings that were begun, of each hand
    std::vector<Hand> hands_;
    std::vector<runtime::TickRecord> newest_;  // of each hand
    std::optional<runtime::ServoTurns> turns_; // of all servos; virtual clock only
    std::string report_error_;
    std::chrono::steady_clock::time_point looked_{}; // at what devices say
};

} // namespace haptel::tools
