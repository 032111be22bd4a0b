#include "bench/tick_bench.h"

#include "bench/bumpy_ball.h"
#include "bench/repeated_ticks.h"

#include <algorithm>
#include <chrono>
#include <deque>
#include <memory>

namespace haptel::bench {
namespace {

using namespace haptel::runtime;

struct Kind {
    std::string scene;
    ProbeSettings probe;
    bool textured = true;
    double height_m = -1e-3; // of the hand
};

// One row in the making.
class Rendered {
public:
    Rendered(const Kind& kind, const std::shared_ptr<const Surface>& surface, uint64_t objects,
             const TextureBinding& texture, int passes)
        : kind_(kind)
        , surface_(surface)
        , ticks_(balls_on_a_grid(surface, objects, kind.textured ? texture : TextureBinding{}, kind.probe), passes,
                 place(0, 0.02))
        , before_(place(0, 0.02))
    {
        row_.scene = kind.scene;
        row_.objects = objects;
        row_.triangles = surface->faces.size();
    }

    void turn(int first, int end)
    {
        ticks_.turn(
            first, end, [&](int tick) { return place(tick, kind_.height_m); },
            [&](const TickLook& look) { take_in(look); });
    }

    TickRow row() const
    {
        TickRow row = row_;
        row.contact = static_cast<double>(touching_) / static_cast<double>(ticks_.count());
        row.tick_ns = ticks_.least_ns();
        row.once_ns = ticks_.once_ns();
        row.ahead_ns = summary(ahead_ns_);
        row.tree_ns = summary(tree_ns_);
        row.queries = summary(queries_);
        row.triangles_stepped = summary(stepped_);
        row.triangles_touched = summary(touched_);
        return row;
    }

private:
    void take_in(const TickLook& look)
    {
        const auto begin = std::chrono::steady_clock::now();
        const auto hit = surface_->first_hit(before_, look.hand_m);
        const auto walked = std::chrono::steady_clock::now();
        found_ += hit.has_value();
        before_ = look.hand_m;
        touching_ += look.felt.contacts > 0;
        const uint64_t stepped = look.work.triangles_tested + look.work.walk_steps;
        ahead_ns_.push_back(look.ahead_ns);
        tree_ns_.push_back(
            std::max(0.0, std::chrono::duration<double, std::nano>(walked - begin).count() - look.clock_ns));
        queries_.push_back(static_cast<double>(look.work.sweeps));
        stepped_.push_back(static_cast<double>(stepped));
        touched_.push_back(static_cast<double>(stepped + look.work.read_ahead));
    }

    // What lies on the ball lies its own radius higher.
    glm::dvec3 place(int number, double height_m) const
    {
        return place_on_stroke(number, height_m + (kind_.probe.kind == ProbeKind::sphere ? kind_.probe.radius_m : 0));
    }

    Kind kind_;
    std::shared_ptr<const Surface> surface_;
    TickRow row_;
    RepeatedTicks ticks_;
    glm::dvec3 before_; // where the hand was in the tick before
    std::vector<double> ahead_ns_, tree_ns_, queries_, stepped_, touched_;
    uint64_t touching_ = 0, found_ = 0;
};

} // namespace

std::vector<TickRow> bench_tick(bool quick, const std::function<void(double)>& progress)
{
    const TextureBinding texture = bound_over_ball("texture stone() { return 60um * fbm(p / 2mm, 4); }", "stone");
    const Kind textured{"fbm4", {}}, bare{"no texture", {}, false}, free{"free", {}, true, 2e-3};
    const Kind stylus{"stylus, fbm4", {ProbeKind::stylus}},
        ball{"ball of 2.5 mm, fbm4", {ProbeKind::sphere, 0, 2.5e-3}};
    const int ticks = quick ? 10'000 : 100'000, passes = quick ? 2 : 5;
    std::deque<Rendered> all;
    std::shared_ptr<const Surface> middle;
    for (const uint32_t subdivisions : {3u, 5u, 6u, 7u}) {
        const auto surface = build_surface(bumpy_ball(subdivisions)).surface;
        if (subdivisions == 5) middle = surface;
        for (const Kind& kind : {textured, bare, free, stylus, ball})
            all.emplace_back(kind, surface, 1, texture, passes);
    }
    for (const uint64_t objects : {uint64_t{30}, uint64_t{1000}})
        all.emplace_back(textured, middle, objects, texture, passes);

    constexpr int turn = 5000; // ticks of one row before the next: caches are warm, as in a servo
    for (int first = 0; first < ticks; first += turn) {
        progress(static_cast<double>(first) / ticks);
        for (Rendered& row : all) row.turn(first, first + turn);
    }
    progress(1);
    std::vector<TickRow> rows;
    for (const Rendered& row : all) rows.push_back(row.row());
    return rows;
}

Growth growth(const TickRow& first, const TickRow& last)
{
    return {last.tick_ns.median / first.tick_ns.median, last.tick_ns.p99 / first.tick_ns.p99,
            last.triangles_touched.p99 / first.triangles_touched.p99,
            last.triangles_stepped.p99 / first.triangles_stepped.p99};
}

} // namespace haptel::bench
