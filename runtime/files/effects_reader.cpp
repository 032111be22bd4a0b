#include "runtime/files/effects_reader.h"

#include "runtime/scene/validation.h"

#include <algorithm>

namespace haptel::runtime {

namespace {

// Some 10 ns of a tick each.
constexpr std::size_t regions_max = 10'000;

// Of the smallest half side: where a region does not say how wide its edge is.
constexpr double default_edge = 0.25;

// An effect without one of its figures has no meaning.
void need(TableReader& table, const char* key, const char* why, FileMessages& messages)
{
    if (!table.has(key)) messages.error(table.where(key), std::string(why));
}

// One that is written and does nothing is probably not meant so. `errors` were told before it was read: what is wrong
// in it is said already.
void warn_if_idle(TableReader& table, bool acts, const char* strength, const char* effect, std::size_t errors,
                  FileMessages& messages)
{
    if (acts || messages.errors() > errors) return;
    messages.warning(table.where(strength), "`" + std::string(strength) + "` is 0, so that this " + effect +
                                                " is not felt: write more than 0, or leave the " + effect + " out");
}

Magnet read_magnet(TableReader& object, FileMessages& messages)
{
    Magnet magnet;
    const toml::table* source = object.table("magnet", "{ force_n = 1, reach_m = \"5mm\" }");
    if (!source) return magnet;
    const std::size_t errors = messages.errors();
    TableReader table(*source, "`magnet`", messages);
    magnet_fields(magnet, table.fields());
    need(table, "force_n", "a magnet needs its largest pull: write `force_n = 1`", messages);
    need(table, "reach_m", "a magnet needs the distance from which on it pulls: write `reach_m = \"5mm\"`", messages);
    table.report_unknown_keys();
    warn_if_idle(table, magnet.acts(), "force_n", "magnet", errors, messages);
    return magnet;
}

Vibration read_vibration(const toml::table& source, double rate_hz, double* reach_m, FileMessages& messages)
{
    Vibration vibration;
    const std::size_t errors = messages.errors();
    TableReader table(source, "`vibration`", messages);
    vibration_fields(vibration, table.fields());
    need(table, "force_n", "a vibration needs its amplitude: write `force_n = 0.5`", messages);
    check_rounds("frequency_hz", vibration.frequency_hz, Rounds::swings, rate_hz, table.broken());
    const double length = glm::length(vibration.direction);
    if (length == 0)
        messages.error(table.where("direction"), "a vibration needs a direction: write `direction = [0, 0, 1]`");
    else
        vibration.direction /= length;
    if (reach_m) vibration_reach_field(*reach_m, table.fields());
    table.report_unknown_keys();
    warn_if_idle(table, vibration.acts(), "force_n", "vibration", errors, messages);
    return vibration;
}

constexpr const char* vibration_example = "{ force_n = 0.5, frequency_hz = 80, direction = [0, 0, 1] }";

Region read_region(const toml::table& source, double rate_hz, FileMessages& messages)
{
    Region region;
    const std::size_t errors = messages.errors();
    TableReader table(source, "[[region]]", messages);
    const auto shape = table.word("shape", {"space", "ball", "box"});
    if (shape)
        region.shape = static_cast<RegionShape>(*shape);
    else if (!table.has("shape"))
        messages.error(source.source(), "a region needs a `shape`: \"space\" (everywhere), \"ball\" or \"box\"");
    region.placement = read_placement(table);

    double radius_m = 0;
    table.number("radius_m", radius_m, Quantity::length, region_size_m);
    glm::dvec3 sides_m(0);
    table.number("sides_m", sides_m, Quantity::length, region_size_m);
    const bool ball = shape && region.shape == RegionShape::ball, box = shape && region.shape == RegionShape::box;
    if (ball != table.has("radius_m") && shape)
        messages.error(table.where(ball ? "shape" : "radius_m"), ball ? "a ball needs a radius: write `radius_m = 0.02`"
                                                                      : "`radius_m` is for `shape = \"ball\"` alone");
    if (box != table.has("sides_m") && shape)
        messages.error(table.where(box ? "shape" : "sides_m"),
                       box ? "a box needs its sides: write `sides_m = [0.04, 0.04, 0.02]`"
                           : "`sides_m` is for `shape = \"box\"` alone");
    region.half_sides_m = ball ? glm::dvec3(radius_m) : 0.5 * sides_m;
    const double smallest_m = std::min({region.half_sides_m.x, region.half_sides_m.y, region.half_sides_m.z});
    region.edge_m = default_edge * smallest_m;
    region_fields(region, table.fields());
    if (table.has("edge_m") && shape && !ball && !box)
        messages.error(table.where("edge_m"), "`edge_m` is for a `shape` with a border, \"ball\" or \"box\"");
    else
        check_edge(region, table.broken());
    if (const toml::table* vibration = table.table("vibration", vibration_example))
        region.vibration = read_vibration(*vibration, rate_hz, nullptr, messages);
    table.report_unknown_keys();
    if (region.damping_n_s_per_m == 0 && !table.has("vibration") && messages.errors() == errors)
        messages.warning(source.source(), "nothing is felt in this region: give it a medium, such as "
                                          "`damping_n_s_per_m = 3`, or a `vibration = { force_n = 0.1 }`, or leave it "
                                          "out");
    return region;
}

} // namespace

Placement read_placement(TableReader& table)
{
    Placement placement;
    placement_fields(placement, table.fields());
    glm::dvec3 turn_deg(0);
    table.number("rotation_deg", turn_deg, Quantity::angle_deg, {-3600, 3600});
    placement.rotation = rotation_about_axes(turn_deg);
    return placement;
}

ObjectEffects read_object_effects(TableReader& object, double rate_hz, FileMessages& messages)
{
    ObjectEffects effects;
    effects.magnet = read_magnet(object, messages);
    if (const toml::table* source = object.table("viscosity", "{ damping_n_s_per_m = 2, reach_m = \"5mm\" }")) {
        const std::size_t errors = messages.errors();
        TableReader table(*source, "`viscosity`", messages);
        viscosity_fields(effects, table.fields());
        need(table, "damping_n_s_per_m", "a viscous medium needs its strength: write `damping_n_s_per_m = 2`",
             messages);
        need(table, "reach_m", "a viscous medium needs to end somewhere: write `reach_m = \"5mm\"`", messages);
        table.report_unknown_keys();
        warn_if_idle(table, effects.damping_n_s_per_m > 0, "damping_n_s_per_m", "viscosity", errors, messages);
    }
    if (const toml::table* source = object.table("vibration", vibration_example))
        effects.vibration = read_vibration(*source, rate_hz, &effects.vibration_reach_m, messages);
    return effects;
}

const toml::source_region& farthest_reach_at(const toml::table& object, const ObjectEffects& effects)
{
    const double farthest_m = effects.reach_m();
    const char* effect = effects.magnet.acts() && effects.magnet.reach_m == farthest_m            ? "magnet"
                         : effects.damping_n_s_per_m > 0 && effects.damping_reach_m == farthest_m ? "viscosity"
                                                                                                  : "vibration";
    const toml::node* written = object[effect]["reach_m"].node();
    return (written ? *written : object).source();
}

std::vector<Region> read_regions(const toml::table& root, double rate_hz, FileMessages& messages)
{
    std::vector<Region> regions;
    for (const toml::table* region : tables_of(root, "region", regions_max, ", each looked at in every tick", messages))
        regions.push_back(read_region(*region, rate_hz, messages));
    return regions;
}

} // namespace haptel::runtime
