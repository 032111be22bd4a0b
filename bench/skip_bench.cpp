#include "bench/skip_bench.h"

#include "bench/bumpy_ball.h"
#include "runtime/render/renderer.h"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace haptel::bench {
namespace {

using namespace haptel::runtime;

// Eight octaves from 8 mm down: those that are finer than the footprint left out, and all of them computed although
// nothing is left of them.
const char* const rock = R"(
texture rock()
{
    float sum = 0.0, frequency = 1.0, amplitude = 1.0, detail = footprint_in(p / 8mm);
    for (int i = 0; i < 8; i++) {
        if (detail < 1.0) sum += octave_strength(detail) * amplitude * perlin(frequency * p / 8mm);
        detail *= 2.0; frequency *= 2.0; amplitude *= 0.5;
    }
    return 60um * sum;
}
texture rock_in_full()
{
    float sum = 0.0, frequency = 1.0, amplitude = 1.0, detail = footprint_in(p / 8mm);
    for (int i = 0; i < 8; i++) {
        sum += octave_strength(detail) * amplitude * perlin(frequency * p / 8mm);
        detail *= 2.0; frequency *= 2.0; amplitude *= 0.5;
    }
    return 60um * sum;
}
)";

using Counter = uint64_t SkippedStages::*;

struct Kind {
    std::string scene, skip;
    Counter counter;
    Skips with, without;
    double height_m;
    uint64_t objects;
    TextureBinding texture, texture_without;
    double spin_rad_per_s = 0; // of all objects
};

// One row in the making.
class Compared {
public:
    Compared(const Kind& kind, const std::shared_ptr<const Surface>& surface)
        : counter_(kind.counter)
        , height_m_(kind.height_m)
        , heavy_(kind.objects > 1)
        , with_(scene_of(kind, surface, kind.with, kind.texture))
        , without_(scene_of(kind, surface, kind.without, kind.texture_without))
    {
        row_.scene = kind.scene;
        row_.skip = kind.skip;
        const glm::dvec3 start = place_on_stroke(0, 0.02);
        for (Renderer* renderer : {&with_, &without_}) renderer->tick({start, start});
    }

    // Of ticks among a thousand objects that are all looked at a tenth is enough.
    void ticks(int first, int count)
    {
        if (heavy_) first /= 10, count /= 10;
        forces_n_.clear();
        const double clock_ns = clock_reading_ns();
        for (int i = first; i < first + count; ++i) forces_n_.push_back(tick(with_, i, clock_ns, with_ns_));
        for (int i = first; i < first + count; ++i) {
            const glm::dvec3 force_n = tick(without_, i, clock_ns, without_ns_);
            row_.force_difference_max_n = std::max(
                row_.force_difference_max_n, glm::distance(force_n, forces_n_[static_cast<std::size_t>(i - first)]));
        }
    }

    SkipRow row() const
    {
        SkipRow row = row_;
        row.with_ns = summary(with_ns_);
        row.without_ns = summary(without_ns_);
        row.counted = static_cast<double>(with_.skipped().*counter_) / static_cast<double>(with_ns_.size() + 1);
        return row;
    }

private:
    static std::shared_ptr<const Scene> scene_of(const Kind& kind, const std::shared_ptr<const Surface>& surface,
                                                 const Skips& skips, const TextureBinding& texture)
    {
        auto scene = balls_on_a_grid(surface, kind.objects, texture, {});
        scene->servo.skips = skips;
        const SteadyMotion::Figures figures{{1, 2, 3}, kind.spin_rad_per_s, {}, 0};
        if (kind.spin_rad_per_s > 0)
            for (SceneObject& object : scene->objects)
                object.motion = std::make_shared<SteadyMotion>(object.placement, figures);
        return scene;
    }

    glm::dvec3 tick(Renderer& renderer, int number, double clock_ns, std::vector<double>& times_ns) const
    {
        const glm::dvec3 hand = place_on_stroke(number, height_m_);
        const auto begin = std::chrono::steady_clock::now();
        const TickResult felt = renderer.tick({hand, hand});
        const double ns = std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - begin).count();
        times_ns.push_back(std::max(0.0, ns - clock_ns));
        renderer.between_ticks();
        return felt.force_n;
    }

    Counter counter_;
    double height_m_;
    bool heavy_;
    SkipRow row_;
    Renderer with_, without_;
    std::vector<glm::dvec3> forces_n_;
    std::vector<double> with_ns_, without_ns_;
};

} // namespace

std::vector<SkipRow> bench_skip(bool quick, const std::function<void(double)>& progress)
{
    constexpr double in_contact_m = -1e-3, near_m = 2e-3, far_m = 0.02, footprint_m = 0.6e-3;
    const auto stone = bound_over_ball("texture stone() { return 60um * fbm(p / 2mm, 4); }", "stone");
    const auto limited = bound_over_ball(rock, "rock", footprint_m);
    const auto in_full = bound_over_ball(rock, "rock_in_full", footprint_m);
    const Skips all_on, none{false, false, false, false};
    // A single object that is looked at every tick, as one is that the hand is near to.
    const Skips awake{.objects = false};
    using Counted = SkippedStages;
    const Kind kinds[] = {
        {"2 cm above",
         "free_space",
         &Counted::free_space,
         awake,
         {.free_space = false, .objects = false},
         far_m,
         1,
         stone,
         stone},
        {"2 mm above, fbm4",
         "texture",
         &Counted::texture,
         awake,
         {.objects = false, .texture = false},
         near_m,
         1,
         stone,
         stone},
        {"in contact, 8 octaves", "octaves", &Counted::octaves, all_on, all_on, in_contact_m, 1, limited, in_full},
        {"in contact, fbm4", "mapping", &Counted::mapping, all_on, {.mapping = false}, in_contact_m, 1, stone, stone},
        {"in contact, no texture", "mapping", &Counted::mapping, all_on, {.mapping = false}, in_contact_m, 1, {}, {}},
        {"2 cm above, 1000 objects", "objects", &Counted::objects, all_on, awake, far_m, 1000, stone, stone},
        {"in contact, 1000 objects", "objects", &Counted::objects, all_on, awake, in_contact_m, 1000, stone, stone},
        {"2 cm above, 1000 turning", "objects", &Counted::objects, all_on, awake, far_m, 1000, stone, stone, 1},
        {"in contact, 1000 turning", "objects", &Counted::objects, all_on, awake, in_contact_m, 1000, stone, stone, 1},
        {"2 cm above, 1000 objects", "all", &Counted::free_space, all_on, none, far_m, 1000, stone, stone},
        {"in contact, 1000 objects", "all", &Counted::mapping, all_on, none, in_contact_m, 1000, limited, in_full}};
    const auto surface = build_surface(bumpy_ball(5, true)).surface;
    std::vector<std::unique_ptr<Compared>> rows_made;
    for (const Kind& kind : kinds) rows_made.push_back(std::make_unique<Compared>(kind, surface));

    const int ticks = quick ? 20'000 : 100'000;
    constexpr int turn = 5000; // ticks of one row before the next: caches are warm, as in a servo
    for (int first = 0; first < ticks; first += turn)
        for (std::size_t i = 0; i < rows_made.size(); ++i) {
            rows_made[i]->ticks(first, turn);
            progress((first + turn * static_cast<double>(i + 1) / static_cast<double>(rows_made.size())) / ticks);
        }
    std::vector<SkipRow> rows;
    for (const auto& row : rows_made) rows.push_back(row->row());
    return rows;
}

} // namespace haptel::bench
