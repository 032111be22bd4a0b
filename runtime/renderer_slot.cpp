#include "runtime/renderer_slot.h"

#include <utility>

namespace haptel::runtime {

RendererSlot::RendererSlot(std::shared_ptr<const Scene> scene, const HandSettings& hand)
    : hand_(hand), taken_(scene), newest_(std::move(scene))
{
}

RendererSlot::~RendererSlot()
{
    delete next_.load();
    delete given_back_.load();
}

void RendererSlot::publish(std::shared_ptr<const Scene> scene)
{
    const std::lock_guard lock(publishers_);
    // Withdrawn first: then the scene that the servo has is known for as long as the next one is made.
    const std::unique_ptr<Renderer> withdrawn(next_.exchange(nullptr, std::memory_order_acq_rel));
    if (!withdrawn) taken_ = newest_;
    free_given_back();
    auto next = std::make_unique<Renderer>(scene, hand_, *taken_);
    newest_ = std::move(scene);
    next_.store(next.release(), std::memory_order_release);
}

void RendererSlot::collect()
{
    const std::lock_guard lock(publishers_);
    if (!next_.load(std::memory_order_acquire)) taken_ = newest_;
    free_given_back();
}

void RendererSlot::free_given_back() noexcept
{
    delete given_back_.exchange(nullptr, std::memory_order_acq_rel);
}

bool RendererSlot::take(std::unique_ptr<Renderer>& current) noexcept
{
    if (!next_.load(std::memory_order_relaxed)) return false;
    Renderer* const next = next_.exchange(nullptr, std::memory_order_acq_rel);
    if (!next) return false; // withdrawn meanwhile
    next->take_over(*current);
    given_back_.store(current.release(), std::memory_order_release); // empty: publish has freed the one before
    current.reset(next);
    return true;
}

} // namespace haptel::runtime
