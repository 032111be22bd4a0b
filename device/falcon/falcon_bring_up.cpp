#include "device/falcon/falcon_bring_up.h"

#include "device/falcon/falcon_packet.h"
#include "device/falcon/ftdi_serial.h"

#include <algorithm>
#include <chrono>
#include <fmt/format.h>
#include <optional>
#include <vector>

namespace haptel::device {

namespace {

// Of the converter. Divisors of 3 MHz; the upper two bits are halves and quarters.
constexpr uint16_t bits_per_s_9600 = 0x4138, bits_per_s_142857 = 0x0015, bits_per_s_1500000 = 0x0002;
constexpr uint16_t eight_bits_no_parity = 8, no_flow_control = 0;
constexpr uint16_t rts_low = 0x0200, dtr_low = 0x0100, dtr_high = 0x0101;
constexpr uint16_t loading_latency_ms = 16, running_latency_ms = 1;

constexpr std::array<uint8_t, 3> loader_call = {'\n', 'C', '\r'};
constexpr std::array<uint8_t, 4> loader_answer = {'\n', 'D', ',', '\r'};
constexpr std::array<uint8_t, 1> bit_rate_byte = {'A'};
constexpr std::size_t chunk_bytes = 62; // its echo fits one packet

class BringUp {
public:
    BringUp(Transport& transport, std::span<const uint8_t> image, const BringUpLimits& limits,
            const std::atomic<bool>& quit)
        : serial_(transport, limits.transfer_ms)
        , image_(image)
        , limits_(limits)
        , quit_(quit)
        , deadline_(Clock::now() +
                    std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(limits.seconds)))
    {
    }

    BringUpResult run()
    {
        set_running_mode();
        if (answers()) return {BringUpEnd::ready, {}, {}, false};
        if (serial_.good() && image_.empty() && !over())
            return {BringUpEnd::no_program,
                    {},
                    "it runs no program, and there is no firmware to load: put Novint's nvent_firmware.bin at "
                    "~/.config/haptel/falcon_firmware.bin, or name it in HAPTEL_FALCON_FIRMWARE",
                    false};
        if (!call_loader()) return failure("its boot loader does not answer");
        if (!set_bit_rate()) return failure("its boot loader does not take the bit rate");
        if (!send_image()) return failure("its boot loader received another program than it was sent");
        set_running_mode();
        if (!answers()) return failure("it does not answer after its program was loaded");
        return {BringUpEnd::ready, {}, {}, true};
    }

private:
    using Clock = std::chrono::steady_clock;

    bool over() const { return quit_.load(std::memory_order_relaxed) || Clock::now() >= deadline_; }

    BringUpResult failure(const char* what) const
    {
        if (!serial_.good()) return {BringUpEnd::try_again, serial_.error(), words_of(serial_.error()), false};
        if (quit_.load(std::memory_order_relaxed)) return {BringUpEnd::try_again, UsbError::cancelled, "ended", false};
        return {BringUpEnd::try_again, UsbError::none, what, false};
    }

    void set_running_mode()
    {
        serial_.purge();
        serial_.request(FtdiRequest::latency_ms, running_latency_ms);
        serial_.request(FtdiRequest::baud_divisor, bits_per_s_1500000);
        serial_.purge();
    }

    // Calls `take` with what each of some IN transfers brings until it returns true.
    template <typename Take>
    bool read_until(int reads, Take take)
    {
        for (int i = 0; i < reads && serial_.good() && !over(); ++i)
            if (take(serial_.read())) return true;
        return false;
    }

    bool answers()
    {
        FalconReplyReader reader;
        for (int i = 0; i < limits_.probes && serial_.good() && !over(); ++i) {
            serial_.write(encode({}));
            const bool answered = read_until(limits_.reads, [&](std::span<const uint8_t> bytes) {
                return std::count_if(bytes.begin(), bytes.end(), [&](uint8_t b) { return reader.add(b).has_value(); }) >
                       0;
            });
            if (answered) return true;
        }
        return false;
    }

    bool call_loader()
    {
        serial_.purge();
        serial_.request(FtdiRequest::latency_ms, loading_latency_ms);
        serial_.request(FtdiRequest::baud_divisor, bits_per_s_9600);
        serial_.request(FtdiRequest::line, eight_bits_no_parity);
        serial_.request(FtdiRequest::flow, no_flow_control);
        serial_.request(FtdiRequest::modem, rts_low);
        serial_.request(FtdiRequest::modem, dtr_low);
        serial_.request(FtdiRequest::modem, dtr_high);
        for (int i = 0; i < limits_.calls && serial_.good() && !over(); ++i) {
            serial_.write(loader_call);
            if (hears_loader()) return true;
        }
        return false;
    }

    // Some hosts see one byte 0 before the answer. It may come in parts.
    bool hears_loader()
    {
        constexpr int reads_per_call = 4;
        std::vector<uint8_t> heard;
        read_until(reads_per_call, [&](std::span<const uint8_t> bytes) {
            heard.insert(heard.end(), bytes.begin(), bytes.end());
            return !heard.empty() && heard.back() == loader_answer.back();
        });
        if (heard.size() == loader_answer.size() + 1 && heard.front() == 0) heard.erase(heard.begin());
        return std::equal(heard.begin(), heard.end(), loader_answer.begin(), loader_answer.end());
    }

    // The loader measures the one byte that it expects, and sends it back.
    bool set_bit_rate()
    {
        serial_.request(FtdiRequest::modem, dtr_low);
        serial_.request(FtdiRequest::baud_divisor, bits_per_s_142857);
        return sends_back(bit_rate_byte);
    }

    bool send_image()
    {
        for (std::size_t at = 0; at < image_.size(); at += chunk_bytes)
            if (!sends_back(image_.subspan(at, std::min(chunk_bytes, image_.size() - at)))) return false;
        return true;
    }

    bool sends_back(std::span<const uint8_t> bytes)
    {
        serial_.write(bytes);
        std::size_t same = 0;
        bool differs = false;
        read_until(limits_.reads, [&](std::span<const uint8_t> echo) {
            for (const uint8_t byte : echo) {
                differs = differs || same == bytes.size() || byte != bytes[same];
                ++same;
            }
            return differs || same >= bytes.size();
        });
        return serial_.good() && !differs && same == bytes.size();
    }

    FtdiSerial serial_;
    std::span<const uint8_t> image_;
    const BringUpLimits& limits_;
    const std::atomic<bool>& quit_;
    Clock::time_point deadline_;
};

} // namespace

BringUpResult bring_up_falcon(Transport& transport, std::span<const uint8_t> image, const BringUpLimits& limits,
                              const std::atomic<bool>& quit)
{
    return BringUp(transport, image, limits, quit).run();
}

} // namespace haptel::device
