#include "tests/device/usb/usbip_port.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <fstream>
#include <poll.h>
#include <stdexcept>
#include <sys/socket.h>
#include <system_error>
#include <unistd.h>

namespace haptel::device {

namespace {

namespace fs = std::filesystem;
using BusTime = std::chrono::steady_clock;

constexpr const char* attach_file = "/sys/devices/platform/vhci_hcd.0/attach";
constexpr const char* status_file = "/sys/devices/platform/vhci_hcd.0/status";
constexpr int full_speed = 2; // enum usb_device_speed

// Where the numbers of a header are.
enum : std::size_t {
    command,
    sequence,
    device_number,
    direction,
    endpoint,
    flags,
    length,
    start_frame,
    packets,
    interval
};
constexpr std::size_t status = flags, unlinked = flags, setup_byte = 40;
constexpr uint32_t submit = 1, unlink_request = 2, submitted = 3, unlink_answer = 4;

template <typename Happens>
void wait_until(const std::string& what, Happens happens)
{
    const auto deadline = BusTime::now() + std::chrono::seconds(20);
    while (!happens()) {
        if (BusTime::now() > deadline) throw std::runtime_error("waited 20 s in vain until " + what);
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
}

std::string first_word(const fs::path& file)
{
    std::string word;
    std::ifstream(file) >> word;
    return word;
}

// Lines of "hs PORT STATE ...", where state 4 is a port that nothing is plugged into.
std::string free_port()
{
    std::ifstream lines(status_file);
    std::string hub, port, state, rest;
    while (lines >> hub >> port >> state && std::getline(lines, rest))
        if (hub == "hs" && state == "004") return port;
    throw std::runtime_error("no port of vhci_hcd is free");
}

fs::path device_of_serial(const std::string& serial)
{
    for (const fs::directory_entry& entry : fs::directory_iterator("/sys/bus/usb/devices"))
        if (first_word(entry.path() / "serial") == serial) return entry.path();
    return {};
}

bool has_file(const fs::path& in_sysfs)
{
    const auto three_digits = [](const std::string& number) { return ("000" + number).substr(number.size()); };
    const std::string bus = first_word(in_sysfs / "busnum"), number = first_word(in_sysfs / "devnum");
    return fs::exists("/dev/bus/usb/" + three_digits(bus) + "/" + three_digits(number));
}

uint32_t status_of(FakeUsbDevice::Answer answer)
{
    return answer == FakeUsbDevice::Answer::stall ? static_cast<uint32_t>(-EPIPE) : 0;
}

} // namespace

std::string UsbipPort::missing()
{
    if (access(attach_file, W_OK) == 0) return {};
    const std::string found = std::strerror(errno);
    return std::string("expected a file that root may write, ") + attach_file + ", found: " + found +
           ". Run `modprobe vhci-hcd` and this as root, or in a machine that has it: ./dev test --vm";
}

uint32_t UsbipPort::Header::number(std::size_t at) const
{
    const uint8_t* b = bytes.data() + 4 * at;
    return static_cast<uint32_t>(b[0]) << 24 | static_cast<uint32_t>(b[1]) << 16 | static_cast<uint32_t>(b[2]) << 8 |
           b[3];
}

void UsbipPort::Header::put(std::size_t at, uint32_t number)
{
    for (std::size_t i = 0; i < 4; ++i) bytes[4 * at + i] = static_cast<uint8_t>(number >> (24 - 8 * i));
}

UsbipPort::UsbipPort(FakeUsbDevice& device, std::string serial) : device_(device), serial_(std::move(serial))
{
    try {
        plug_in();
    } catch (...) {
        unplug();
        throw;
    }
}

UsbipPort::~UsbipPort()
{
    unplug();
}

std::string UsbipPort::kernel_driver(int interface) const
{
    std::error_code none;
    return fs::read_symlink(in_sysfs_.string() + ":1." + std::to_string(interface) + "/driver", none).filename();
}

void UsbipPort::plug_in()
{
    std::array<int, 2> ends{};
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0)
        throw std::system_error(errno, std::generic_category(), "socketpair");
    socket_ = ends[0];
    thread_ = std::thread([this] { run(); });
    const std::string port = free_port();
    std::ofstream file(attach_file);
    file << port << ' ' << ends[1] << ' ' << 1 + std::stoi(port) << ' ' << full_speed << std::flush;
    close(ends[1]); // the kernel has its own
    if (!file) throw std::runtime_error("vhci_hcd does not take the device on port " + port);
    wait_until("the kernel lists the device " + serial_, [&] {
        in_sysfs_ = device_of_serial(serial_);
        return !in_sysfs_.empty();
    });
    wait_until("the kernel has configured " + in_sysfs_.string(),
               [&] { return first_word(in_sysfs_ / "bConfigurationValue") == "1" && has_file(in_sysfs_); });
}

void UsbipPort::unplug()
{
    shutdown(socket_, SHUT_RDWR);
    if (thread_.joinable()) thread_.join();
    close(socket_);
    const auto deadline = BusTime::now() + std::chrono::seconds(20);
    while (fs::exists(in_sysfs_) && BusTime::now() < deadline)
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

// One millisecond is one frame. If this thread was late, the frames that went by are made up for.
void UsbipPort::run()
{
    constexpr auto frame = std::chrono::milliseconds(1);
    for (auto next = BusTime::now() + frame;;) {
        const auto left = std::chrono::ceil<std::chrono::nanoseconds>(next - BusTime::now()).count();
        const timespec wait{0, std::max<long>(left, 0)};
        pollfd cable{socket_, POLLIN, 0};
        if (ppoll(&cable, 1, &wait, nullptr) > 0 && !hear()) break;
        for (; BusTime::now() >= next; next += frame)
            if (!next_frame()) return;
    }
}

bool UsbipPort::hear()
{
    Transfer heard;
    if (!receive(heard.asked.bytes)) return false;
    if (heard.asked.number(command) == unlink_request) return unlink(heard.asked);
    if (heard.asked.number(command) != submit) return false;
    const bool in = heard.asked.number(direction) == 1;
    heard.data.resize(heard.asked.number(length));
    if (!in && !receive(heard.data)) return false;
    if (heard.asked.number(endpoint) == 0) {
        std::size_t size = 0;
        const Answer answer = control(heard.asked, heard.data, size);
        return complete(heard, answer, size);
    }
    if (in) return waiting_in_.push_back(std::move(heard)), true;
    if (heard.asked.number(interval) != 0) return waiting_out_.push_back(std::move(heard)), true;
    return complete(heard, device_.out(heard.data), heard.data.size());
}

bool UsbipPort::next_frame()
{
    if (!waiting_out_.empty()) {
        Transfer transfer = std::move(waiting_out_.front());
        waiting_out_.pop_front();
        if (!complete(transfer, device_.out(transfer.data), transfer.data.size())) return false;
    }
    if (waiting_in_.empty()) return true;
    std::size_t size = 0;
    const Answer answer = device_.in(waiting_in_.front().data, size);
    if (answer == Answer::nothing) return true;
    Transfer transfer = std::move(waiting_in_.front());
    waiting_in_.pop_front();
    return complete(transfer, answer, size);
}

// What was given back already is not to be found here, and the kernel knows by the status 0.
bool UsbipPort::unlink(const Header& asked)
{
    std::size_t found = 0;
    for (auto* queue : {&waiting_in_, &waiting_out_})
        found += std::erase_if(
            *queue, [&](const Transfer& each) { return each.asked.number(sequence) == asked.number(unlinked); });
    Header answer;
    answer.put(command, unlink_answer);
    answer.put(sequence, asked.number(sequence));
    answer.put(status, found ? static_cast<uint32_t>(-ECONNRESET) : 0);
    return send(answer, {});
}

bool UsbipPort::complete(Transfer& transfer, Answer answer, std::size_t size)
{
    if (answer == Answer::gone) {
        shutdown(socket_, SHUT_RDWR);
        return false;
    }
    if (answer != Answer::fine) size = 0;
    Header header;
    header.put(command, submitted);
    header.put(sequence, transfer.asked.number(sequence));
    header.put(status, status_of(answer));
    header.put(length, static_cast<uint32_t>(size));
    const bool in = transfer.asked.number(direction) == 1;
    return send(header, std::span(transfer.data).first(in ? size : 0));
}

bool UsbipPort::send(const Header& header, std::span<const uint8_t> data)
{
    std::vector<uint8_t> bytes(header.bytes.begin(), header.bytes.end());
    bytes.insert(bytes.end(), data.begin(), data.end());
    return ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(bytes.size());
}

bool UsbipPort::receive(std::span<uint8_t> bytes)
{
    return bytes.empty() || // what would wait for the next header
           recv(socket_, bytes.data(), bytes.size(), MSG_WAITALL) == static_cast<ssize_t>(bytes.size());
}

// Standard requests (USB 2.0, section 9.4) are answered here, as what makes up a device's controller does. The address
// is the hub's affair.
UsbipPort::Answer UsbipPort::control(const Header& asked, std::span<uint8_t> data, std::size_t& size)
{
    constexpr uint8_t get_status = 0, clear_feature = 1, get_descriptor = 6, get_configuration = 8,
                      set_configuration = 9, set_interface = 11;
    constexpr uint8_t set_idle = 10; // of HID: to say nothing while nothing changes
    const uint8_t* setup = asked.bytes.data() + setup_byte;
    const auto word = [&](int at) { return static_cast<uint16_t>(setup[at] | setup[at + 1] << 8); };
    const uint8_t type = setup[0], request = setup[1];
    const auto give = [&](const std::vector<uint8_t>& bytes) {
        size = std::min(bytes.size(), data.size());
        std::copy_n(bytes.begin(), size, data.begin());
        return bytes.empty() ? Answer::stall : Answer::fine;
    };
    const bool standard = (type & 0x60) == 0, to_device = !(type & 0x80);
    if (standard && to_device && (request == set_configuration || request == set_interface || request == clear_feature))
        return Answer::fine;
    if (type == 0x21 && request == set_idle) return Answer::fine;
    if (type == 0x80 && request == get_descriptor) return give(descriptor(setup[3], setup[2]));
    if (type == 0x80 && request == get_configuration) return give({1});
    if (standard && !to_device && request == get_status) return give({0, 0});
    return device_.control({type, request, word(2), word(4)}, data, size);
}

std::vector<uint8_t> UsbipPort::descriptor(unsigned kind, unsigned index) const
{
    constexpr std::size_t device_bytes = 18, serial_index_byte = 16;
    std::vector<uint8_t> all = device_.descriptors();
    if (kind == 1) {
        all.resize(device_bytes);
        all[serial_index_byte] = 1;
        return all;
    }
    if (kind == 2 && index == 0) return {all.begin() + device_bytes, all.end()};
    if (kind != 3 || index > 1) return {};
    std::vector<uint8_t> text = {0, 3};
    if (index == 0) text.insert(text.end(), {0x09, 0x04}); // American English
    for (const char letter : index == 0 ? std::string() : serial_)
        text.insert(text.end(), {static_cast<uint8_t>(letter), 0});
    text[0] = static_cast<uint8_t>(text.size());
    return text;
}

} // namespace haptel::device
