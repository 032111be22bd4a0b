#include "tools/replay/felt_difference.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace haptel::tools {

namespace {

std::string three(const glm::dvec3& v)
{
    return fmt::format("{:.9g} {:.9g} {:.9g}", v.x, v.y, v.z);
}

// Traces of earlier versions do not tell the object; the replay does.
std::string object_of(const FeltTick& tick, const std::vector<std::string>& objects)
{
    const uint32_t number = tick.then.object != 0 ? tick.then.object : tick.now.object;
    return number == 0 || number > objects.size() ? "" : objects[number - 1];
}

std::string line_of(const char* which, const FeltTick& tick, const std::vector<std::string>& objects)
{
    const std::string object = object_of(tick, objects);
    std::string line = fmt::format(
        "{} at tick {} ({:.6g} s), {} m, {}: force {} N then, {} N now, {:.3g} N apart", which, tick.then.tick,
        tick.then.time_s, three(tick.then.tip_m), object.empty() ? "touching nothing" : "on `" + object + "`",
        three(tick.then.force_n), three(tick.now.force_n), glm::length(tick.then.force_n - tick.now.force_n));
    if (tick.then.torque_n_m != tick.now.torque_n_m)
        line +=
            fmt::format("; torque {} N m then, {} N m now", three(tick.then.torque_n_m), three(tick.now.torque_n_m));
    if (tick.then.grip_force_n != tick.now.grip_force_n)
        line += fmt::format("; grip {:.9g} N then, {:.9g} N now", tick.then.grip_force_n, tick.now.grip_force_n);
    return line;
}

Json array_of(const glm::dvec3& v)
{
    return Json::array({finite_or_null(v.x), finite_or_null(v.y), finite_or_null(v.z)});
}

Json json_of(const std::optional<FeltTick>& tick, const std::vector<std::string>& objects)
{
    if (!tick) return nullptr;
    const std::string object = object_of(*tick, objects);
    return {{"tick", tick->then.tick},
            {"time_s", finite_or_null(tick->then.time_s)},
            {"force_n", finite_or_null(glm::length(tick->then.force_n - tick->now.force_n))},
            {"torque_n_m", finite_or_null(glm::length(tick->then.torque_n_m - tick->now.torque_n_m))},
            {"grip_force_n", finite_or_null(std::abs(tick->then.grip_force_n - tick->now.grip_force_n))},
            {"at_m", array_of(tick->then.tip_m)},
            {"object", object.empty() ? Json(nullptr) : Json(object)},
            {"recorded_force_n", array_of(tick->then.force_n)},
            {"replayed_force_n", array_of(tick->now.force_n)}};
}

} // namespace

double FeltTick::apart() const
{
    const double most =
        std::max({glm::length(then.force_n - now.force_n), glm::length(then.torque_n_m - now.torque_n_m),
                  std::abs(then.grip_force_n - now.grip_force_n)});
    const double sum = glm::dot(then.force_n + now.force_n + then.torque_n_m + now.torque_n_m, glm::dvec3(1)) +
                       then.grip_force_n + now.grip_force_n;
    return std::isfinite(sum) ? most : std::numeric_limits<double>::infinity();
}

FeltDifference compare_felt(std::span<const runtime::TickRecord> recorded,
                            std::span<const runtime::TickRecord> replayed, double tolerance)
{
    FeltDifference difference{recorded.size(), replayed.size(), 0, {}, {}};
    double most = 0;
    for (std::size_t i = 0; i < std::min(recorded.size(), replayed.size()); ++i) {
        const FeltTick tick{recorded[i], replayed[i]};
        const double apart = tick.apart();
        if (apart <= tolerance) continue;
        ++difference.differing;
        if (!difference.first) difference.first = tick;
        if (apart <= most) continue;
        most = apart;
        difference.largest = tick;
    }
    return difference;
}

Json to_json(const FeltDifference& difference, const std::vector<std::string>& objects)
{
    return {{"ticks", difference.replayed},
            {"recorded_ticks", difference.recorded},
            {"equal", difference.is_equal()},
            {"differing_ticks", difference.differing},
            {"first_difference", json_of(difference.first, objects)},
            {"largest_difference", json_of(difference.largest, objects)}};
}

Json to_json(const std::vector<ChangedFile>& changed)
{
    Json list = Json::array();
    for (const ChangedFile& file : changed)
        list.push_back({{"kind", file.kind}, {"path", file.path}, {"state", file.is_gone ? "gone" : "changed"}});
    return list;
}

std::vector<std::string> lines_of(const FeltDifference& difference, const std::vector<std::string>& objects)
{
    std::vector<std::string> lines;
    if (difference.replayed != difference.recorded)
        lines.push_back(fmt::format("the replay ended after {} of {} ticks", difference.replayed, difference.recorded));
    if (!difference.first) return lines;
    lines.push_back(fmt::format("{} of {} ticks differ from the recording", difference.differing, difference.recorded));
    lines.push_back(line_of("first", *difference.first, objects));
    if (difference.largest->then.tick != difference.first->then.tick)
        lines.push_back(line_of("largest", *difference.largest, objects));
    return lines;
}

std::vector<std::string> lines_of(const std::vector<ChangedFile>& changed)
{
    std::vector<std::string> lines;
    for (const ChangedFile& file : changed)
        lines.push_back(fmt::format("the {} {} {} since it was recorded", file.kind, file.path,
                                    file.is_gone ? "is gone, or cannot be read any more," : "has changed"));
    return lines;
}

} // namespace haptel::tools
