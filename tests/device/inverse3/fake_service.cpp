#include "tests/device/inverse3/fake_service.h"

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>
#include <nlohmann/json.hpp>

#include <chrono>
#include <future>
#include <limits>
#include <mutex>
#include <random>
#include <set>
#include <thread>
#include <utility>

namespace haptel::device {

namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace websocket = beast::websocket;
using asio::ip::tcp;
using boost::system::error_code;
using FakeJson = nlohmann::json;

constexpr std::array<const char*, service_faults> fault_names = {
    "none",   "mute", "web_page", "no_inventory", "bad_inventory", "no_device", "other_device",
    "silent", "slow", "unasked",  "gone",         "bad_json",      "bad_state", "infinite",
    "binary", "huge", "endless",  "random_bytes", "bad_frame",     "goodbye",   "reset"};

FakeJson json_of(const glm::dvec3& v)
{
    return {{"x", v.x}, {"y", v.y}, {"z", v.z}};
}

} // namespace

const char* name_of(ServiceFault fault)
{
    return fault_names.at(static_cast<std::size_t>(fault));
}

bool ends_connection(ServiceFault fault)
{
    return fault >= ServiceFault::silent && fault != ServiceFault::slow && fault != ServiceFault::unasked;
}

struct FakeService::Service {
    struct Session;

    // The service's thread, but for what the mutex guards.
    asio::io_context io{1};
    tcp::acceptor acceptor{io};
    std::set<std::shared_ptr<Session>> sessions;
    std::mt19937 random{7};
    uint16_t port = 0;

    mutable std::mutex mutex;
    ServiceFault fault = ServiceFault::none;
    uint64_t fault_from = 0, fault_until = 0; // messages
    bool has_met_fault = false;
    int slow_ms = 30;
    glm::dvec3 position_m{0, -0.12, 0.15}, velocity_m_per_s{0}, force_n{0};
    std::string preset = "defaults";
    std::vector<glm::dvec3> forces_n;
    std::vector<std::string> texts;
    uint64_t states = 0, connections = 0, with_force = 0, violations = 0;
    std::thread thread; // last

    void listen();
    void accept();
    FakeJson device(bool with_config) const;
    std::string inventory(ServiceFault now) const;
    std::string state(ServiceFault now);
    ServiceFault heard(const std::string& text, bool is_first, glm::dvec3& force);
    ServiceFault greeting_fault()
    {
        const std::lock_guard lock(mutex);
        if (fault == ServiceFault::none || fault >= ServiceFault::silent) return ServiceFault::none;
        has_met_fault = true;
        return fault;
    }
};

// One connection.
struct FakeService::Service::Session : std::enable_shared_from_this<Session> {
    Session(Service& service, tcp::socket socket) : of(service), stream(std::move(socket)) {}

    Service& of;
    websocket::stream<tcp::socket, false> stream;
    beast::flat_buffer buffer;
    std::vector<std::string> queue; // of what is to be written; the first is being written
    bool is_first = true, is_closing = false;
    glm::dvec3 last_n{0};

    void drop()
    {
        error_code ignored;
        stream.next_layer().close(ignored);
        of.sessions.erase(this->shared_from_this());
    }

    void begin()
    {
        const ServiceFault fault = of.greeting_fault();
        const auto self = this->shared_from_this();
        error_code ignored;
        stream.next_layer().set_option(tcp::no_delay(true), ignored);
        if (fault == ServiceFault::mute) return;
        if (fault == ServiceFault::web_page) {
            asio::write(stream.next_layer(), asio::buffer(std::string("HTTP/1.1 404 Not Found\r\n\r\n")), ignored);
            return drop();
        }
        stream.async_accept([this, self, fault](const error_code& failed) {
            if (failed) return drop();
            stream.auto_fragment(false);
            stream.text(true);
            if (fault != ServiceFault::no_inventory) write(of.inventory(fault));
            read();
        });
    }

    void read()
    {
        stream.async_read(buffer, [this, self = this->shared_from_this()](const error_code& failed, std::size_t) {
            if (failed) {
                const std::lock_guard lock(of.mutex);
                // Not where a library says it of itself, of a frame that is none.
                const bool is_goodbye =
                    failed == websocket::error::closed && stream.reason().code == websocket::close_code::normal;
                of.violations += is_goodbye && last_n != glm::dvec3(0);
            }
            if (failed) return drop();
            const std::string text = beast::buffers_to_string(buffer.data());
            buffer.consume(buffer.size());
            const ServiceFault fault = of.heard(text, std::exchange(is_first, false), last_n);
            answer(fault);
            if (stream.next_layer().is_open()) read();
        });
    }

    void write(std::string text)
    {
        queue.push_back(std::move(text));
        if (queue.size() == 1) write_next();
    }
    void write_next()
    {
        stream.async_write(asio::buffer(queue.front()),
                           [this, self = this->shared_from_this()](const error_code& failed, std::size_t) {
                               if (failed) return;
                               queue.erase(queue.begin());
                               if (!queue.empty()) write_next();
                           });
    }
    // As no WebSocket would: nothing else is being written then.
    void write_raw(const std::string& bytes)
    {
        error_code ignored;
        asio::write(stream.next_layer(), asio::buffer(bytes), ignored);
    }

    void answer(ServiceFault fault)
    {
        const auto self = this->shared_from_this();
        switch (fault) {
        case ServiceFault::silent: return;
        case ServiceFault::slow: {
            const std::lock_guard lock(of.mutex);
            const auto later = std::make_shared<asio::steady_timer>(of.io, std::chrono::milliseconds(of.slow_ms));
            later->async_wait([this, self, later](const error_code&) { write(of.state(ServiceFault::none)); });
            return;
        }
        case ServiceFault::binary: stream.text(false); break;
        case ServiceFault::unasked: write(of.state(fault)); break;
        case ServiceFault::bad_frame: return write_raw(std::string(40, '\x7f'));
        // The head of a text frame of 2^40 bytes, and some of them.
        case ServiceFault::endless:
            return write_raw(std::string("\x81\x7f\0\0\1\0\0\0\0\0", 10) + std::string(1000, ' '));
        case ServiceFault::goodbye:
            if (!std::exchange(is_closing, true))
                stream.async_close(websocket::close_code::going_away, [self](const error_code&) {});
            return;
        case ServiceFault::reset: {
            error_code ignored;
            stream.next_layer().set_option(asio::socket_base::linger(true, 0), ignored);
            return drop();
        }
        default: break;
        }
        write(of.state(fault));
    }
};

FakeJson FakeService::Service::device(bool with_config) const
{
    FakeJson device = {{"device_id", "049D"},
                       {"state",
                        {{"cursor_position", json_of(position_m)},
                         {"cursor_velocity", json_of(velocity_m_per_s)},
                         {"current_cursor_force", json_of(force_n)},
                         {"control_mode", "force"}}},
                       {"status", {{"calibrated", true}}}};
    if (with_config) device["config"] = {{"type", "inverse3"}, {"preset", preset}};
    return device;
}

std::string FakeService::Service::inventory(ServiceFault now) const
{
    const std::lock_guard lock(mutex);
    FakeJson all = {{"session_id", 7}, {"inverse3", FakeJson::array()}, {"verse_grip", FakeJson::array()}};
    if (now == ServiceFault::bad_inventory) all["inverse3"] = {{{"device_id", "\"},{"}}};
    if (now == ServiceFault::other_device) all["inverse3"] = {{{"device_id", "1234"}}};
    if (now == ServiceFault::none) all["inverse3"] = {device(true)};
    return all.dump();
}

std::string FakeService::Service::state(ServiceFault now)
{
    const std::lock_guard lock(mutex);
    FakeJson all = {{"inverse3", {{{"device_id", "1234"}}, device(false)}}};
    switch (now) {
    case ServiceFault::gone: all["inverse3"].erase(1); break;
    case ServiceFault::bad_state: all["inverse3"][1]["state"]["cursor_position"].erase("y"); break;
    case ServiceFault::bad_json: return all.dump() + "}";
    case ServiceFault::infinite: all["inverse3"][1]["state"]["cursor_position"]["y"] = 1e300; break;
    case ServiceFault::huge: return all.dump() + std::string(2'000'000, ' ');
    case ServiceFault::random_bytes: {
        std::string bytes(random() % 300, ' ');
        for (char& byte : bytes) byte = static_cast<char>(random() % 128);
        return bytes;
    }
    default: ++states; break;
    }
    return all.dump();
}

// What to answer it with.
ServiceFault FakeService::Service::heard(const std::string& text, bool is_first, glm::dvec3& force)
{
    const std::lock_guard lock(mutex);
    const FakeJson message = FakeJson::parse(text, nullptr, false);
    glm::dvec3 said(std::numeric_limits<double>::quiet_NaN());
    try {
        const FakeJson& device = message.at("inverse3").at(0);
        const FakeJson& values = device.at("commands").at("set_cursor_force").at("values");
        if (device.at("device_id") == "049D") said = {values.at("x"), values.at("y"), values.at("z")};
    } catch (const FakeJson::exception&) {
    }
    const bool is_none = !(glm::length(said) <= 10 + 1e-9);
    violations += is_none || (is_first && said != glm::dvec3(0)) || is_first != message.contains("session");
    if (!is_none) force = force_n = said;
    with_force += said != glm::dvec3(0);
    forces_n.push_back(said);
    if (texts.size() < 10) texts.push_back(text);
    const uint64_t number = forces_n.size() - 1;
    const bool is_met = fault >= ServiceFault::silent && number >= fault_from && number - fault_from < fault_until;
    has_met_fault = has_met_fault || is_met;
    return is_met ? fault : ServiceFault::none;
}

void FakeService::Service::listen()
{
    const tcp::endpoint endpoint(asio::ip::address_v4::loopback(), port);
    acceptor.open(endpoint.protocol());
    acceptor.set_option(asio::socket_base::reuse_address(true));
    acceptor.bind(endpoint);
    acceptor.listen();
    port = acceptor.local_endpoint().port();
    accept();
}

void FakeService::Service::accept()
{
    acceptor.async_accept([this](const error_code& failed, tcp::socket socket) {
        if (failed) return;
        const auto session = std::make_shared<Session>(*this, std::move(socket));
        sessions.insert(session);
        {
            const std::lock_guard lock(mutex);
            ++connections;
        }
        session->begin();
        accept();
    });
}

FakeService::FakeService() : service_(std::make_unique<Service>())
{
    service_->listen();
    service_->thread = std::thread([service = service_.get()] {
        const auto work = asio::make_work_guard(service->io);
        service->io.run();
    });
}

FakeService::~FakeService()
{
    stop();
    service_->io.stop();
    service_->thread.join();
    service_->sessions.clear();
}

void FakeService::stop()
{
    std::promise<void> done;
    asio::post(service_->io, [this, &done] {
        error_code ignored;
        service_->acceptor.close(ignored);
        while (!service_->sessions.empty()) (*service_->sessions.begin())->drop();
        done.set_value();
    });
    done.get_future().wait();
}

void FakeService::start()
{
    std::promise<void> done;
    asio::post(service_->io, [this, &done] {
        if (!service_->acceptor.is_open()) service_->listen();
        done.set_value();
    });
    done.get_future().wait();
}

void FakeService::inject(ServiceFault fault, uint64_t after, uint64_t count)
{
    const std::lock_guard lock(service_->mutex);
    service_->fault = fault;
    service_->fault_from = service_->forces_n.size() + after;
    service_->fault_until = count;
    service_->has_met_fault = false;
}

void FakeService::place_at(const glm::dvec3& position_m, const glm::dvec3& velocity_m_per_s)
{
    const std::lock_guard lock(service_->mutex);
    service_->position_m = position_m;
    service_->velocity_m_per_s = velocity_m_per_s;
}

void FakeService::answer_after_ms(int ms)
{
    const std::lock_guard lock(service_->mutex);
    service_->slow_ms = ms;
}

void FakeService::set_preset(std::string preset)
{
    const std::lock_guard lock(service_->mutex);
    service_->preset = std::move(preset);
}

uint16_t FakeService::port() const
{
    return service_->port;
}

#define HAPTEL_GUARDED(type, name, what)                                                                               \
    type FakeService::name() const                                                                                     \
    {                                                                                                                  \
        const std::lock_guard lock(service_->mutex);                                                                   \
        return service_->what;                                                                                         \
    }
HAPTEL_GUARDED(glm::dvec3, force_n, force_n)
HAPTEL_GUARDED(std::vector<glm::dvec3>, forces_n, forces_n)
HAPTEL_GUARDED(std::vector<std::string>, texts, texts)
HAPTEL_GUARDED(uint64_t, messages, forces_n.size())
HAPTEL_GUARDED(uint64_t, states, states)
HAPTEL_GUARDED(uint64_t, connections, connections)
HAPTEL_GUARDED(uint64_t, messages_with_force, with_force)
HAPTEL_GUARDED(uint64_t, violations, violations)
HAPTEL_GUARDED(bool, has_met_fault, has_met_fault)
#undef HAPTEL_GUARDED

} // namespace haptel::device
