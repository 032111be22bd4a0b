#include "device/hid/pid_axes.h"

#include "runtime/servo/real_time.h"

#include <algorithm>
#include <chrono>
#include <fmt/format.h>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

namespace haptel::device {

namespace {

constexpr int64_t ns_per_ms = 1'000'000;

constexpr const char* plug_in_again = ". Unplug it and plug it in again";

// Requests: to the device and to an interface of it.
constexpr uint8_t from_device = 0x80, from_interface = 0x81, get_descriptor = 6;
constexpr uint8_t to_class = 0x21, from_class = 0xa1, set_report = 9, get_report = 1;
constexpr uint16_t configuration_descriptor = 0x0200, report_descriptor = 0x2200;

class PidAxes final : public AxisPort {
public:
    PidAxes(std::unique_ptr<Transport> transport, const HidInterface& at, const PidReports& reports,
            const PidTimes& times)
        : transport_(std::move(transport)), at_(at), reports_(reports), times_(times)
    {
    }

    std::optional<AxisRange> axis(int number) const override
    {
        return number < reports_.axes() ? std::optional(reports_.range(number)) : std::nullopt;
    }

    std::string serve(WakeEvent& wake, AxisClient& client) override
    {
        const Silence silence{*this}; // however this ends
        const std::string why = bring_up(client);
        if (!why.empty()) return "the device cannot be used: " + why + plug_in_again;
        Stream stream(*this, client);
        const UsbError error = client.wants_more() ? transport_->stream(settings(), wake, stream) : UsbError::cancelled;
        if (stream.is_deaf()) return "the device was lost: it takes no forces any longer";
        return error == UsbError::cancelled ? "" : fmt::format("the device was lost: {}", words_of(error));
    }

private:
    struct Silence {
        PidAxes& axes;
        explicit Silence(PidAxes& of) : axes(of) {}
        Silence(const Silence&) = delete;
        Silence& operator=(const Silence&) = delete;
        ~Silence() { axes.silence(); }
    };

    // Between the driver and the transfers. The effects hold what they heard last.
    class Stream final : public StreamClient {
    public:
        Stream(PidAxes& axes, AxisClient& client)
            : axes_(axes), client_(client), replay_ns_(runtime::monotonic_ns() + ns_per_ms * axes.times_.replay_ms)
        {
        }

        void received(std::span<const uint8_t> bytes) noexcept override
        {
            for (int i = 0; i < axes_.reports_.axes(); ++i)
                if (const auto place = axes_.reports_.place(i, bytes)) client_.moved(i, *place);
        }

        std::size_t next_out(std::span<uint8_t> room) noexcept override
        {
            if (std::exchange(in_flight_, false)) {
                failures_ = 0;
                disabled_ = disabled_ && !enabling_;
            }
            enabling_ = disabled_;
            if (disabled_) return put(axes_.reports_.control(PidControl::enable_actuators), room);
            const AxisLevels wanted = client_.levels();
            const auto count = static_cast<std::size_t>(axes_.reports_.axes());
            for (std::size_t i = 0; i < count; ++i) { // in turns
                const std::size_t axis = (last_ + 1 + i) % count;
                const int64_t counts = axes_.reports_.level_counts(wanted[axis]);
                if (counts == sent_[axis]) continue;
                last_ = axis;
                sent_[axis] = counts;
                return put(axes_.reports_.constant_force(axes_.blocks_[axis], wanted[axis]), room);
            }
            const int64_t now_ns = runtime::monotonic_ns();
            if (now_ns < replay_ns_) return 0;
            const std::size_t axis = replays_++ % count;
            if (axis + 1 == count) replay_ns_ = now_ns + ns_per_ms * axes_.times_.replay_ms;
            return put(axes_.reports_.start(axes_.blocks_[axis]), room);
        }

        void out_failed() noexcept override
        {
            sent_[last_].reset();
            in_flight_ = false;
            ++failures_;
        }
        // One that takes nothing may go on telling its place, under the force that it heard last.
        bool is_deaf() const noexcept { return failures_ >= failures_max; }
        bool wants_more() noexcept override { return client_.wants_more() && !is_deaf(); }

        std::size_t last_word(std::span<uint8_t> room) noexcept override
        {
            const PidReport report = axes_.reports_.control(PidControl::stop_all);
            if (report.kind != HidKind::output || report.size > room.size()) return 0;
            std::ranges::copy(report.span(), room.begin());
            return report.size;
        }
        void was_silenced() noexcept override
        {
            client_.was_silenced();
            sent_ = {};
            replays_ = 0;
            replay_ns_ = 0;
            disabled_ = true; // to some devices to stop all effects is to disable the motors
        }

    private:
        static constexpr int failures_max = 4; // reports in a row, of at most a tenth of a second each

        std::size_t put(const PidReport& report, std::span<uint8_t> room) noexcept
        {
            if (report.size > room.size()) return 0;
            std::ranges::copy(report.span(), room.begin());
            in_flight_ = true;
            return report.size;
        }

        PidAxes& axes_;
        AxisClient& client_;
        std::array<std::optional<int64_t>, axes_max> sent_; // nothing: not known what it has heard
        std::size_t last_ = 0, replays_ = 0;
        bool disabled_ = false, enabling_ = false;
        bool in_flight_ = false; // or has arrived, if nothing was said since
        int failures_ = 0;       // of reports, in a row
        int64_t replay_ns_;
    };

    StreamSettings settings() const
    {
        StreamSettings settings;
        settings.in_endpoint = at_.in_endpoint;
        settings.out_endpoint = at_.out_endpoint;
        const std::size_t packet = std::max<std::size_t>(at_.packet_bytes, 1);
        settings.in_bytes = (std::max<std::size_t>(reports_.input_bytes(), 1) + packet - 1) / packet * packet;
        settings.out_bytes = sizeof(PidReport::bytes);
        return settings;
    }

    uint16_t report_of(const PidReport& report) const
    {
        return static_cast<uint16_t>(static_cast<unsigned>(report.kind) << 8 | report.id);
    }

    // Why it could not be sent.
    std::string send(PidReport report, const char* name)
    {
        const Transferred sent =
            report.kind == HidKind::output
                ? transport_->out(at_.out_endpoint, report.span(), times_.transfer_ms)
                : transport_->control({to_class, set_report, report_of(report), static_cast<uint16_t>(at_.number)},
                                      {report.bytes.data(), report.size}, times_.transfer_ms);
        if (sent.error != UsbError::none) return fmt::format("{}: {}", name, words_of(sent.error));
        return sent.bytes == report.size ? "" : fmt::format("{}: it took a part of it", name);
    }

    std::string bring_up(AxisClient& client)
    {
        std::string why = send(reports_.control(PidControl::reset), "Device Reset");
        if (why.empty()) why = send(reports_.control(PidControl::enable_actuators), "Enable Actuators");
        if (const auto gain = reports_.full_gain(); gain && why.empty()) why = send(*gain, "Device Gain");
        for (int i = 0; i < reports_.axes() && why.empty() && client.wants_more(); ++i) why = make_effect(i, client);
        return why;
    }

    std::string make_effect(int axis, AxisClient& client)
    {
        uint8_t& block = blocks_[static_cast<std::size_t>(axis)];
        block = 0;
        std::string why = send(reports_.new_constant_force(), "Create New Effect");
        if (why.empty()) why = wait_for_block(block, client);
        if (!why.empty() || block == 0) return why;
        why = send(reports_.endless_effect(block, axis), "Set Effect");
        if (why.empty()) why = send(reports_.constant_force(block, 0), "Set Constant Force");
        if (why.empty()) why = send(reports_.start(block), "Effect Operation");
        return why;
    }

    std::string wait_for_block(uint8_t& index, AxisClient& client)
    {
        const int64_t until_ns = runtime::monotonic_ns() + ns_per_ms * times_.load_ms;
        std::string why = "Block Load: it makes no room for an effect";
        while (client.wants_more()) {
            PidReport answer = reports_.ask_block();
            const std::span<uint8_t> bytes(answer.bytes.data(), answer.size);
            const Transferred got =
                transport_->control({from_class, get_report, report_of(answer), static_cast<uint16_t>(at_.number)},
                                    bytes, times_.transfer_ms);
            if (got.error == UsbError::none) {
                const PidBlock block = reports_.block(bytes.first(std::min(got.bytes, bytes.size())));
                if (block.loaded == PidLoaded::full) return "Block Load: it has no room for an effect";
                if (block.loaded == PidLoaded::failed) return "Block Load: it made no effect";
                index = block.index;
                if (block.loaded == PidLoaded::yes) return "";
            } else {
                why = fmt::format("Block Load: {}", words_of(got.error));
                if (got.error == UsbError::gone) return why;
            }
            if (runtime::monotonic_ns() > until_ns) return why;
            std::this_thread::sleep_for(std::chrono::milliseconds(times_.poll_ms));
        }
        return "";
    }

    // As far as the device hears. One report that is lost is said in another way by the next.
    void silence() noexcept
    {
        const auto tell = [&](const PidReport& report) {
            return transport_->out(at_.out_endpoint, report.span(), times_.transfer_ms).error != UsbError::gone;
        };
        for (uint8_t& block : blocks_)
            if (block != 0 && !tell(reports_.constant_force(std::exchange(block, uint8_t{0}), 0))) return;
        tell(reports_.control(PidControl::stop_all));
    }

    std::unique_ptr<Transport> transport_;
    HidInterface at_;
    PidReports reports_;
    PidTimes times_;
    std::array<uint8_t, axes_max> blocks_{}; // of the effects; 0: none
};

// Nothing: `why`.
std::optional<std::vector<uint8_t>> read_descriptor(Transport& transport, const ControlRequest& request,
                                                    std::size_t bytes, int timeout_ms, std::string& why)
{
    std::vector<uint8_t> read(bytes);
    const Transferred got = transport.control(request, read, timeout_ms);
    if (got.error != UsbError::none) {
        why = fmt::format("the device does not say what it is: {}{}", words_of(got.error), plug_in_again);
        return std::nullopt;
    }
    read.resize(std::min(got.bytes, bytes));
    return read;
}

OpenedAxes not_usable(std::string why)
{
    return {nullptr, std::move(why), true};
}

} // namespace

std::unique_ptr<AxisPort> make_pid_axes(std::unique_ptr<Transport> transport, const HidInterface& at,
                                        const PidReports& reports, const PidTimes& times)
{
    return std::make_unique<PidAxes>(std::move(transport), at, reports, times);
}

OpenedAxes open_pid_axes(const OpenInterface& open, int first, const PidTimes& times)
{
    OpenedTransport opened = open(first);
    if (!opened.transport) return not_usable(std::move(opened.error));
    std::string why;
    const auto configuration = read_descriptor(
        *opened.transport, {from_device, get_descriptor, configuration_descriptor, 0}, 4096, times.transfer_ms, why);
    if (!configuration) return not_usable(std::move(why));
    std::vector<HidInterface> interfaces = hid_interfaces(*configuration);
    std::ranges::stable_partition(interfaces, [&](const HidInterface& each) { return each.number == first; });
    why = "the device has no HID interface that takes reports as fast as a servo needs";
    int open_number = first;
    for (const HidInterface& each : interfaces) {
        if (each.in_endpoint == 0 || each.out_endpoint == 0) continue;
        if (each.number != open_number) {
            opened.transport.reset();
            opened = open(open_number = each.number);
            if (!opened.transport) return not_usable(std::move(opened.error));
        }
        const auto bytes = read_descriptor(
            *opened.transport, {from_interface, get_descriptor, report_descriptor, static_cast<uint16_t>(each.number)},
            std::min(each.descriptor_bytes, hid_descriptor_bytes_max + 1), times.transfer_ms, why);
        if (!bytes) return not_usable(std::move(why));
        const HidDescriptor descriptor = read_hid_descriptor(*bytes);
        why = PidReports::lacking(descriptor);
        if (why.empty())
            return {make_pid_axes(std::move(opened.transport), each, PidReports(descriptor), times), "", false};
        why = "the device cannot be pushed: " + why;
    }
    return not_usable(std::move(why) + ". If Linux can push it, open its file: evdev:FILE");
}

} // namespace haptel::device
