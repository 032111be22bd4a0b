#include "tests/device/falcon/fake_falcon.h"

#include <algorithm>
#include <cstdio>

namespace haptel::device {

namespace {

std::string in_words(const char* format, int a, int b = 0)
{
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), format, a, b);
    return text.data();
}

int number(const std::string& packet, std::size_t at)
{
    int value = 0, weight = 1;
    for (std::size_t i = at; i < at + 4; ++i, weight *= 16) value += weight * (packet[i] - 'A');
    return value >= 32768 ? value - 65536 : value;
}

// Key, reserved words, entry, blocks, end: how many words of the image are still to come is known at its second word
// of each block, as the boot loader knows it.
bool image_is_whole(const std::vector<uint8_t>& image)
{
    const auto word = [&](std::size_t i) { return image[2 * i] + 256u * image[2 * i + 1]; };
    const std::size_t words = image.size() / 2;
    for (std::size_t at = 11; at < words;) {
        if (word(at) == 0) return true;
        at += 3 + word(at);
    }
    return false;
}

} // namespace

const char* name_of(FakeFault fault)
{
    switch (fault) {
    case FakeFault::none: return "none";
    case FakeFault::silence: return "silence";
    case FakeFault::wrong_bytes: return "wrong bytes";
    case FakeFault::garbage: return "garbage";
    case FakeFault::split: return "split";
    case FakeFault::short_packets: return "short packets";
    case FakeFault::late: return "late";
    case FakeFault::stall: return "stall";
    case FakeFault::unplug: return "unplug";
    case FakeFault::lost_homing: return "lost homing";
    }
    return "";
}

FakeFalcon::FakeFalcon(bool runs_program, int packets_to_home)
    : state_(runs_program ? State::running : State::waiting), packets_to_home_(packets_to_home)
{
}

bool FakeFalcon::faulty(FakeFault fault) const
{
    return fault_ == fault && operations_ > fault_from_ && operations_ <= fault_until_;
}

FakeFalcon::Answer FakeFalcon::begin_operation()
{
    ++operations_;
    if (faulty(FakeFault::unplug)) gone_ = true;
    if (faulty(FakeFault::lost_homing)) homed_ = false, homing_packets_ = 0;
    return gone_ ? Answer::gone : faulty(FakeFault::stall) ? Answer::stall : Answer::fine;
}

// One vendor's interface, bulk IN 0x81 and bulk OUT 0x02 of 64 bytes.
std::vector<uint8_t> FakeFalcon::descriptors() const
{
    return {18, 1, 0x00, 0x02, 0,  0,    0,    8,    0x03, 0x04, 0x48, 0xcb, 0x00, 0x04, 0, 0, 0, 1, //
            9,  2, 32,   0,    1,  1,    0,    0x80, 50,                                             //
            9,  4, 0,    0,    2,  0xff, 0xff, 0xff, 0,                                              //
            7,  5, 0x81, 2,    64, 0,    0,                                                          //
            7,  5, 0x02, 2,    64, 0,    0};
}

FakeFalcon::Answer FakeFalcon::control(const UsbSetup& setup, std::span<uint8_t>, std::size_t& size)
{
    const std::lock_guard lock(mutex_);
    const auto& [type, request, value, index] = setup;
    size = 0;
    if (const Answer answer = begin_operation(); answer != Answer::fine) return answer;
    if (type != 0x40) return Answer::stall;
    requests_.push_back(in_words("%d %04x", request, value));
    if (request == 0 && value == 1) to_host_.clear();
    if (request == 3) divisor_ = value, heard_.clear();
    if (request != 1) return Answer::fine;
    const int before = modem_;
    if (value & 0x0100) modem_ = (modem_ & ~1) | (value & 1);
    if (value & 0x0200) modem_ = (modem_ & ~2) | (value & 2);
    const bool data_terminal_rises = !(before & 1) && (modem_ & 1), falls = (before & 1) && !(modem_ & 1);
    if (data_terminal_rises && !(modem_ & 2))
        state_ = State::waiting, homed_ = told_homed_ = false, heard_.clear(); // a reset
    if (falls && state_ == State::called) state_ = State::bit_rate;
    return Answer::fine;
}

FakeFalcon::Answer FakeFalcon::out(std::span<const uint8_t> bytes)
{
    const std::lock_guard lock(mutex_);
    if (const Answer answer = begin_operation(); answer != Answer::fine) return answer;
    if (requests_.size() < 1000) requests_.push_back(in_words("write %d", static_cast<int>(bytes.size())));
    for (const uint8_t byte : bytes) hear(byte);
    return Answer::fine;
}

FakeFalcon::Answer FakeFalcon::in(std::span<uint8_t> bytes, std::size_t& size)
{
    const std::lock_guard lock(mutex_);
    size = 0;
    if (const Answer answer = begin_operation(); answer != Answer::fine) return answer;
    if (bytes.size() < 64) return Answer::stall; // the host asks for too little: on a real bus an overflow
    bytes[0] = 0x31;
    bytes[1] = 0x60;
    size = 2;
    const std::size_t most = faulty(FakeFault::split) ? 5 : 64;
    while (size < most && !to_host_.empty() && to_host_.front().second <= operations_) {
        bytes[size++] = to_host_.front().first;
        to_host_.pop_front();
    }
    if (size > 2 && to_host_.empty()) {
        host_knows_ = !told_homed_;
        if (told_homed_) packets_since_it_knows_ = 0;
    }
    return Answer::fine;
}

void FakeFalcon::answer(std::string bytes)
{
    if (faulty(FakeFault::silence)) return;
    if (faulty(FakeFault::short_packets) && bytes.size() > 2) bytes.erase(bytes.size() / 2, 2);
    if (faulty(FakeFault::wrong_bytes))
        for (char& byte : bytes) byte = static_cast<char>(byte ^ 1);
    if (faulty(FakeFault::garbage))
        for (char& byte : bytes) byte = static_cast<char>(random_());
    const uint64_t from = operations_ + (faulty(FakeFault::late) ? 20 : 0);
    for (const char byte : bytes) to_host_.emplace_back(static_cast<uint8_t>(byte), from);
}

void FakeFalcon::hear(uint8_t byte)
{
    if (state_ == State::running)
        hear_packet(byte);
    else
        hear_loader(byte);
}

void FakeFalcon::hear_loader(uint8_t byte)
{
    if (state_ == State::loading) {
        if (divisor_ != 0x0015) return;
        image_.push_back(byte);
        answer({static_cast<char>(byte)});
        if (image_is_whole(image_)) state_ = State::running, homed_ = false, homing_packets_ = 0, heard_.clear();
        return;
    }
    if (state_ == State::bit_rate) {
        if (divisor_ != 0x0015 || byte != 'A') return;
        answer("A");
        image_.clear();
        state_ = State::loading;
        return;
    }
    if (divisor_ != 0x4138 || !(modem_ & 1)) return;
    heard_ += static_cast<char>(byte);
    if (heard_.size() < 3 || heard_.substr(heard_.size() - 3) != "\nC\r") return;
    heard_.clear();
    answer("\nD,\r");
    state_ = State::called;
}

void FakeFalcon::hear_packet(uint8_t byte)
{
    if (divisor_ != 0x0002) return;
    if (byte == '<') heard_.clear();
    heard_ += static_cast<char>(byte);
    if (heard_.size() > 16) heard_.clear();
    if (heard_.size() == 16 && heard_[0] == '<' && heard_[15] == '>') {
        obey(heard_);
        heard_.clear();
    }
}

void FakeFalcon::obey(const std::string& packet)
{
    motors_ = {number(packet, 1), number(packet, 5), number(packet, 9)};
    flags_ = packet[13] - 'A';
    commands_.push_back(motors_);
    ++packets_;
    const bool force = motors_ != Motors{};
    packets_with_force_ += force;
    // A host cannot know before it has read a reply that says so, and one packet may be on its way by then.
    if (homed_) host_knows_ = false, packets_since_it_knows_ = 0;
    if (host_knows_) ++packets_since_it_knows_;
    violations_ += force && packets_since_it_knows_ > 2;
    for (const int motor : motors_) violations_ += motor > 4095 || motor < -4095;
    if ((flags_ & 1) && ++homing_packets_ >= packets_to_home_) homed_ = true;

    told_homed_ = homed_;

    std::string reply = "<";
    for (const int encoder : encoders_) {
        int rest = encoder < 0 ? encoder + 65536 : encoder;
        for (int digit = 0; digit < 4; ++digit, rest /= 16) reply += static_cast<char>('A' + rest % 16);
    }
    reply += static_cast<char>('A' + buttons_ + (told_homed_ ? 0x70 : 0x10));
    answer(reply + "A>");
}

void FakeFalcon::inject(FakeFault fault, uint64_t after, uint64_t for_operations)
{
    const std::lock_guard lock(mutex_);
    fault_ = fault;
    fault_from_ = operations_ + after;
    fault_until_ = fault_from_ + for_operations;
}

void FakeFalcon::plug_in()
{
    const std::lock_guard lock(mutex_);
    gone_ = false;
    fault_ = FakeFault::none;
    state_ = State::waiting;
    homed_ = told_homed_ = false;
    homing_packets_ = 0;
    host_knows_ = true;
    divisor_ = 0;
    modem_ = 0;
    motors_ = {};
    heard_.clear();
    to_host_.clear();
}

void FakeFalcon::set_encoders(const std::array<int, 3>& encoders)
{
    const std::lock_guard lock(mutex_);
    encoders_ = encoders;
}

void FakeFalcon::set_buttons(int buttons)
{
    const std::lock_guard lock(mutex_);
    buttons_ = buttons;
}

uint64_t FakeFalcon::operations() const
{
    const std::lock_guard lock(mutex_);
    return operations_;
}

bool FakeFalcon::runs_program() const
{
    const std::lock_guard lock(mutex_);
    return state_ == State::running;
}

std::vector<uint8_t> FakeFalcon::image() const
{
    const std::lock_guard lock(mutex_);
    return image_;
}

std::vector<std::string> FakeFalcon::requests() const
{
    const std::lock_guard lock(mutex_);
    return requests_;
}

FakeFalcon::Motors FakeFalcon::motors() const
{
    const std::lock_guard lock(mutex_);
    return motors_;
}

int FakeFalcon::flags() const
{
    const std::lock_guard lock(mutex_);
    return flags_;
}

uint64_t FakeFalcon::packets() const
{
    const std::lock_guard lock(mutex_);
    return packets_;
}

uint64_t FakeFalcon::packets_with_force() const
{
    const std::lock_guard lock(mutex_);
    return packets_with_force_;
}

uint64_t FakeFalcon::violations() const
{
    const std::lock_guard lock(mutex_);
    return violations_;
}

std::vector<FakeFalcon::Motors> FakeFalcon::commands() const
{
    const std::lock_guard lock(mutex_);
    return commands_;
}

} // namespace haptel::device
