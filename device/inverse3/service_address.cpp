#include "device/inverse3/service_socket.h"

#include <algorithm>
#include <arpa/inet.h>
#include <array>
#include <charconv>
#include <fmt/format.h>

namespace haptel::device {

namespace {

bool is_ip_address(const std::string& host)
{
    std::array<unsigned char, sizeof(in6_addr)> bytes{};
    return inet_pton(AF_INET, host.c_str(), bytes.data()) == 1 || inet_pton(AF_INET6, host.c_str(), bytes.data()) == 1;
}

} // namespace

std::string ServiceAddress::text() const
{
    return host.find(':') == std::string::npos ? fmt::format("{}:{}", host, port) : fmt::format("[{}]:{}", host, port);
}

ServiceAddressText read_service_address(std::string_view text)
{
    ServiceAddressText read;
    std::string_view host = text, port;
    const auto bracket = text.find(']');
    if (text.starts_with('[') && bracket != text.npos) {
        host = text.substr(1, bracket - 1);
        port = text.substr(bracket + 1);
    } else if (std::count(text.begin(), text.end(), ':') == 1) { // more of them: an IPv6 address alone
        host = text.substr(0, text.find(':'));
        port = text.substr(text.find(':'));
    }
    if (!host.empty()) read.address.host = host;
    if (read.address.host != "localhost" && !is_ip_address(read.address.host))
        read.error = fmt::format("the place of the Inverse3 service is localhost or an IP address, as in "
                                 "HAPTEL_INVERSE3_SERVICE=192.168.1.5:10001, found '{}'",
                                 host.substr(0, 64));
    if (port.empty()) return read;
    const auto [end, error] = std::from_chars(port.data() + 1, port.data() + port.size(), read.address.port);
    if (port.front() != ':' || error != std::errc() || end != port.data() + port.size() || read.address.port == 0)
        read.error = fmt::format("the port of the Inverse3 service is a number from 1 to 65535, as in "
                                 "HAPTEL_INVERSE3_SERVICE=localhost:10001, found '{}'",
                                 port.substr(0, 64));
    return read;
}

} // namespace haptel::device
