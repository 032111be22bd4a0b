#include "bench/scale_bench.h"

#include "bench/bumpy_ball.h"
#include "bench/repeated_ticks.h"

#include <cstddef>
#include <cstdint>
#include <fstream>
#include <malloc.h>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <unistd.h>
#include <utility>
#include <vector>

namespace haptel::bench {
namespace {

using namespace haptel::runtime;
using SharedSurface = std::shared_ptr<const Surface>;

constexpr double depth_m = 1e-3;

// Large balls on 699 380 triangles.
constexpr uint32_t large_parts = 187;
constexpr double object_radius_m = 0.05;

const std::pair<const char*, ProbeSettings> probes[] = {{"point", {ProbeKind::point, 0, 0}},
                                                        {"sphere", {ProbeKind::sphere, 0, 2.5e-3}},
                                                        {"stylus", {ProbeKind::stylus, 0.15, 0}}};

// One row in the making.
class Rendered {
public:
    Rendered(std::string axis, const char* name, const ProbeSettings& probe, const std::shared_ptr<const Scene>& scene,
             int passes)
        : offset_m_((probe.kind == ProbeKind::sphere ? probe.radius_m : 0) - depth_m)
        , ticks_(scene, passes, place_on_stroke(0, 0.02))
    {
        row_.axis = std::move(axis);
        row_.probe = name;
        row_.probe_radius_m = probe.radius_m;
        row_.friction = scene->objects[0].material.static_friction > 0;
        row_.triangles = scene->objects[0].surface->faces.size();
        row_.objects = scene->objects.size();
    }

    void turn(int first, int end)
    {
        ticks_.turn(
            first, end, [&](int tick) { return place_on_stroke(tick, offset_m_); },
            [&](const TickLook& look) { contacts_ += look.felt.contacts; });
    }

    ScaleRow row() const
    {
        ScaleRow row = row_;
        row.contacts = static_cast<double>(contacts_) / static_cast<double>(ticks_.count());
        row.tick_ns = ticks_.least_ns();
        row.once_ns = ticks_.once_ns();
        return row;
    }

private:
    double offset_m_;
    ScaleRow row_;
    RepeatedTicks ticks_;
    uint64_t contacts_ = 0;
};

void stroke(std::vector<std::unique_ptr<Rendered>>& rows, int ticks, const std::function<void(double)>& progress)
{
    constexpr int turn = 5000; // ticks of one row before the next: caches are warm, as in a servo
    for (int first = 0; first < ticks; first += turn)
        for (std::size_t i = 0; i < rows.size(); ++i) {
            rows[i]->turn(first, first + turn);
            progress((first + turn * static_cast<double>(i + 1) / static_cast<double>(rows.size())) / ticks);
        }
}

// Memory of the process that lies in physical pages; 0 where the system does not say.
double resident_bytes()
{
#if defined(__GLIBC__)
    malloc_trim(0); // what was freed is not counted
#endif
    std::ifstream statm("/proc/self/statm");
    double all = 0, resident = 0;
    return statm >> all >> resident ? resident * static_cast<double>(sysconf(_SC_PAGESIZE)) : 0;
}

// So many copies at once that pages do not count, of which the last is given back.
std::pair<BuildRow, SharedSurface> build(uint32_t subdivisions)
{
    const Mesh mesh = bumpy_ball(subdivisions);
    const std::size_t copies = 1 + 200'000 / mesh.triangles.size();
    std::vector<SharedSurface> surfaces;
    surfaces.reserve(copies);
    const double before = resident_bytes();
    const double ms = milliseconds([&] {
        while (surfaces.size() < copies) surfaces.push_back(build_surface(mesh).surface);
    });
    const auto triangles = static_cast<double>(mesh.triangles.size() * copies);
    const double bytes = std::max(0.0, resident_bytes() - before);
    return {{mesh.triangles.size(), ms / static_cast<double>(copies), 1e6 * ms / triangles, bytes / triangles, 1},
            surfaces.back()};
}

} // namespace

Scale bench_scale(bool quick, const std::function<void(double)>& progress)
{
    const int ticks = quick ? 10'000 : 100'000, passes = quick ? 1 : 5;
    const TextureBinding texture = bound_over_ball("texture stone() { return 60um * fbm(p / 2mm, 4); }", "stone");
    Scale scale;
    std::map<uint32_t, SharedSurface> balls; // by subdivisions
    for (const uint32_t subdivisions : {3u, 4u, 5u, 6u, 7u, 8u}) {
        auto [row, surface] = build(subdivisions);
        row.growth = scale.builds.empty() ? 1 : row.ns_per_triangle / scale.builds.front().ns_per_triangle;
        scale.builds.push_back(row);
        balls[subdivisions] = std::move(surface);
        progress(0.05 * subdivisions);
    }
    const SharedSurface& middle = balls[5];
    std::vector<std::unique_ptr<Rendered>> all;
    for (const auto& [name, probe] : probes) {
        const auto add = [&, name = name, probe = probe](const char* axis, const std::shared_ptr<Scene>& scene) {
            all.push_back(std::make_unique<Rendered>(axis, name, probe, scene, passes));
        };
        for (const auto& [subdivisions, surface] : balls) add("triangles", balls_on_a_grid(surface, 1, texture, probe));
        for (const uint64_t objects : {1, 10, 100, 1000})
            add("objects", balls_on_a_grid(middle, objects, texture, probe));
        for (const uint64_t objects : {1, 2, 4, 8}) { // all of them in one place
            const auto scene = balls_on_a_grid(middle, objects, texture, probe);
            for (SceneObject& object : scene->objects) object.placement = {};
            add("contacts", scene);
        }
    }
    const SharedSurface large = build_surface(bumpy_geodesic(large_parts)).surface;
    for (const bool friction : {true, false})
        for (const double radius_m : {object_radius_m / 20, object_radius_m / 10}) {
            const ProbeSettings ball{ProbeKind::sphere, 0, radius_m};
            const auto scene = balls_on_a_grid(large, 1, texture, ball);
            Material& material = scene->objects[0].material;
            if (!friction) material.static_friction = material.dynamic_friction = 0;
            all.push_back(std::make_unique<Rendered>("radius", "sphere", ball, scene, passes));
        }
    stroke(all, ticks, [&](double share) { progress(0.4 + 0.6 * share); });

    std::map<std::tuple<std::string, std::string, bool>, Times> first;
    for (const auto& rendered : all) {
        ScaleRow row = rendered->row();
        const Times& base = first.try_emplace({row.axis, row.probe, row.friction}, row.tick_ns).first->second;
        row.growth_median = row.tick_ns.median / base.median;
        row.growth_p99 = row.tick_ns.p99 / base.p99;
        scale.rows.push_back(row);
    }
    return scale;
}

} // namespace haptel::bench
