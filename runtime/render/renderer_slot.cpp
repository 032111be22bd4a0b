#include "runtime/render/renderer_slot.h"

#include "runtime/scene/validation.h"

#include <algorithm>
#include <utility>

namespace haptel::runtime {

RendererSlot::RendererSlot(std::shared_ptr<const Scene> scene, const HandSettings& hand)
    : hand_(hand), newest_(validate(scene.get(), hand).empty() ? std::move(scene) : std::make_shared<const Scene>())
{
    taken_ = newest_;
    follow_newest();
}

RendererSlot::~RendererSlot()
{
    delete next_.load();
    free_given_back();
}

std::string RendererSlot::publish(std::shared_ptr<const Scene> scene)
{
    if (std::string faults = validate(scene.get(), hand_); !faults.empty()) return faults;
    const std::lock_guard lock(publishers_);
    if (scene->servo.rate_hz != newest_->servo.rate_hz)
        return "the rate of a servo cannot change while it runs: stop it and start anew";
    // Withdrawn first: then the scene that the servo has is known for as long as the next one is made.
    const std::unique_ptr<Carrier> withdrawn(next_.exchange(nullptr, std::memory_order_acq_rel));
    if (!withdrawn) taken_ = newest_;
    free_given_back();
    auto next = std::make_unique<Carrier>();
    next->renderer = std::make_unique<Renderer>(scene, hand_, *taken_);
    reloads_ += newly_published();
    newest_ = std::move(scene);
    follow_newest();
    next_.store(next.release(), std::memory_order_release);
    return {};
}

uint64_t RendererSlot::newly_published() const noexcept
{
    uint64_t sum = 0;
    for (const auto& [slot, serial] : followed_) sum += slot->newest_serial() - serial;
    return sum;
}

void RendererSlot::follow_newest()
{
    followed_.clear();
    for (const SceneObject& object : newest_->objects) followed_.emplace_back(object.texture.get(), 0);
    std::sort(followed_.begin(), followed_.end());
    followed_.erase(std::unique(followed_.begin(), followed_.end()), followed_.end());
    for (auto& [slot, serial] : followed_) serial = slot->newest_serial();
}

uint64_t RendererSlot::reloads() const
{
    const std::lock_guard lock(publishers_);
    return reloads_ + newly_published();
}

void RendererSlot::collect()
{
    const std::lock_guard lock(publishers_);
    if (!next_.load(std::memory_order_acquire)) taken_ = newest_;
    free_given_back();
}

void RendererSlot::free_given_back() noexcept
{
    std::unique_ptr<Carrier> top(given_back_.exchange(nullptr, std::memory_order_acquire));
    while (top) top.reset(std::exchange(top->below, nullptr));
}

// The servo alone puts something here, and others take all of it: what was on top is so still, or nothing is there,
// which stays so until the servo is back. So this tries twice at most.
void RendererSlot::give_back(Carrier* carrier) noexcept
{
    carrier->below = given_back_.load(std::memory_order_relaxed);
    while (!given_back_.compare_exchange_strong(carrier->below, carrier, std::memory_order_release,
                                                std::memory_order_relaxed)) {
    }
}

bool RendererSlot::take(std::unique_ptr<Renderer>& current) noexcept
{
    if (!next_.load(std::memory_order_relaxed)) return false;
    Carrier* const next = next_.exchange(nullptr, std::memory_order_acq_rel);
    if (!next) return false; // withdrawn meanwhile
    next->renderer->take_over(*current);
    std::swap(next->renderer, current);
    give_back(next);
    return true;
}

} // namespace haptel::runtime
