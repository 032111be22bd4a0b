#include "device/inverse3/service_socket.h"

#include "runtime/servo/real_time.h"

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>

#include <algorithm>
#include <chrono>
#include <fmt/format.h>
#include <unistd.h>
#include <vector>

namespace haptel::device {

namespace {

namespace asio = boost::asio;
namespace websocket = boost::beast::websocket;
using asio::ip::tcp;
using boost::system::error_code;

std::vector<asio::ip::address> addresses_of(const std::string& host)
{
    if (host == "localhost") return {asio::ip::address_v4::loopback(), asio::ip::address_v6::loopback()};
    error_code bad;
    const auto address = asio::ip::make_address(host, bad);
    return bad ? std::vector<asio::ip::address>{} : std::vector{address};
}

constexpr const char* what_to_do =
    "start Haply's Inverse service, or name its place by HAPTEL_INVERSE3_SERVICE=HOST:PORT";

std::string words_of(const error_code& error)
{
    if (error == websocket::error::closed || error == asio::error::eof) return "the service closed the connection";
    if (error == asio::error::connection_reset || error == asio::error::broken_pipe) return "the connection was reset";
    return error.message();
}

} // namespace

struct ServiceSocket::Link {
    explicit Link(WakeEvent& event) : wake(event)
    {
        error_code none;
        // Nobody is woken where the system gives no descriptor: waits end by their time then.
        wake_descriptor.assign(dup(event.file_descriptor()), none);
        arm_wake();
    }

    void arm_wake()
    {
        if (!wake_descriptor.is_open()) return;
        wake_descriptor.async_wait(asio::posix::descriptor_base::wait_read,
                                   [this](const error_code& failed) { is_woken = !failed; });
    }

    // In parts, so that one of any size ends here and the connection is still good for a last word.
    void arm_read()
    {
        is_reading = true;
        stream.async_read_some(asio::buffer(received.data() + size, received.size() - size),
                               [this](const error_code& failed, std::size_t count) {
                                   is_reading = false;
                                   size += count;
                                   if (failed) return lose(failed);
                                   if (stream.is_message_done() || size == received.size())
                                       has_message = true;
                                   else
                                       arm_read();
                               });
    }

    void lose(const error_code& failed)
    {
        if (error.empty()) error = words_of(failed);
    }

    // Runs what is ready, or the first thing that will be.
    void run_some(int64_t until_ns)
    {
        io.restart();
        const int64_t left_ns = until_ns - runtime::monotonic_ns();
        if (left_ns > 0)
            io.run_one_for(std::chrono::nanoseconds(left_ns));
        else
            io.poll();
    }

    // For what is begun once: connecting, shaking hands, closing. It refers to nothing but this, so that one that never
    // ends may be left behind.
    auto when_done()
    {
        is_done = false;
        return [this](const error_code& failed) {
            is_done = true;
            outcome = failed;
        };
    }

    // Until it is done, the time is over or somebody quits: true if it is done.
    bool run_until_done(int64_t until_ns, const std::atomic<bool>* quit = nullptr)
    {
        while (!is_done && runtime::monotonic_ns() < until_ns && !(quit && quit->load(std::memory_order_acquire)))
            run_some(std::min(until_ns, runtime::monotonic_ns() + 20'000'000));
        return is_done;
    }

    asio::io_context io{1};
    websocket::stream<tcp::socket, false> stream{io}; // nothing is compressed
    asio::posix::stream_descriptor wake_descriptor{io};
    WakeEvent& wake;
    std::vector<char> received = std::vector<char>(message_bytes_max);
    std::string sent, error;
    std::size_t size = 0; // of what is received of a message
    bool is_connected = false, is_writing = false, is_reading = false, is_woken = false;
    bool has_message = false, is_told = false; // the message was handed out
    bool is_closing = false, is_done = false;
    error_code outcome; // of what is done
};

ServiceSocket::ServiceSocket(WakeEvent& wake) : link_(std::make_unique<Link>(wake)) {}
ServiceSocket::~ServiceSocket() = default;

std::string ServiceSocket::connect(const ServiceAddress& address, int limit_ms, const std::atomic<bool>& quit)
{
    Link& link = *link_;
    const int64_t until_ns = runtime::monotonic_ns() + int64_t{1'000'000} * limit_ms;
    tcp::socket& socket = link.stream.next_layer();
    error_code ignored;
    link.outcome = asio::error::host_not_found;
    for (const asio::ip::address& one : addresses_of(address.host)) {
        socket.close(ignored);
        socket.async_connect({one, address.port}, link.when_done());
        if (!link.run_until_done(until_ns, &quit))
            return fmt::format("no service answers at {} within {} ms: {}", address.text(), limit_ms, what_to_do);
        if (!link.outcome) break;
    }
    if (link.outcome)
        return fmt::format("no service answers at {} ({}): {}", address.text(), link.outcome.message(), what_to_do);
    socket.set_option(tcp::no_delay(true), ignored);
    link.stream.read_message_max(0); // arm_read() sees to it
    link.stream.auto_fragment(false);
    link.stream.text(true);
    link.stream.async_handshake(address.text(), "/", link.when_done());
    if (!link.run_until_done(until_ns, &quit))
        return fmt::format("what listens at {} does not answer within {} ms: {}", address.text(), limit_ms, what_to_do);
    if (link.outcome)
        return fmt::format("what listens at {} is no WebSocket service ({}): {}", address.text(),
                           words_of(link.outcome), what_to_do);
    link.is_connected = true;
    return "";
}

bool ServiceSocket::send(std::string_view text)
{
    Link& link = *link_;
    if (!link.is_connected || link.is_writing || link.is_closing || !link.error.empty()) return false;
    link.sent.assign(text);
    link.is_writing = true;
    link.stream.async_write(asio::buffer(link.sent), [&link](const error_code& failed, std::size_t) {
        link.is_writing = false;
        if (failed) link.lose(failed);
    });
    return true;
}

// RFC 6455, 5.2: the last frame of a text, and a mask of zeros.
std::string ServiceSocket::frame_of(std::string_view text)
{
    constexpr char last_text = '\x81', masked = '\x80', two_bytes_of_size = 126;
    std::string frame{last_text};
    if (text.size() < 126) {
        frame += static_cast<char>(masked | static_cast<char>(text.size()));
    } else {
        frame += static_cast<char>(masked | two_bytes_of_size);
        frame += static_cast<char>(text.size() >> 8);
        frame += static_cast<char>(text.size() & 0xff);
    }
    frame.append(4, '\0');
    return frame.append(text);
}

int ServiceSocket::file_descriptor() const
{
    return link_->stream.next_layer().native_handle();
}

bool ServiceSocket::is_writing() const
{
    return link_->is_writing;
}

SocketEvent ServiceSocket::wait(int64_t until_ns)
{
    Link& link = *link_;
    if (link.is_told) {
        link.is_told = link.has_message = false;
        link.size = 0;
    }
    for (bool first = true;; first = false) {
        if (link.is_connected && !link.is_reading && !link.has_message && link.error.empty()) link.arm_read();
        if (link.has_message) {
            link.is_told = true;
            return SocketEvent::message;
        }
        if (!link.error.empty()) return SocketEvent::lost;
        if (link.is_woken) {
            link.is_woken = false;
            link.wake.clear();
            link.arm_wake();
            return SocketEvent::woken;
        }
        if (!first && runtime::monotonic_ns() >= until_ns) return SocketEvent::time;
        link.run_some(until_ns);
    }
}

bool ServiceSocket::flush(int64_t until_ns)
{
    Link& link = *link_;
    while (link.is_writing && link.error.empty() && runtime::monotonic_ns() < until_ns)
        link.run_some(std::min(until_ns, runtime::monotonic_ns() + 20'000'000));
    return !link.is_writing && link.error.empty();
}

std::string_view ServiceSocket::message() const
{
    return {link_->received.data(), link_->size};
}

std::string_view ServiceSocket::message_fault() const
{
    const Link& link = *link_;
    if (link.size == link.received.size()) return "it sends a message that is larger than any state";
    return link.stream.got_text() ? std::string_view() : "it sends bytes where text is expected";
}

const std::string& ServiceSocket::error() const
{
    return link_->error;
}

bool ServiceSocket::close(int limit_ms)
{
    Link& link = *link_;
    if (!link.is_connected || link.is_closing || !link.error.empty()) return false;
    link.is_closing = true;
    link.stream.async_close(websocket::close_code::normal, link.when_done());
    const bool is_answered =
        link.run_until_done(runtime::monotonic_ns() + int64_t{1'000'000} * limit_ms) && !link.outcome;
    error_code ignored;
    link.stream.next_layer().close(ignored);
    return is_answered;
}

} // namespace haptel::device
