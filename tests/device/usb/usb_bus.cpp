#include "tests/device/usb/usb_bus.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <dlfcn.h>
#include <filesystem>
#include <fmt/format.h>
#include <map>
#include <mutex>
#include <stdexcept>
#include <sys/ioctl.h>

#include <linux/usbdevice_fs.h>
#include <umockdev.h>

namespace haptel::device {

namespace {

// umockdev ends the program without its preloaded part. Tests are skipped where that is not installed.
const bool is_preloaded = [] {
    if (dlopen("libumockdev-preload.so.0", RTLD_NOLOAD | RTLD_LAZY)) return true;
    std::puts("skipped: run this with LD_PRELOAD=libumockdev-preload.so.0 (package umockdev)");
    std::exit(77);
}();

struct Unref {
    void operator()(UMockdevIoctlData* data) const { umockdev_ioctl_data_unref(data); }
    void operator()(UMockdevIoctlBase* handler) const { g_object_unref(handler); }
    void operator()(UMockdevTestbed* testbed) const { g_object_unref(testbed); }
};
using Data = std::unique_ptr<UMockdevIoctlData, Unref>;

// What an ioctl's argument points to, or a pointer in it.
Data resolve(UMockdevIoctlData* data, std::size_t offset, std::size_t bytes)
{
    return Data(umockdev_ioctl_data_resolve(data, offset, bytes, nullptr));
}

template <typename Value>
Value& value_of(const Data& data)
{
    return *reinterpret_cast<Value*>(data->data);
}

void must(bool done, GError* error)
{
    if (!done) throw std::runtime_error(error ? error->message : "umockdev");
}

// Of one who has the device open.
struct Transfers {
    std::deque<Data> waiting_in, finished;
    std::chrono::steady_clock::time_point next_frame{};
};

} // namespace

struct UsbBus::Testbed {
    std::unique_ptr<UMockdevTestbed, Unref> umockdev{umockdev_testbed_new()};

    std::string root() const
    {
        const std::unique_ptr<char, decltype(&g_free)> path(umockdev_testbed_get_root_dir(umockdev.get()), g_free);
        return path.get();
    }
    void add(const std::string& description)
    {
        GError* error = nullptr;
        must(umockdev_testbed_add_from_string(umockdev.get(), description.c_str(), &error), error);
    }
};

// The kernel's part for one device.
struct UsbBus::Port {
    Port(FakeUsbDevice& plugged, int at, std::string number, std::string driver)
        : device(plugged), address(at), serial(std::move(number)), kernel_driver(std::move(driver))
    {
        g_signal_connect_after(handler.get(), "handle-ioctl", G_CALLBACK(asked), this);
        g_signal_connect_after(handler.get(), "client-vanished", G_CALLBACK(closed), this);
    }

    static gboolean asked(UMockdevIoctlBase*, UMockdevIoctlClient* client, gpointer self)
    {
        Port& port = *static_cast<Port*>(self);
        const std::lock_guard lock(port.mutex);
        const int error = port.serve(client);
        umockdev_ioctl_client_complete(client, error == 0 ? 0 : -1, error);
        return TRUE;
    }
    static void closed(UMockdevIoctlBase*, UMockdevIoctlClient* client, gpointer self)
    {
        Port& port = *static_cast<Port*>(self);
        const std::lock_guard lock(port.mutex);
        port.users.erase(client);
        if (port.holder == client) port.holder = nullptr;
    }

    std::vector<uint8_t> descriptors() const
    {
        std::vector<uint8_t> bytes = device.descriptors();
        if (!serial.empty()) bytes[16] = serial_index;
        return bytes;
    }

    int serve(UMockdevIoctlClient* client);
    int claim(UMockdevIoctlClient* client);
    int submit(Transfers& transfers, UMockdevIoctlData* argument);
    int reap(Transfers& transfers, UMockdevIoctlData* argument);
    bool tell_text(const UsbSetup& setup, std::span<uint8_t> data, std::size_t& size) const;

    static constexpr uint8_t serial_index = 3;
    FakeUsbDevice& device;
    const int address;
    const std::string serial, kernel_driver;
    std::unique_ptr<UMockdevIoctlBase, Unref> handler{umockdev_ioctl_base_new()};
    std::mutex mutex;
    bool is_gone = false;
    bool is_detached = false;              // from the kernel's driver
    UMockdevIoctlClient* holder = nullptr; // of the interfaces
    std::map<UMockdevIoctlClient*, Transfers> users;
};

int UsbBus::Port::serve(UMockdevIoctlClient* client)
{
    if (is_gone) return ENODEV;
    UMockdevIoctlData* argument = umockdev_ioctl_client_get_arg(client);
    Transfers& transfers = users[client];
    switch (umockdev_ioctl_client_get_request(client)) {
    case USBDEVFS_GET_CAPABILITIES:
        value_of<uint32_t>(resolve(argument, 0, sizeof(uint32_t))) =
            USBDEVFS_CAP_ZERO_PACKET | USBDEVFS_CAP_NO_PACKET_SIZE_LIM | USBDEVFS_CAP_REAP_AFTER_DISCONNECT;
        return 0;
    case USBDEVFS_GETDRIVER: {
        if (!holder && (is_detached || kernel_driver.empty())) return ENODATA;
        auto& answer = value_of<usbdevfs_getdriver>(resolve(argument, 0, sizeof(usbdevfs_getdriver)));
        std::snprintf(answer.driver, sizeof answer.driver, "%s", holder ? "usbfs" : kernel_driver.c_str());
        return 0;
    }
    case USBDEVFS_CLAIMINTERFACE: return kernel_driver.empty() || is_detached ? claim(client) : EBUSY;
    case USBDEVFS_DISCONNECT_CLAIM: {
        const int error = claim(client);
        is_detached = is_detached || error == 0;
        return error;
    }
    case USBDEVFS_RELEASEINTERFACE:
        if (holder == client) holder = nullptr;
        return 0;
    case USBDEVFS_IOCTL: is_detached = false; return 0; // USBDEVFS_CONNECT, which libusb asks for when it releases
    case USBDEVFS_SUBMITURB: return submit(transfers, argument);
    case USBDEVFS_DISCARDURB: {
        const auto urb = *reinterpret_cast<const unsigned long*>(argument->data);
        const auto found =
            std::ranges::find_if(transfers.waiting_in, [&](auto& each) { return each->client_addr == urb; });
        if (found == transfers.waiting_in.end()) return EINVAL;
        value_of<usbdevfs_urb>(*found).status = -ENOENT;
        transfers.finished.push_back(std::move(*found));
        transfers.waiting_in.erase(found);
        return 0;
    }
    case USBDEVFS_REAPURBNDELAY: return reap(transfers, argument);
    default: return ENOTTY;
    }
}

int UsbBus::Port::claim(UMockdevIoctlClient* client)
{
    if (holder && holder != client) return EBUSY;
    holder = client;
    return 0;
}

// GET_DESCRIPTOR of a string (USB 2.0, section 9.6.7): the languages, and the serial number.
bool UsbBus::Port::tell_text(const UsbSetup& setup, std::span<uint8_t> data, std::size_t& size) const
{
    if (setup.type != 0x80 || setup.request != 6 || setup.value >> 8 != 3 || serial.empty()) return false;
    std::vector<uint8_t> text = {4, 3, 0x09, 0x04};
    if ((setup.value & 0xff) == serial_index) {
        text = {static_cast<uint8_t>(2 + 2 * serial.size()), 3};
        for (const char letter : serial) text.insert(text.end(), {static_cast<uint8_t>(letter), 0});
    }
    size = std::min(text.size(), data.size());
    std::copy_n(text.begin(), size, data.begin());
    return true;
}

int UsbBus::Port::submit(Transfers& transfers, UMockdevIoctlData* argument)
{
    Data data = resolve(argument, 0, sizeof(usbdevfs_urb));
    auto& urb = value_of<usbdevfs_urb>(data);
    const auto length = static_cast<std::size_t>(urb.buffer_length);
    if (length > 0) resolve(data.get(), offsetof(usbdevfs_urb, buffer), length);
    const std::span bytes(static_cast<uint8_t*>(urb.buffer), length);
    if (urb.type != USBDEVFS_URB_TYPE_CONTROL && (urb.endpoint & 0x80)) {
        transfers.waiting_in.push_back(std::move(data));
        return 0;
    }
    FakeUsbDevice::Answer answer = FakeUsbDevice::Answer::fine;
    std::size_t size = length;
    if (urb.type == USBDEVFS_URB_TYPE_CONTROL) {
        const auto word = [&](std::size_t at) { return static_cast<uint16_t>(bytes[at] | bytes[at + 1] << 8); };
        const UsbSetup setup{bytes[0], bytes[1], word(2), word(4)};
        size = length - 8;
        if (!tell_text(setup, bytes.subspan(8), size)) answer = device.control(setup, bytes.subspan(8), size);
    } else {
        answer = device.out(bytes);
    }
    urb.actual_length = answer == FakeUsbDevice::Answer::fine ? static_cast<int>(size) : 0;
    urb.status = answer == FakeUsbDevice::Answer::fine ? 0 : -EPIPE;
    transfers.finished.push_back(std::move(data));
    return 0;
}

// An IN transfer completes once in each frame of a millisecond.
int UsbBus::Port::reap(Transfers& transfers, UMockdevIoctlData* argument)
{
    const auto now = std::chrono::steady_clock::now();
    if (transfers.finished.empty() && !transfers.waiting_in.empty() && now >= transfers.next_frame) {
        transfers.next_frame = now + std::chrono::milliseconds(1);
        auto& urb = value_of<usbdevfs_urb>(transfers.waiting_in.front());
        std::size_t size = 0;
        const FakeUsbDevice::Answer answer =
            device.in({static_cast<uint8_t*>(urb.buffer), static_cast<std::size_t>(urb.buffer_length)}, size);
        if (answer != FakeUsbDevice::Answer::nothing) {
            urb.actual_length = static_cast<int>(size);
            urb.status = answer == FakeUsbDevice::Answer::fine ? 0 : -EPIPE;
            transfers.finished.push_back(std::move(transfers.waiting_in.front()));
            transfers.waiting_in.pop_front();
        }
    }
    if (transfers.finished.empty()) return EAGAIN;
    const Data pointer = resolve(argument, 0, sizeof(void*));
    umockdev_ioctl_data_set_ptr(pointer.get(), 0, transfers.finished.front().get());
    transfers.finished.pop_front();
    return 0;
}

UsbBus::UsbBus() : testbed_(std::make_unique<Testbed>())
{
    testbed_->add(
        "P: /devices/usb1\nN: bus/usb/001/001\nE: SUBSYSTEM=usb\nE: DEVTYPE=usb_device\n"
        "E: DEVNAME=/dev/bus/usb/001/001\nE: BUSNUM=001\nE: DEVNUM=001\n"
        "A: busnum=1\\n\nA: devnum=1\\n\nA: speed=480\\n\nA: bConfigurationValue=1\\n\n"
        "H: descriptors=12010002090001406b1d020001060302010109021900010100e0000904000001090000000705810304000c\n");
}

UsbBus::~UsbBus() = default;

std::string UsbBus::folder_of(int address) const
{
    return fmt::format("/devices/usb1/1-{}", address);
}

std::string UsbBus::node_of(int address) const
{
    return fmt::format("/dev/bus/usb/001/{:03}", address);
}

UsbBus::Port& UsbBus::port(int address) const
{
    return **std::ranges::find_if(ports_, [&](const auto& each) { return each->address == address; });
}

void UsbBus::plug(FakeUsbDevice& device, int address, std::string serial, std::string kernel_driver)
{
    const Port& plugged =
        *ports_.emplace_back(std::make_unique<Port>(device, address, std::move(serial), std::move(kernel_driver)));
    GError* error = nullptr;
    must(umockdev_testbed_attach_ioctl(testbed_->umockdev.get(), node_of(address).c_str(), plugged.handler.get(),
                                       &error),
         error);
    std::string hex;
    for (const uint8_t byte : plugged.descriptors()) hex += fmt::format("{:02x}", byte);
    testbed_->add(fmt::format("P: {0}\nN: {1}\nE: SUBSYSTEM=usb\nE: DEVTYPE=usb_device\nE: DEVNAME=/dev/{1}\n"
                              "E: BUSNUM=001\nE: DEVNUM={2:03}\nA: busnum=1\\n\nA: devnum={2}\\n\nA: speed=12\\n\n"
                              "A: bConfigurationValue=1\\n\nH: descriptors={3}\n",
                              folder_of(address), node_of(address).substr(5), address, hex));
}

void UsbBus::unplug(int address)
{
    {
        Port& pulled = port(address);
        const std::lock_guard lock(pulled.mutex);
        pulled.is_gone = true;
    }
    umockdev_testbed_remove_device(testbed_->umockdev.get(), ("/sys" + folder_of(address)).c_str());
    std::filesystem::remove(testbed_->root() + node_of(address));
}

void UsbBus::forbid(int address)
{
    std::filesystem::permissions(testbed_->root() + node_of(address), std::filesystem::perms::none);
}

bool UsbBus::is_held(int address) const
{
    Port& asked = port(address);
    const std::lock_guard lock(asked.mutex);
    return asked.holder != nullptr;
}

bool UsbBus::kernel_has(int address) const
{
    Port& asked = port(address);
    const std::lock_guard lock(asked.mutex);
    return !asked.kernel_driver.empty() && !asked.is_detached;
}

} // namespace haptel::device
