// From a Falcon that was just opened to one that answers packets: finds out whether its program runs, loads it if not.
//
// The converter is set up, then a packet that asks for no force is sent: a program that runs answers it. If none does,
// the boot loader of the processor behind the converter is called by its line signals, takes the bit rate from one byte
// and then sends back each byte of the program that it is sent. Each wait is limited; the whole takes some seconds.
#pragma once

#include "device/usb/transport.h"

#include <atomic>
#include <cstdint>
#include <span>
#include <string>

namespace haptel::device {

struct BringUpLimits {
    int probes = 10;       // packets without an answer before the program counts as absent
    int calls = 100;       // of the boot loader
    int reads = 100;       // IN transfers for each answer; one takes a latency period of the converter
    int transfer_ms = 100; // for one transfer
    double seconds = 20;   // for all of it: the program alone takes 0.6 s
};

enum class BringUpEnd : uint8_t {
    ready,
    try_again, // by opening the device anew: loading often fails the first time
    no_program // it runs none, and none was given
};

struct BringUpResult {
    BringUpEnd end = BringUpEnd::try_again;
    UsbError error = UsbError::none;
    std::string reason;  // why it is not ready, in words
    bool loaded = false; // the program was absent and was sent
};

// `image` may be empty. Comes back soon after `quit` is set.
BringUpResult bring_up_falcon(Transport& transport, std::span<const uint8_t> image, const BringUpLimits& limits,
                              const std::atomic<bool>& quit);

} // namespace haptel::device
