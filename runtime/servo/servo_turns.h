// Several servos on the virtual clock, a tick each in turn, in one thread: what they share - a texture that is
// published, a scene that is swapped, an object that an application moves - meets them in the same order on every run.
#pragma once

#include "runtime/servo/servo_thread.h"

#include <thread>
#include <vector>

namespace haptel::runtime {

class ServoTurns {
public:
    // Servos that were not started, and outlive this.
    explicit ServoTurns(std::vector<ServoThread*> servos) : servos_(std::move(servos)) {}
    ~ServoTurns(); // stops them and waits

    void start(); // once, in place of theirs; running(), request_stop() and telemetry() are theirs as ever
    // Before wait() of a servo.
    void wait();

private:
    void run();

    std::vector<ServoThread*> servos_;
    std::thread thread_;
};

} // namespace haptel::runtime
