// The slot: what a servo feels while others publish.
#include "runtime/texture/texture_slot.h"
#include "runtime/texture/surface_texture.h"
#include "tests/support/catch.h"
#include "tests/support/lambda_texture.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <memory>
#include <thread>
#include <utility>

using namespace haptel;
using namespace haptel::runtime;
using haptel::tests::flat_texture;

namespace {

double felt_height_m(const TextureReader& reader)
{
    LastSample none;
    return sample_texture(reader, SurfacePoint{}, none).height_m;
}

constexpr double period_s = 1e-3;

} // namespace

TEST_CASE("an empty slot is flat")
{
    TextureSlot slot;
    TextureReader reader(slot);
    reader.advance(period_s);
    CHECK(felt_height_m(reader) == 0);
    CHECK(reader.to().serial == 1);
}

TEST_CASE("a published texture fades in linearly over fade_s")
{
    TextureSlot slot(flat_texture(1e-3));
    TextureReader reader(slot);
    reader.advance(period_s);
    REQUIRE(felt_height_m(reader) == 1e-3);

    CHECK(slot.publish(flat_texture(3e-3)) == "");
    for (int tick = 1; tick < 50; ++tick) {
        reader.advance(period_s);
        CHECK(std::abs(felt_height_m(reader) - (1e-3 + 2e-3 * tick * period_s / fade_s)) < 1e-15);
    }
    reader.advance(period_s);
    reader.advance(period_s);
    CHECK(felt_height_m(reader) == 3e-3);
    CHECK_FALSE(reader.fading());
}

TEST_CASE("of bindings that arrive during a fade only the newest is felt")
{
    TextureSlot slot(flat_texture(0));
    TextureReader reader(slot);
    slot.publish(flat_texture(1e-3));
    reader.advance(period_s);
    REQUIRE(reader.fading());
    slot.publish(flat_texture(50e-3)); // never felt
    slot.publish(flat_texture(2e-3));

    double highest_m = 0;
    for (int tick = 0; tick < 120; ++tick) {
        reader.advance(period_s);
        highest_m = std::max(highest_m, felt_height_m(reader));
    }
    CHECK(highest_m == 2e-3);
    CHECK(reader.to().serial == 4);
}

TEST_CASE("a binding is freed once no servo uses it, and not before")
{
    TextureBinding old = flat_texture(1e-3);
    const std::weak_ptr<const void> alive = old.owner;
    TextureSlot slot(std::move(old));
    TextureReader slow(slot);
    TextureReader fast(slot);
    slot.publish(flat_texture(2e-3));
    for (int tick = 0; tick < 60; ++tick) fast.advance(period_s);
    slot.publish(flat_texture(2e-3));
    CHECK_FALSE(alive.expired()); // the slow servo has not moved on

    for (int tick = 0; tick < 60; ++tick) slow.advance(period_s);
    CHECK_FALSE(alive.expired()); // a servo never frees
    slot.publish(flat_texture(2e-3));
    CHECK(alive.expired());
}

TEST_CASE("a servo that has gone holds nothing back")
{
    TextureSlot slot(flat_texture(0));
    {
        TextureReader reader(slot);
    }
    for (int i = 0; i < 10; ++i) {
        TextureBinding binding = flat_texture(1e-3);
        const std::weak_ptr<const void> alive = binding.owner;
        slot.publish(std::move(binding));
        slot.publish(flat_texture(0));
        CHECK(alive.expired());
    }
}

TEST_CASE("a binding that a servo must not run is refused with the reason")
{
    TextureSlot slot(flat_texture(1e-3));
    const auto refused = [&](TextureBinding binding) {
        const std::string reason = slot.publish(std::move(binding));
        CHECK(slot.newest_serial() == 1);
        return reason;
    };
    TextureBinding binding = flat_texture(1e-3);
    haptel_texture texture = *binding.texture;
    binding.texture = &texture;

    texture.abi = 7;
    CHECK(refused(binding) == "the texture was built for interface version 7, this program speaks 1: rebuild it");
    texture.abi = HAPTEL_ABI_VERSION;
    texture.height_gradient = nullptr;
    CHECK(refused(binding) == "the texture has no gradient: ask the compiler for height and gradient");
    binding = flat_texture(0);
    binding.facts.height_max_m = std::numeric_limits<double>::infinity();
    CHECK(refused(binding).starts_with("the range of the texture's height is not known"));
    binding.facts.height_max_m = std::nan("");
    CHECK(refused(binding).starts_with("the range of the texture's height is not known"));
    binding = flat_texture(0);
    binding.block = nullptr;
    CHECK(refused(binding) == "the texture has no parameter block");
}

TEST_CASE("the newest serial may be asked for while others publish: it counts up and never beyond what was published")
{
    // Under ThreadSanitizer and AddressSanitizer a look into a binding that a publisher frees is told; without them
    // what stands in freed memory is no serial.
    constexpr uint64_t last = 20'001;
    TextureSlot slot(flat_texture(1e-3));
    std::atomic<bool> asking{false};
    uint64_t highest = 0;
    bool rising = true;
    std::thread asker([&] {
        while (highest < last) {
            const uint64_t serial = slot.newest_serial();
            rising = rising && serial >= highest && serial <= last;
            highest = std::max(highest, serial);
            asking = true;
        }
    });
    while (!asking) std::this_thread::yield();
    for (uint64_t i = 1; i < last; ++i) slot.publish(flat_texture(1e-3));
    asker.join();
    CHECK(rising);
    CHECK(highest == last);
}

TEST_CASE("two threads: every height felt lies between published ones, and all but the newest are freed")
{
    TextureSlot slot(flat_texture(1e-3));
    std::atomic<bool> done{false};
    bool in_range = true;
    std::thread servo([&] {
        TextureReader reader(slot);
        while (!done.load(std::memory_order_relaxed)) {
            reader.advance(10e-3);
            const double height = felt_height_m(reader);
            in_range = in_range && height >= 1e-3 && height <= 2e-3;
        }
    });
    std::thread second_publisher([&] {
        for (int i = 0; i < 2000; ++i) slot.publish(flat_texture(1.5e-3));
    });
    for (int i = 0; i < 2000; ++i) slot.publish(flat_texture(1e-3 + 1e-3 * (i % 7) / 7));
    second_publisher.join();
    done = true;
    servo.join();
    CHECK(in_range);
    CHECK(slot.newest_serial() == 4001);
}
