#include "runtime/files/motion_reader.h"

#include "runtime/scene/validation.h"

namespace haptel::runtime {

MotionText read_motion(TableReader& table, const Placement& start, double rate_hz, FileMessages& messages)
{
    const std::size_t errors = messages.errors();
    glm::dvec3 spin_deg_per_s(0);
    SteadyMotion::Figures figures;
    table.number("spin_deg_per_s", spin_deg_per_s, Quantity::turning_deg_per_s, {-36'000, 36'000});
    swing_fields(figures, table.fields());
    if (table.has("swing_m") != table.has("swing_hz"))
        messages.error(table.where(table.has("swing_m") ? "swing_m" : "swing_hz"),
                       "an object swings by `swing_m = [x, y, z]` at `swing_hz`: write both");
    const double swing_m = glm::length(figures.swing_m);
    if (table.has("swing_m") && swing_m == 0 && messages.errors() == errors)
        messages.warning(table.where("swing_m"), "`swing_m` is 0, so that this object does not swing: write more than "
                                                 "0, or leave `swing_m` and `swing_hz` out");
    check_rounds("swing_hz", figures.swing_hz, Rounds::swings, rate_hz, table.broken());
    const double rate_deg_per_s = glm::length(spin_deg_per_s);
    check_rounds("spin_deg_per_s", rate_deg_per_s, Rounds::turns, rate_hz, table.broken());
    if (rate_deg_per_s > 0) {
        figures.axis = spin_deg_per_s / rate_deg_per_s;
        figures.spin_rad_per_s = glm::radians(rate_deg_per_s);
    }
    MotionText text{nullptr, swing_m, table.where("swing_m")};
    if (rate_deg_per_s > 0 || swing_m > 0) text.motion = std::make_shared<SteadyMotion>(start, figures);
    return text;
}

} // namespace haptel::runtime
