#include "runtime/servo/servo_turns.h"

namespace haptel::runtime {

ServoTurns::~ServoTurns()
{
    for (ServoThread* servo : servos_) servo->request_stop();
    wait();
}

void ServoTurns::start()
{
    for (ServoThread* servo : servos_) servo->running_.store(true, std::memory_order_release);
    thread_ = std::thread([this] { run(); });
}

void ServoTurns::wait()
{
    if (thread_.joinable()) thread_.join();
}

void ServoTurns::run()
{
    for (ServoThread* servo : servos_) servo->begin();
    std::vector<ServoThread*> going = servos_;
    while (!going.empty())
        for (auto servo = going.begin(); servo != going.end();) {
            if ((*servo)->turn()) {
                ++servo;
            } else {
                (*servo)->finish();
                servo = going.erase(servo);
            }
        }
}

} // namespace haptel::runtime
