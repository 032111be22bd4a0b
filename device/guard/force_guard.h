// A process beside this one that takes the force away from a device where this one no longer can: it was killed, it
// crashed, it called exit(), or a signal or a debugger has stopped it. Motors hold the last command for as long as they
// hear no other.
//
// It is given the device's file descriptor and the bytes that end the force (the last word). It says them when it has
// heard nothing from the stream's thread for guard_silence_ms, and at once at the end of this process. It does not ask
// whether a force stands: a thread can be stopped between its force and its word about it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace haptel::device {

// More than a servo at 1 kHz may be silent for (servo_silence.h): the stream's thread takes the force away before, and
// with a frame of the bus no force stands 5 ms after the program was stopped.
inline constexpr int guard_silence_ms = 4;
inline constexpr int guard_hears_ms = 1;

// As the system lists it.
inline constexpr const char* guard_process_name = "haptel-guard";

class ForceGuard {
public:
    // The bytes go to this OUT endpoint of a node of /dev/bus/usb; endpoint 0: they are written, to a socket or a node
    // of /dev/input. Nothing is guarded without them or with more than last_word_bytes_max, nor where no process can be
    // had.
    static constexpr std::size_t last_word_bytes_max = 512;
    ForceGuard(int file_descriptor, uint8_t endpoint, std::span<const uint8_t> last_word) noexcept;
    ~ForceGuard(); // the word is not said: who ends in order takes the force away itself
    ForceGuard(const ForceGuard&) = delete;
    ForceGuard& operator=(const ForceGuard&) = delete;

    // The stream's thread, at least every guard_hears_ms; waits for nothing. True: so long after the call before that
    // the last word may have been said.
    bool hear() noexcept;

private:
    int guard_ = -1; // the other end of it; -1: none
    int64_t told_ns_ = 0;
};

} // namespace haptel::device
