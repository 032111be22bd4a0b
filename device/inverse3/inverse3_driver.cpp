#include "device/inverse3/inverse3_driver.h"

#include "device/guard/force_guard.h"
#include "runtime/servo/real_time.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <fmt/format.h>
#include <utility>

namespace haptel::device {

namespace {

constexpr int64_t ns_per_ms = 1'000'000;
constexpr glm::dvec3 no_force_n(0);

} // namespace

Inverse3Driver::Inverse3Driver(ServiceAddress address, std::string id, const Inverse3Times& times)
    : address_(std::move(address)), id_(std::move(id)), times_(times), thread_([this] { run(); })
{
}

Inverse3Driver::~Inverse3Driver()
{
    quit_.store(true, std::memory_order_release);
    halt();
    thread_.join();
}

void Inverse3Driver::command(const glm::dvec3& force_n, uint32_t session) noexcept
{
    commands_.put({force_n, runtime::monotonic_ns(), session});
    wake_.wake();
}

void Inverse3Driver::halt() noexcept
{
    halted_.store(true, std::memory_order_release);
    wake_.wake();
}

std::string Inverse3Driver::state() const
{
    const std::lock_guard lock(state_mutex_);
    return state_;
}

Inverse3Counters Inverse3Driver::counters() const noexcept
{
    constexpr auto relaxed = std::memory_order_relaxed;
    return {sent_count_.load(relaxed), states_count_.load(relaxed), dropped_count_.load(relaxed)};
}

void Inverse3Driver::enter(Inverse3Phase phase, std::string state)
{
    {
        const std::lock_guard lock(state_mutex_);
        state_ = std::move(state);
    }
    phase_.store(phase, std::memory_order_release);
}

void Inverse3Driver::run()
{
    if (times_.real_time) runtime::ask_for_real_time();
    int failures = 0;
    try {
        while (!quitting()) {
            const bool had_force = !held_by_.empty();
            if (!connect_and_exchange(failures)) break;
            const bool is_urgent = !held_by_.empty() && !had_force; // at once, once
            if (!is_urgent) pause();
        }
        take_force_away_at_the_end();
    } catch (const std::exception& failure) { // no memory
        session_.store(0, std::memory_order_release);
        enter(Inverse3Phase::failed, fmt::format("the Inverse3 cannot be used: {}", failure.what()));
    }
}

// The servo's commands would wake a wait for the event.
void Inverse3Driver::pause() const
{
    const int64_t until_ns = runtime::monotonic_ns() + ns_per_ms * times_.again_ms;
    while (!quitting() && runtime::monotonic_ns() < until_ns)
        std::this_thread::sleep_for(std::chrono::milliseconds(std::min(times_.again_ms, 20)));
}

// Of several the one that a force was left on.
Inverse3Choice Inverse3Driver::choose(const Inverse3Inventory& inventory)
{
    if (id_.empty() && !held_by_.empty())
        if (const Inverse3Choice held = choose_inverse3(inventory, held_by_, address_); held.device) return held;
    return choose_inverse3(inventory, id_, address_);
}

bool Inverse3Driver::connect_and_exchange(int& failures)
{
    ServiceSocket socket(wake_);
    const Inverse3Greeting greeting = greet_inverse3(socket, address_, times_.connect_ms, quit_);
    Ending ending{greeting.error, greeting.is_absent};
    if (ending.reason.empty()) {
        const Inverse3Choice choice = choose(greeting.inventory);
        ending = choice.device ? converse(socket, *choice.device) : Ending{choice.error, true};
        if (choice.device && session_states_ > 0) {
            failures = 0;
            absent_since_ns_ = 0;
            return true;
        }
    }
    if (quitting()) return false;
    if (ending.is_absent) {
        const int64_t now_ns = runtime::monotonic_ns();
        if (absent_since_ns_ == 0) absent_since_ns_ = now_ns;
        const bool is_patient = static_cast<double>(now_ns - absent_since_ns_) < 1e9 * times_.patience_s;
        enter(is_patient ? Inverse3Phase::connecting : Inverse3Phase::disconnected, std::move(ending.reason));
        return is_patient;
    }
    absent_since_ns_ = 0;
    const bool is_hopeless = ++failures >= times_.tries;
    enter(is_hopeless ? Inverse3Phase::failed : Inverse3Phase::connecting,
          "the Inverse3 cannot be used: " + ending.reason);
    return !is_hopeless;
}

// From the first message to the last.
Inverse3Driver::Ending Inverse3Driver::converse(ServiceSocket& socket, const Inverse3Listed& device)
{
    command_ = {};
    is_fresh_ = false;
    owed_ = 0;
    session_states_ = 0;
    said_n_ = no_force_n;
    say(socket, inverse3_first_message(device.id).view(), device.id, no_force_n);
    session_.store(++sessions_, std::memory_order_release);
    Ending ending;
    try {
        ending = exchange(socket, device);
    } catch (...) { // no memory
        say_last(socket, device.id);
        throw;
    }
    session_.store(0, std::memory_order_release);
    say_last(socket, device.id);
    if (!ending.reason.empty()) enter(Inverse3Phase::connecting, ending.reason);
    return ending;
}

Inverse3Driver::Ending Inverse3Driver::exchange(ServiceSocket& socket, const Inverse3Listed& device)
{
    const std::string word = ServiceSocket::frame_of(inverse3_force(device.id, no_force_n).view());
    ForceGuard guard(times_.guarded ? socket.file_descriptor() : -1, 0,
                     {reinterpret_cast<const uint8_t*>(word.data()), word.size()});
    while (!quitting()) {
        if (guard.hear()) was_silenced();
        is_fresh_ = commands_.take(command_) || is_fresh_;
        const int64_t now_ns = runtime::monotonic_ns();
        const glm::dvec3 force_n = wanted_n(now_ns);
        if (is_due(force_n, now_ns) && !socket.is_writing()) {
            note_what_is_dropped(force_n);
            say(socket, inverse3_force(device.id, force_n).view(), device.id, force_n);
        }
        switch (socket.wait(socket.is_writing() ? now_ns + ns_per_ms : next_deadline_ns())) {
        case SocketEvent::message:
            if (Ending ending = hear(socket, device); !ending.reason.empty()) return ending;
            break;
        case SocketEvent::lost: return {fmt::format("the Inverse3 was lost: {}", socket.error()), true};
        case SocketEvent::woken:
        case SocketEvent::time: break;
        }
        if (owed_ > 0 && runtime::monotonic_ns() - owed_since_ns_ >= ns_per_ms * times_.silence_ms)
            return {fmt::format("the service at {} answers no longer", address_.text()), true};
    }
    return {};
}

// Empty: it is a state.
Inverse3Driver::Ending Inverse3Driver::hear(const ServiceSocket& socket, const Inverse3Listed& device)
{
    constexpr const char* restart = ": restart Haply's Inverse service";
    if (const std::string_view fault = socket.message_fault(); !fault.empty())
        return {std::string(fault) + restart, false};
    const Inverse3Reply reply = read_inverse3_state(socket.message(), device.id);
    switch (reply.heard) {
    case Inverse3Heard::malformed: return {std::string("it sends what is no state of an Inverse3") + restart, false};
    case Inverse3Heard::no_device:
        return {fmt::format("the service no longer has the Inverse3 {}: is it plugged in?", device.id), true};
    case Inverse3Heard::state: break;
    }
    const int64_t now_ns = runtime::monotonic_ns();
    owed_ = std::max(0, owed_ - 1);
    if (owed_ == 0 && said_n_ == no_force_n) held_by_.clear();
    owed_since_ns_ = now_ns;
    const int64_t asked_ns = std::exchange(asked_ns_, 0);
    readings_.put({reply.state, device.is_centred, now_ns, sessions_, asked_ns > 0 ? now_ns - asked_ns : 0});
    states_count_.fetch_add(1, std::memory_order_relaxed);
    if (++session_states_ == 1) enter(Inverse3Phase::streaming, "connected");
    return {};
}

// What the device should hold now.
glm::dvec3 Inverse3Driver::wanted_n(int64_t now_ns) const noexcept
{
    const bool servo_is_there =
        command_.session == sessions_ && now_ns - command_.time_ns < ns_per_ms * times_.watchdog_ms;
    return servo_is_there && !halted_.load(std::memory_order_acquire) ? command_.force_n : no_force_n;
}

// The servo learns of it and begins anew from no force, unless it meant to end.
void Inverse3Driver::note_what_is_dropped(const glm::dvec3& force_n) noexcept
{
    if (force_n != no_force_n || said_n_ == no_force_n || command_.force_n == no_force_n ||
        halted_.load(std::memory_order_acquire))
        return;
    count_dropped();
}

// This thread stood still, and its guard may have spoken. An answer to that comes beside those that are owed.
void Inverse3Driver::was_silenced() noexcept
{
    command_ = {}; // of no session
    asked_ns_ = 0;
    unsure_until_ns_ = runtime::monotonic_ns() + ns_per_ms * times_.silence_ms;
    if (std::exchange(said_n_, no_force_n) != no_force_n) count_dropped();
}

void Inverse3Driver::count_dropped() noexcept
{
    dropped_count_.fetch_add(1, std::memory_order_relaxed);
    dropped_.store(true, std::memory_order_release);
}

// A force waits for the state that answers the one before; to take it away does not.
bool Inverse3Driver::is_due(const glm::dvec3& force_n, int64_t now_ns) const noexcept
{
    if (force_n == no_force_n && said_n_ != no_force_n) return true;
    return owed_ == 0 && (is_fresh_ || now_ns - said_ns_ >= ns_per_ms * times_.keep_alive_ms);
}

int64_t Inverse3Driver::next_deadline_ns() const noexcept
{
    const int64_t next_ns =
        owed_ > 0 ? owed_since_ns_ + ns_per_ms * times_.silence_ms : said_ns_ + ns_per_ms * times_.keep_alive_ms;
    const int64_t watched_ns = std::min(next_ns, runtime::monotonic_ns() + ns_per_ms * guard_hears_ms);
    return said_n_ == no_force_n ? watched_ns : std::min(watched_ns, command_.time_ns + ns_per_ms * times_.watchdog_ms);
}

// Where it was not sent the connection is lost, and the wait that follows says why.
void Inverse3Driver::say(ServiceSocket& socket, std::string_view message, const std::string& id,
                         const glm::dvec3& force_n)
{
    const int64_t now_ns = runtime::monotonic_ns(); // the answer may be here before send() returns
    if (!socket.send(message)) return;
    if (force_n != no_force_n) held_by_ = id;
    said_n_ = force_n;
    said_ns_ = now_ns;
    asked_ns_ = owed_ == 0 && said_ns_ >= unsure_until_ns_ ? said_ns_ : 0;
    if (owed_++ == 0) owed_since_ns_ = said_ns_;
    is_fresh_ = false;
    sent_count_.fetch_add(1, std::memory_order_relaxed);
}

// No force, whatever came between; after it comes only the goodbye.
void Inverse3Driver::say_last(ServiceSocket& socket, const std::string& id)
{
    const int64_t until_ns = runtime::monotonic_ns() + ns_per_ms * times_.close_ms;
    if (!socket.flush(until_ns)) return;
    say(socket, inverse3_force(id, no_force_n).view(), id, no_force_n);
    if (socket.flush(until_ns) && socket.close(times_.close_ms)) held_by_.clear();
}

// Nobody will connect again who could.
void Inverse3Driver::take_force_away_at_the_end()
{
    if (held_by_.empty()) return;
    static constexpr std::atomic<bool> never{false};
    ServiceSocket socket(wake_);
    if (!greet_inverse3(socket, address_, times_.rescue_ms, never).error.empty()) return;
    say(socket, inverse3_first_message(held_by_).view(), held_by_, no_force_n);
    say_last(socket, std::string(held_by_));
}

} // namespace haptel::device
