// Wakes a thread that polls, from a thread that may not wait: one non-blocking system call, no lock.
#pragma once

namespace haptel::device {

class WakeEvent {
public:
    WakeEvent();
    ~WakeEvent();
    WakeEvent(const WakeEvent&) = delete;
    WakeEvent& operator=(const WakeEvent&) = delete;

    void wake() noexcept; // any thread; several count as one
    // The waiting side: readable after wake() until cleared; -1 if the system gave none: nobody is woken then.
    int file_descriptor() const noexcept { return file_descriptor_; }
    void clear() noexcept;
    // Until wake() or the time limit; clears.
    void wait(int timeout_ms) noexcept;

private:
    int file_descriptor_;
};

} // namespace haptel::device
