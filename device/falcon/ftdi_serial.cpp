#include "device/falcon/ftdi_serial.h"

namespace haptel::device {

namespace {

constexpr uint8_t vendor_request_out = 0x40, in_endpoint = 0x81, out_endpoint = 0x02;
constexpr uint16_t purge_received = 1, purge_to_send = 2;

} // namespace

void FtdiSerial::request(FtdiRequest request, uint16_t value)
{
    if (!good()) return;
    const ControlRequest control{vendor_request_out, static_cast<uint8_t>(request), value, 0};
    error_ = transport_.control(control, {}, timeout_ms_).error;
}

void FtdiSerial::purge()
{
    request(FtdiRequest::reset, purge_received);
    request(FtdiRequest::reset, purge_to_send);
}

void FtdiSerial::write(std::span<const uint8_t> bytes)
{
    if (!good()) return;
    const Transferred sent = transport_.out(out_endpoint, bytes, timeout_ms_);
    error_ = sent.error;
    if (good() && sent.bytes != bytes.size()) error_ = UsbError::failed;
}

// Always a whole packet is asked for: a device that sends more than there is room for ends in an overflow.
std::span<const uint8_t> FtdiSerial::read()
{
    if (!good()) return {};
    const Transferred got = transport_.in(in_endpoint, received_, timeout_ms_);
    if (got.error != UsbError::none && got.error != UsbError::timeout) error_ = got.error;
    std::size_t size = 0;
    for_each_ftdi_byte({received_.data(), got.bytes}, [&](uint8_t byte) { payload_[size++] = byte; });
    return {payload_.data(), size};
}

} // namespace haptel::device
