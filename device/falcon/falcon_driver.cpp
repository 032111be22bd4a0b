#include "device/falcon/falcon_driver.h"

#include "device/falcon/ftdi_serial.h"
#include "runtime/servo/real_time.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <fmt/format.h>
#include <utility>

namespace haptel::device {

FalconDriver::FalconDriver(OpenTransport open, FalconOptions options)
    : open_(std::move(open)), options_(std::move(options)), link_(options_.times), thread_([this] { run(); })
{
}

FalconDriver::~FalconDriver()
{
    link_.quit();
    thread_.join();
}

std::string FalconDriver::state() const
{
    const std::lock_guard lock(state_mutex_);
    return state_;
}

void FalconDriver::enter(FalconPhase phase, std::string state)
{
    {
        const std::lock_guard lock(state_mutex_);
        state_ = std::move(state);
    }
    phase_.store(phase, std::memory_order_release);
}

void FalconDriver::run()
{
    if (options_.real_time) runtime::ask_for_real_time();
    int failures = 0;
    try {
        while (!link_.quitting() && connect_and_stream(failures)) wait_before_next_try();
    } catch (const std::exception& failure) { // no memory
        link_.end_session();
        enter(FalconPhase::failed, fmt::format("the Falcon cannot be used: {}", failure.what()));
    }
}

void FalconDriver::wait_before_next_try()
{
    const int64_t until_ns = runtime::monotonic_ns() + int64_t{1'000'000} * options_.again_ms;
    // The servo's commands wake as well.
    while (!link_.quitting() && runtime::monotonic_ns() < until_ns)
        std::this_thread::sleep_for(std::chrono::milliseconds(std::min(options_.again_ms, 20)));
}

bool FalconDriver::connect_and_stream(int& failures)
{
    OpenedTransport opened = open_();
    BringUpResult result{BringUpEnd::try_again, opened.code, opened.error, false};
    if (opened.transport)
        result = bring_up_falcon(*opened.transport, options_.firmware, options_.bring_up, link_.quitting());
    if (link_.quitting()) return false;

    if (result.end == BringUpEnd::ready) {
        absent_since_ns_ = 0;
        result.error = stream(*opened.transport);
        if (link_.replies_of_session() > 0) failures = 0;
        if (link_.replies_of_session() > 0 || link_.quitting()) return true;
        result.reason =
            result.error == UsbError::gone ? words_of(result.error) : "it answered once, and not when it was asked on";
    }
    if (!opened.transport || result.error == UsbError::gone) { // absent: it may come back
        const int64_t now_ns = runtime::monotonic_ns();
        if (absent_since_ns_ == 0) absent_since_ns_ = now_ns;
        const bool patient = static_cast<double>(now_ns - absent_since_ns_) < 1e9 * options_.patience_s;
        enter(patient ? FalconPhase::connecting : FalconPhase::disconnected, result.reason);
        return patient;
    }
    absent_since_ns_ = 0;
    const bool hopeless = result.end == BringUpEnd::no_program || ++failures >= options_.tries;
    if (result.end != BringUpEnd::no_program) result.reason += ". Take its power and its USB away for a moment";
    enter(hopeless ? FalconPhase::failed : FalconPhase::connecting, "the Falcon cannot be used: " + result.reason);
    return !hopeless;
}

UsbError FalconDriver::stream(Transport& transport)
{
    link_.begin_session();
    enter(FalconPhase::streaming, "connected");
    const UsbError error = transport.stream({}, link_.wake_event(), link_);
    link_.end_session();
    enter(FalconPhase::connecting, error == UsbError::cancelled
                                       ? "the Falcon answers no longer"
                                       : fmt::format("the Falcon was lost: {}", words_of(error)));
    // The motors hold what they heard last.
    FtdiSerial serial(transport, options_.bring_up.transfer_ms);
    serial.write(encode({{}, falcon_green}));
    return error;
}

} // namespace haptel::device
