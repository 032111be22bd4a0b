#include "tools/control/osc_server.h"

#include <arpa/inet.h>
#include <cerrno>
#include <cstring>
#include <fmt/format.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

namespace haptel::tools {

namespace {

// In one call, so that a flood of messages leaves time for what else there is to do.
constexpr int datagrams_at_once = 16;

union Address {
    sockaddr any;
    sockaddr_in v4;
    sockaddr_in6 v6;
};

Address loopback(int family, uint16_t port)
{
    Address address{};
    address.any.sa_family = static_cast<sa_family_t>(family);
    if (family == AF_INET) {
        address.v4.sin_port = htons(port);
        address.v4.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    } else {
        address.v6.sin6_port = htons(port);
        address.v6.sin6_addr = in6addr_loopback;
    }
    return address;
}

constexpr socklen_t size_of(int family)
{
    return family == AF_INET ? sizeof(sockaddr_in) : sizeof(sockaddr_in6);
}

constexpr int family_of(int via)
{
    return via == 0 ? AF_INET : AF_INET6;
}

uint16_t port_of(const Address& address)
{
    return ntohs(address.any.sa_family == AF_INET ? address.v4.sin_port : address.v6.sin6_port);
}

} // namespace

OscServer::OscServer(uint16_t port, Controlled& controlled) : control_(controlled), port_(port)
{
    std::string failed;
    if (!listen_on(AF_INET, failed)) {
        error_ = fmt::format("cannot listen on port {} of 127.0.0.1: {}; choose another port", port, failed);
        return;
    }
    if (!listen_on(AF_INET6, failed) && errno == EADDRINUSE)
        error_ = fmt::format("cannot listen on port {} of ::1: {}; choose another port", port_, failed);
}

OscServer::~OscServer()
{
    for (const int socket : sockets_)
        if (socket >= 0) close(socket);
}

// On a port that the system chooses, the first says which.
bool OscServer::listen_on(int family, std::string& failed)
{
    const int made = socket(family, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    const int only_v6 = 1;
    if (made >= 0 && family == AF_INET6) setsockopt(made, IPPROTO_IPV6, IPV6_V6ONLY, &only_v6, sizeof only_v6);
    Address address = loopback(family, port_);
    socklen_t size = size_of(family);
    if (made < 0 || bind(made, &address.any, size) != 0 || getsockname(made, &address.any, &size) != 0) {
        const int why = errno;
        failed = std::strerror(why);
        if (made >= 0) close(made);
        errno = why;
        return false;
    }
    port_ = port_of(address);
    sockets_[family == AF_INET ? 0 : 1] = made;
    return true;
}

std::vector<std::string> OscServer::bound_addresses() const
{
    std::vector<std::string> names;
    for (const int socket : sockets_) {
        Address address{};
        socklen_t size = sizeof address;
        char text[INET6_ADDRSTRLEN] = "";
        if (socket < 0 || getsockname(socket, &address.any, &size) != 0) continue;
        const bool is_v4 = address.any.sa_family == AF_INET;
        const void* const bytes = is_v4 ? static_cast<const void*>(&address.v4.sin_addr) : &address.v6.sin6_addr;
        inet_ntop(address.any.sa_family, bytes, text, sizeof text);
        names.push_back(is_v4 ? fmt::format("{}:{}", text, port_of(address))
                              : fmt::format("[{}]:{}", text, port_of(address)));
    }
    return names;
}

void OscServer::wait(std::chrono::milliseconds at_most) const
{
    pollfd descriptors[] = {{sockets_[0], POLLIN, 0}, {sockets_[1], POLLIN, 0}};
    poll(descriptors, std::size(descriptors), static_cast<int>(at_most.count()));
}

void OscServer::serve()
{
    std::array<char, osc_bytes_max + 1> bytes; // one more shows that there was more
    const auto now = OscControl::Clock::now();
    for (int via = 0; via < 2; ++via)
        for (int left = sockets_[static_cast<std::size_t>(via)] >= 0 ? datagrams_at_once : 0; left > 0; --left) {
            Address from{};
            socklen_t size = sizeof from;
            const ssize_t count =
                recvfrom(sockets_[static_cast<std::size_t>(via)], bytes.data(), bytes.size(), 0, &from.any, &size);
            if (count < 0) break;
            if (port_of(from) == port_) continue; // its own, or a forger's: answers would come back for ever
            send(control_.take({bytes.data(), static_cast<std::size_t>(count)}, {via, port_of(from)}, now));
        }
    send(control_.state(now));
}

void OscServer::tell(const std::string& text)
{
    send(control_.tell(text));
}

void OscServer::end(const std::string& why)
{
    send(control_.end(why));
}

// What a peer has no room for is lost, as datagrams are.
void OscServer::send(const std::vector<OscDatagram>& datagrams) const
{
    for (const OscDatagram& datagram : datagrams) {
        const int family = family_of(datagram.to.via);
        const Address to = loopback(family, datagram.to.port);
        sendto(sockets_[static_cast<std::size_t>(datagram.to.via)], datagram.bytes.data(), datagram.bytes.size(),
               MSG_NOSIGNAL, &to.any, size_of(family));
    }
}

} // namespace haptel::tools
