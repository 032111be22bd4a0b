// Hands textures from whoever makes them to the servos that feel them, while they run.
//
// Reload, slider and material edit all publish an immutable binding to the object's slot: one atomic pointer. A servo
// fades from the binding it feels to the newest one over fade_s; what arrives during a fade waits, and only the newest
// of it is kept. A servo never frees: the publisher does, once every servo has moved on. The cost: bindings published
// during a fade stay in memory until it ends and somebody publishes.
#pragma once

#include "lang/abi/texture_binding.h"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <string>

namespace haptel::runtime {

// Time in which one texture turns into the next under the hand, seconds.
inline constexpr double fade_s = 0.05;

// Why a servo may not run this binding, in words; empty: it may. An empty binding (no texture) is a flat surface.
std::string binding_fault(const TextureBinding& binding);

// A binding as the slot keeps it. Serials count from 1 in the order of publishing.
struct PublishedBinding {
    uint64_t serial = 0;
    TextureBinding binding; // texture null: flat
};

class TextureSlot {
public:
    // Flat, too, if `binding` does not pass binding_fault.
    explicit TextureSlot(TextureBinding binding = {});

    TextureSlot(const TextureSlot&) = delete;
    TextureSlot& operator=(const TextureSlot&) = delete;

    // Any thread but a servo. Returns the binding's fault, with the texture in the hand left as it is, or nothing.
    std::string publish(TextureBinding binding);

    // Serial of the newest binding; 1 from the start.
    uint64_t newest_serial() const noexcept { return newest_serial_.load(std::memory_order_acquire); }

private:
    friend class TextureReader;
    static constexpr uint64_t unused = ~uint64_t{0};

    std::mutex publishers_;
    std::deque<std::unique_ptr<const PublishedBinding>> kept_; // oldest first; guarded by publishers_
    std::atomic<const PublishedBinding*> newest_{nullptr};
    // Beside it: only a reader may look into a binding, which another publisher may free at any time.
    std::atomic<uint64_t> newest_serial_{0};
    std::deque<std::atomic<uint64_t>> oldest_in_use_; // per servo; `unused` where it has left; never shrinks
};

// One servo's view of one slot. Made and destroyed off the servo thread; advance() and the rest belong to it.
class TextureReader {
public:
    explicit TextureReader(TextureSlot& slot);
    ~TextureReader();
    TextureReader(TextureReader&& other) noexcept;
    TextureReader& operator=(TextureReader&&) = delete;

    // Once per tick, before the texture is evaluated: goes on with the fade, or looks for something newer.
    void advance(double period_s) noexcept;

    bool fading() const noexcept { return from_ != to_; }
    const PublishedBinding& from() const noexcept { return *from_; }
    const PublishedBinding& to() const noexcept { return *to_; }
    // Whether there is a texture at all.
    bool textured() const noexcept { return from_->binding.texture || to_->binding.texture; }
    // Share of to() in what is felt, 0 .. 1; 1 outside a fade.
    double weight() const noexcept { return weight_; }

private:
    TextureSlot* slot_;
    std::atomic<uint64_t>* oldest_in_use_;
    const PublishedBinding* from_;
    const PublishedBinding* to_;
    double weight_ = 1;
    double faded_s_ = 0;
};

} // namespace haptel::runtime
