// A wheel that the kernel believes to have (uinput): what its driver is asked for comes here. It turns with the force
// on it, the other way round than its effects say.
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace haptel::device {

class UinputWheel {
public:
    static constexpr int minimum = -1000, maximum = 3000;

    struct Upload {
        int id = 0, type = 0, direction = 0, level = 0, length_ms = 0;
    };
    struct Play {
        int id = 0, value = 0; // 0: stopped
        bool operator==(const Play&) const = default;
    };

    UinputWheel();  // throws what the kernel says
    ~UinputWheel(); // unplugged
    UinputWheel(const UinputWheel&) = delete;
    UinputWheel& operator=(const UinputWheel&) = delete;

    const std::string& path() const { return path_; } // /dev/input/event3
    void turn_to(int value);

    // What it was asked for, in order.
    std::vector<Upload> uploads() const;
    std::vector<Play> plays() const;
    std::vector<int> erased() const;
    int gain() const; // -1: never

private:
    void run();
    void take_upload(int request);
    void take_erase(int request);
    void emit(int type, int code, int value);

    int file_;
    std::string path_;
    mutable std::mutex mutex_;
    std::vector<Upload> uploads_;
    std::vector<Play> plays_;
    std::vector<int> erased_;
    int gain_ = -1, place_ = 0;
    std::atomic<bool> ending_{false};
    std::thread thread_;
};

} // namespace haptel::device
