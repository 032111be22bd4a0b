#include "runtime/texture/texture_slot.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace haptel::runtime {

std::string binding_fault(const TextureBinding& binding)
{
    const haptel_texture* texture = binding.texture;
    if (!texture) return {};
    if (texture->abi != HAPTEL_ABI_VERSION)
        return "the texture was built for interface version " + std::to_string(texture->abi) +
               ", this program speaks " + std::to_string(HAPTEL_ABI_VERSION) + ": rebuild it";
    if (texture->size < offsetof(haptel_texture, height_gradient) + sizeof(texture->height_gradient) ||
        !texture->height_gradient)
        return "the texture has no gradient: ask the compiler for height and gradient";
    if (!binding.block || texture->block_size < sizeof(haptel_block_head)) return "the texture has no parameter block";
    const haptel_facts& facts = binding.facts;
    if (!std::isfinite(facts.height_min_m) || !std::isfinite(facts.height_max_m) ||
        facts.height_min_m > facts.height_max_m)
        return "the range of the texture's height is not known, so the surface that may be touched is not either: keep "
               "the height within bounds, for example with clamp()";
    const double shoulders_m = 0.5 * (binding.shoulder_m[0] + binding.shoulder_m[1]);
    if (!(binding.shoulder_m[0] >= 0 && binding.shoulder_m[1] >= 0 &&
          shoulders_m <= facts.height_max_m - facts.height_min_m))
        return "the shoulders of the range of the texture's height are longer than it";
    return {};
}

TextureSlot::TextureSlot(TextureBinding binding)
{
    if (!publish(std::move(binding)).empty()) publish({});
}

std::string TextureSlot::publish(TextureBinding binding)
{
    std::string fault = binding_fault(binding);
    if (!fault.empty()) return fault;
    const std::lock_guard lock(publishers_);
    const uint64_t serial = newest_serial() + 1;
    kept_.push_back(std::make_unique<const PublishedBinding>(PublishedBinding{serial, std::move(binding)}));
    newest_.store(kept_.back().get(), std::memory_order_release);
    newest_serial_.store(serial, std::memory_order_release);
    // A servo that is about to pick up the newest binding has stored a serial no larger than that binding's, and
    // serials only grow: whatever it may still load is not older than what it has stored.
    uint64_t oldest = serial;
    for (const auto& in_use : oldest_in_use_) oldest = std::min(oldest, in_use.load(std::memory_order_acquire));
    while (kept_.front()->serial < oldest) kept_.pop_front();
    return {};
}

TextureReader::TextureReader(TextureSlot& slot) : slot_(&slot)
{
    const std::lock_guard lock(slot.publishers_);
    const auto free_place =
        std::find_if(slot.oldest_in_use_.begin(), slot.oldest_in_use_.end(),
                     [](const auto& in_use) { return in_use.load(std::memory_order_relaxed) == TextureSlot::unused; });
    oldest_in_use_ = free_place != slot.oldest_in_use_.end() ? &*free_place : &slot.oldest_in_use_.emplace_back();
    from_ = to_ = slot.kept_.back().get();
    oldest_in_use_->store(to_->serial, std::memory_order_release);
}

TextureReader::TextureReader(TextureReader&& other) noexcept
    : slot_(std::exchange(other.slot_, nullptr))
    , oldest_in_use_(other.oldest_in_use_)
    , from_(other.from_)
    , to_(other.to_)
    , weight_(other.weight_)
    , faded_s_(other.faded_s_)
{
}

TextureReader::~TextureReader()
{
    if (slot_) oldest_in_use_->store(TextureSlot::unused, std::memory_order_release);
}

void TextureReader::advance(double period_s) noexcept
{
    if (!fading()) {
        to_ = slot_->newest_.load(std::memory_order_acquire);
        if (!fading()) return;
        faded_s_ = 0;
    }
    faded_s_ += period_s;
    weight_ = std::min(1.0, faded_s_ / fade_s);
    if (weight_ == 1.0) {
        from_ = to_;
        oldest_in_use_->store(to_->serial, std::memory_order_release);
    }
}

} // namespace haptel::runtime
