// Hands a scene to a servo that runs, as texture_slot.h does with textures: atomic pointers, no lock in the tick,
// nothing freed by the servo.
//
// What is handed over is a whole renderer, made off the servo thread; the servo lets it take over from the one it has
// and puts that one back, to be freed by whoever publishes or collects next. Several may lie there: while the servo
// takes one over another may be published, which it takes in its next tick whether anybody collects or not. One servo
// per slot.
#pragma once

#include "runtime/render/renderer.h"

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace haptel::runtime {

class RendererSlot {
public:
    // The scene that the servo starts with; in the place of one that does not validate, nothing.
    RendererSlot(std::shared_ptr<const Scene> scene, const HandSettings& hand);
    ~RendererSlot(); // the servo has ended
    RendererSlot(const RendererSlot&) = delete;
    RendererSlot& operator=(const RendererSlot&) = delete;

    // Any thread but the servo. Of several that were not taken yet only the newest will be. Returns why the scene is
    // refused, with what is felt left as it is, or nothing.
    std::string publish(std::shared_ptr<const Scene> scene);
    // Frees what the servo has given back; publish does so too. Any thread but the servo.
    void collect();

    // Any thread but the servo. Bindings published to the scenes' textures while they were the newest, since the start.
    uint64_t reloads() const;

    // The servo, once per tick: true if another scene has taken over.
    bool take(std::unique_ptr<Renderer>& current) noexcept;

private:
    // Made by who publishes; goes to the servo with the next renderer in it and comes back with the one before.
    struct Carrier {
        std::unique_ptr<Renderer> renderer;
        Carrier* below = nullptr; // given back before this one, and not freed yet
    };
    void give_back(Carrier* carrier) noexcept;
    void free_given_back() noexcept;
    // To the textures of the newest scene since it is followed.
    uint64_t newly_published() const noexcept;
    void follow_newest();

    HandSettings hand_;
    mutable std::mutex publishers_;
    std::shared_ptr<const Scene> taken_, newest_; // as far as the publishers know; guarded by publishers_
    std::vector<std::pair<const TextureSlot*, uint64_t>> followed_; // each slot of the newest, with its serial then
    uint64_t reloads_ = 0;                                          // before
    std::atomic<Carrier*> next_{nullptr}, given_back_{nullptr};
};

} // namespace haptel::runtime
