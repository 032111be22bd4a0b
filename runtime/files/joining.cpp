#include "runtime/files/joining.h"

#include "runtime/surface/build/joined_surfaces.h"

#include <array>
#include <bit>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <utility>

namespace haptel::runtime {

namespace {

using Place = std::array<double, 12>; // the numbers of a placement

// Of the same surfaces in the same places.
std::string joined_key(const Scene& scene, const std::vector<ObjectAtRest>& joinable,
                       const std::vector<uint32_t>& numbers)
{
    std::ostringstream key;
    key << std::hexfloat << "joined";
    for (uint32_t i : numbers) {
        key << '\n' << joinable[i].surface_key << '\n';
        for (const double number : std::bit_cast<Place>(scene.objects[joinable[i].number].placement))
            key << number << ' ';
    }
    return key.str();
}

} // namespace

void warn_of_doubles(const Scene& scene, const std::vector<ObjectAtRest>& at_rest, FileMessages& messages)
{
    std::map<std::pair<const Surface*, Place>, uint32_t> first_there;
    for (const ObjectAtRest& one : at_rest) {
        const SceneObject& object = scene.objects[one.number];
        const auto [first, is_first] =
            first_there.try_emplace({object.surface.get(), std::bit_cast<Place>(object.placement)}, one.number);
        if (is_first) continue;
        messages.warning(one.at, "objects " + std::to_string(first->second + 1) + " and " +
                                     std::to_string(one.number + 1) + " are both `" + object.name +
                                     "` in the same place: their forces add, as of one that is as stiff as both. "
                                     "Move one of them (`position_m`), or leave it out");
    }
}

void join_objects(Scene& scene, std::vector<ObjectAtRest> joinable, SurfaceCache* surfaces, FileMessages& messages,
                  const Loading* loading)
{
    std::erase_if(joinable, [](const ObjectAtRest& one) { return !one.joined; });
    std::vector<PlacedSurface> placed;
    for (const ObjectAtRest& one : joinable)
        placed.push_back({scene.objects[one.number].surface, scene.objects[one.number].placement});
    for (const MeetingSurfaces& meeting : find_meeting(placed, loading)) {
        std::string error = meeting.error;
        std::shared_ptr<const Surface> joined;
        if (error.empty()) {
            const std::string key = joined_key(scene, joinable, meeting.numbers);
            if (surfaces) joined = surfaces->find(key);
            if (!joined) {
                SurfaceResult built = join(placed, meeting.numbers, loading);
                joined = std::move(built.surface);
                error = std::move(built.error);
                if (surfaces && joined) surfaces->keep(key, joined);
            }
        }
        if (!joined) {
            std::string told = "objects that meet (";
            for (const uint32_t i : meeting.numbers) {
                if (told.size() > 100) continue; // those are enough to know which
                if (i != meeting.numbers[0]) told += ", ";
                told += '`' + scene.objects[joinable[i].number].name + '`';
            }
            told += ") are touched each by itself, and their seams are felt: ";
            messages.warning(joinable[meeting.numbers[0]].at, told += error);
            continue;
        }
        JoinedObjects& objects = scene.joined.emplace_back();
        objects.surface = std::move(joined);
        for (uint32_t i : meeting.numbers) objects.objects.push_back(joinable[i].number);
    }
}

} // namespace haptel::runtime
