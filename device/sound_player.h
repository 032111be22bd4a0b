// Frames to a sound card through ALSA, as they are made.
//
// The card's own buffer is the only queue: write() waits until there is room in it, so the card's clock paces whoever
// makes the frames. Nothing waits for ever: a card that takes nothing, or is unplugged, is an error.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

namespace haptel::device {

class SoundPlayer {
public:
    SoundPlayer();
    ~SoundPlayer(); // stops at once
    SoundPlayer(const SoundPlayer&) = delete;
    SoundPlayer& operator=(const SoundPlayer&) = delete;

    // `name` as ALSA knows it: "default", "plughw:1", "null". Returns why it cannot be played there; empty: it can.
    std::string open(const std::string& name, int channels);

    // Whole frames, channel beside channel, full scale is 1. Returns why they could not be played; empty: they are on
    // their way.
    std::string write(std::span<const float> frames);

    // Waits until all has been heard.
    void finish();

    // How often the card had nothing to play: each is a gap.
    uint64_t underruns() const { return underruns_; }

private:
    struct Card;
    std::unique_ptr<Card> card_;
    int channels_ = 0;
    uint64_t underruns_ = 0;
};

} // namespace haptel::device
