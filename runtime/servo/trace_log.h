// A run as a binary file that survives the end of whoever writes it: cut at any byte it is read up to the last whole
// tick, and a byte that was changed is found, with its tick.
//
// The file, in the byte order of the machine that wrote it, which the second field shows:
//
//   "HAPTRACE"          8 bytes
//   0x01020304          u32; 0x04030201: the other byte order, which is refused
//   1                   u32, the version: another layout gets another number
//   size of the text    u32, bytes
//   size of a tick      u32, bytes, its checksum included
//   text                what the recording is of (trace_origin.h), and a line "column TYPE NAME" for each column
//   checksum            u64, of all of the above
//   ticks               to the end: the columns in their order (u64, u32, f64), then a u64: the checksum of these bytes
//                       and of the checksum before, so a tick that is lost, doubled or out of its place is found, too
//
// Columns go by name: later versions may add some, and a file may leave out those that would say nothing.
#pragma once

#include "runtime/servo/recording.h"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace haptel::runtime {

// Writes one while a run goes on. Not for the servo thread: it allocates and writes.
class TraceLog {
public:
    // Makes the file, or empties an older recording; see error(). What is there and is no recording is left alone.
    TraceLog(const std::filesystem::path& file, const TraceOrigin& origin);
    ~TraceLog(); // hands over the rest
    TraceLog(const TraceLog&) = delete;
    TraceLog& operator=(const TraceLog&) = delete;

    void add(const TickRecord& record);
    // Hands what was added to the operating system if the last time is 10 ms ago: from then on it survives the end of
    // the process, though not that of the machine. To be called every few milliseconds.
    void keep_up();
    void hand_over(); // now

    // Why something could not be written; empty: all is well. From then on nothing more is.
    const std::string& error() const { return error_; }

private:
    const char* open_empty();
    void fail(const char* why);

    std::string name_, error_, waiting_; // bytes that wait for their turn
    std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_{nullptr, std::fclose};
    uint64_t sum_ = 0; // of the last tick, or of the header
    std::chrono::steady_clock::time_point handed_over_;
};

// A whole recording in few bytes: without the columns that tell of the machine's time, and without those that have in
// each tick what a record has by itself (a tail: the tip's place).
std::string trace_log_bytes(const TraceOrigin& origin, std::span<const TickRecord> records);

} // namespace haptel::runtime
