#include "tools/explore/explore_hands.h"

#include "lang/text/diagnostic.h"
#include "tools/arguments/feel_files.h"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <utility>

namespace haptel::tools {

namespace {

// A slope of a tenth is plain to a hand and hardly seen in shades of grey.
constexpr double relief_exaggeration = 4;

} // namespace

ExploreHands::ExploreHands(std::shared_ptr<const runtime::Scene> scene, std::vector<runtime::LoadedHand> hands,
                           const runtime::ServoOptions& options, ExploreKept kept)
    : scene_(std::move(scene)), folder_(kept.folder), recording_(kept.recording), newest_(hands.size())
{
    std::vector<runtime::ServoThread*> servos;
    for (std::size_t i = 0; i < hands.size(); ++i) {
        runtime::ServoOptions own = options;
        own.hand = hands[i].settings;
        Hand& hand = hands_.emplace_back();
        hand.device = hands[i].device->info();
        hand.workspace = hands[i].settings.workspace;
        if (!kept.recording.empty()) {
            kept.origin.device = hand.device;
            kept.origin.hand = static_cast<uint32_t>(i + 1);
            hand.origin = kept.origin;
            hand.recording = std::make_unique<runtime::TraceLog>(take_file(i), hand.origin);
        }
        hand.servo = std::make_unique<runtime::ServoThread>(scene_, std::move(hands[i].device), own);
        servos.push_back(hand.servo.get());
        if (!folder_.empty()) hand.files.emplace(folder_, i);
    }
    if (options.clock == runtime::ServoClock::virtual_time) turns_.emplace(std::move(servos));
}

void ExploreHands::start()
{
    if (turns_) return turns_->start();
    for (Hand& hand : hands_) hand.servo->start();
}

bool ExploreHands::running() const
{
    return std::any_of(hands_.begin(), hands_.end(), [](const Hand& hand) { return hand.servo->running(); });
}

void ExploreHands::request_stop()
{
    for (Hand& hand : hands_) hand.servo->request_stop();
}

void ExploreHands::withhold_force(bool is_withheld)
{
    for (Hand& hand : hands_) hand.servo->withhold_force(is_withheld);
}

bool ExploreHands::is_force_withheld() const
{
    return hands_.front().servo->is_force_withheld();
}

std::vector<ControlledHand> ExploreHands::felt() const
{
    std::vector<ControlledHand> felt;
    for (std::size_t i = 0; i < hands_.size(); ++i)
        felt.push_back({newest_[i].tip_m, newest_[i].force_n, newest_[i].contact, newest_[i].object, newest_[i].faults,
                        hands_[i].servo->missed_deadlines()});
    return felt;
}

// run.haptrace, run_take_2.haptrace, of the second hand run_take_2_2.haptrace.
std::string ExploreHands::take_file(std::size_t hand) const
{
    if (takes_ == 1) return recording_of_hand(recording_, hand);
    const std::filesystem::path first = recording_;
    return recording_of_hand(
        (first.parent_path() / fmt::format("{}_take_{}{}", first.stem().string(), takes_, first.extension().string()))
            .string(),
        hand);
}

ControlAnswer ExploreHands::start_recording()
{
    if (recording_.empty()) return {"there is no file to record to: start with --record FILE.haptrace", {}};
    if (hands_.front().recording) return {"a recording is under way: stop it first", {}};
    ++takes_;
    for (std::size_t i = 0; i < hands_.size(); ++i) {
        hands_[i].recording = std::make_unique<runtime::TraceLog>(take_file(i), hands_[i].origin);
        if (hands_[i].recording->error().empty()) continue;
        std::string why = hands_[i].recording->error();
        for (Hand& hand : hands_) hand.recording.reset();
        return {std::move(why), {}};
    }
    return {{}, take_file(0)};
}

ControlAnswer ExploreHands::stop_recording()
{
    if (!hands_.front().recording) return {"nothing is recorded", {}};
    std::string error;
    for (Hand& hand : hands_) {
        hand.recording->hand_over();
        error += hand.recording->error();
        hand.recording.reset();
    }
    if (!error.empty()) return {std::move(error), {}};
    return {{}, take_file(0)};
}

std::string ExploreHands::publish(const std::shared_ptr<const runtime::Scene>& scene)
{
    std::string refused;
    for (Hand& hand : hands_) refused = hand.servo->publish(scene); // of one rate: all say the same
    return refused;
}

void ExploreHands::collect()
{
    for (Hand& hand : hands_) hand.servo->collect();
}

std::string ExploreHands::take_messages()
{
    std::string messages;
    const auto now = std::chrono::steady_clock::now();
    if (now - looked_ < std::chrono::milliseconds(100)) return messages;
    looked_ = now;
    for (Hand& hand : hands_)
        if (std::string state = hand.servo->device_state(); state != hand.device_state) {
            hand.device_state = std::move(state);
            if (!hand.device_state.empty())
                messages += fmt::format("{}: {}\n", hand.device.name, lang::printable(hand.device_state));
        }
    return messages;
}

bool ExploreHands::is_recording_lost() const
{
    return std::any_of(hands_.begin(), hands_.end(),
                       [](const Hand& hand) { return hand.recording && !hand.recording->error().empty(); });
}

bool ExploreHands::drain(ExploreStatus& status)
{
    bool any = false;
    for (std::size_t i = 0; i < hands_.size(); ++i) {
        runtime::Telemetry& telemetry = hands_[i].servo->telemetry();
        // At most one ring: a servo that is faster than its reader must not keep it from hearing Ctrl-C.
        for (std::size_t left = telemetry.capacity(); left > 0 && telemetry.pop(newest_[i]); --left) {
            any = true;
            hands_[i].heights.add(newest_[i], hands_[i].workspace.scale);
            hands_[i].unfelt.add(newest_[i], hands_[i].workspace.scale);
            if (hands_[i].files) hands_[i].files->add(newest_[i]);
            if (hands_[i].recording) hands_[i].recording->add(newest_[i]);
        }
        if (hands_[i].recording) hands_[i].recording->keep_up();
    }
    if (any) status.show(newest_);
    return any;
}

std::vector<HandOutcome> ExploreHands::wait(ExploreStatus& status)
{
    if (turns_) turns_->wait();
    std::vector<HandOutcome> outcomes;
    for (Hand& hand : hands_) outcomes.push_back({hand.device, hand.servo->wait(), {}, {}});
    drain(status);
    for (Hand& hand : hands_)
        if (hand.recording) hand.recording->hand_over();
    for (std::size_t i = 0; i < hands_.size(); ++i) {
        outcomes[i].heights = hands_[i].heights;
        outcomes[i].unfelt = hands_[i].unfelt;
    }
    return outcomes;
}

void ExploreHands::finish(const ExploreOutcome& outcome)
{
    for (std::size_t i = 0; i < hands_.size(); ++i)
        if (hands_[i].files)
            hands_[i].files->finish(outcome.scene, outcome.hands[i].servo, scene_->servo.force_limit_n,
                                    plot::textured_normal_below(scene_, hands_[i].workspace, relief_exaggeration));
    if (!folder_.empty()) report_error_ = write_report(folder_, outcome);
}

std::string ExploreHands::error() const
{
    for (const Hand& hand : hands_)
        if (hand.recording && !hand.recording->error().empty())
            return hand.recording->error();
        else if (hand.files && !hand.files->error().empty())
            return hand.files->error();
    return report_error_;
}

} // namespace haptel::tools
