#include "device/stroke.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace haptel::device {

namespace {

constexpr double two_pi = 2 * std::numbers::pi;
constexpr double circle_share = 0.15; // radius by the smaller side
constexpr double central_share = 0.6; // of each side, for scan and random
constexpr double scan_pitch_share = 0.05;

double smoothstep(double t)
{
    t = std::clamp(t, 0.0, 1.0);
    return t * t * (3 - 2 * t);
}

// Distance along a path of `length` that is walked to its end and back for ever.
double there_and_back(double distance, double length)
{
    const double phase = std::fmod(distance, 2 * length);
    return phase <= length ? phase : 2 * length - phase;
}

Curve circles(const CurveRequest& request)
{
    const glm::dvec2 side = request.box_maximum_m - request.box_minimum_m;
    const double radius = circle_share * std::min(side.x, side.y);
    const double turn_rad_per_s = radius > 0 ? request.speed_m_per_s / radius : 0;
    return [=, centre = request.anchor_m](double time_s) {
        const double angle = std::fmod(turn_rad_per_s * time_s, two_pi);
        return CurvePoint{centre + radius * glm::dvec2(std::cos(angle), std::sin(angle))};
    };
}

Curve scan(const CurveRequest& request)
{
    const glm::dvec2 side = request.box_maximum_m - request.box_minimum_m;
    const glm::dvec2 corner = request.box_minimum_m + (1 - central_share) / 2 * side;
    const double line = central_share * side.x, pitch = scan_pitch_share * side.y;
    const int steps = static_cast<int>(std::lround(central_share / scan_pitch_share));
    const double row = line + pitch; // a line and the step to the next
    const double length = steps * row + line;
    return [=, speed = request.speed_m_per_s](double time_s) {
        if (!(length > 0)) return CurvePoint{corner};
        const double distance = there_and_back(speed * time_s, length);
        const double index = row > 0 ? std::min(std::floor(distance / row), double(steps)) : 0;
        const double along = std::min(distance - index * row, line);
        const double up = std::max(distance - index * row - line, 0.0);
        const bool forward = std::fmod(index, 2) == 0;
        return CurvePoint{corner + glm::dvec2(forward ? along : line - along, index * pitch + up)};
    };
}

Curve press(const CurveRequest& request)
{
    return [=, anchor = request.anchor_m, speed = request.speed_m_per_s](double time_s) {
        const double phase_s = std::fmod(time_s, press_on_s + press_off_s);
        const bool on = phase_s < press_on_s;
        const double moved_m = std::min(speed * (on ? phase_s : phase_s - press_on_s), press_lift_m);
        const bool first = time_s < press_on_s; // has come down already
        return CurvePoint{anchor, on ? (first ? 0 : press_lift_m - moved_m) : moved_m, on ? 1.0 : 0.0};
    };
}

// SplitMix64 (Steele, Lea and Flood 2014): the same on every machine, as std::uniform_real_distribution is not.
class Random {
public:
    explicit Random(uint64_t seed) : state_(seed) {}
    double uniform(double low, double high)
    {
        state_ += 0x9e3779b97f4a7c15u;
        uint64_t z = state_;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        z ^= z >> 31;
        return low + (high - low) * (static_cast<double>(z >> 11) * 0x1p-53);
    }

private:
    uint64_t state_;
};

// Each coordinate is a sum of waves whose amplitudes sum to half of the central share.
Curve random(const CurveRequest& request)
{
    struct Wave {
        glm::dvec2 amplitude_m, rate_rad_per_s, phase_rad;
    };
    constexpr std::size_t count = 5;
    std::array<Wave, count> waves;
    Random random(request.seed);
    const glm::dvec2 reach = central_share / 2 * (request.box_maximum_m - request.box_minimum_m);
    glm::dvec2 sum{0};
    for (Wave& wave : waves) {
        for (int axis = 0; axis < 2; ++axis) {
            wave.amplitude_m[axis] = random.uniform(0.5, 1);
            wave.rate_rad_per_s[axis] = random.uniform(0.4, 1.6);
            wave.phase_rad[axis] = random.uniform(0, two_pi);
        }
        sum += wave.amplitude_m;
    }
    double mean_square_speed = 0;
    for (Wave& wave : waves) {
        wave.amplitude_m *= reach / sum;
        const glm::dvec2 speed = wave.amplitude_m * wave.rate_rad_per_s;
        mean_square_speed += dot(speed, speed) / 2;
    }
    const double haste = mean_square_speed > 0 ? request.speed_m_per_s / std::sqrt(mean_square_speed) : 0;
    const glm::dvec2 centre = (request.box_minimum_m + request.box_maximum_m) / 2.0;
    return [=](double time_s) {
        glm::dvec2 xy = centre;
        for (const Wave& wave : waves)
            xy += wave.amplitude_m * glm::sin(wave.rate_rad_per_s * (haste * time_s) + wave.phase_rad);
        return CurvePoint{xy};
    };
}

constexpr std::array<std::string_view, 4> names = {"circles", "scan", "press", "random"};

} // namespace

std::span<const std::string_view> stroke_names()
{
    return names;
}

Curve make_curve(std::string_view name, const CurveRequest& request)
{
    if (name == "circles") return circles(request);
    if (name == "scan") return scan(request);
    if (name == "press") return press(request);
    if (name == "random") return random(request);
    return {};
}

std::optional<runtime::SurfaceHit> nearest_hit(const SurfaceBelow& surface, glm::dvec2 box_minimum_m,
                                               glm::dvec2 box_maximum_m)
{
    const glm::dvec2 centre = (box_minimum_m + box_maximum_m) / 2.0;
    if (const auto hit = surface(centre.x, centre.y)) return hit;
    constexpr int cells = 100;
    std::optional<runtime::SurfaceHit> nearest;
    double nearest_m = HUGE_VAL;
    for (int i = 0; i <= cells; ++i)
        for (int j = 0; j <= cells; ++j) {
            const glm::dvec2 xy = glm::mix(box_minimum_m, box_maximum_m, glm::dvec2(i, j) / double(cells));
            const double distance_m = glm::distance(xy, centre);
            if (distance_m >= nearest_m) continue;
            if (const auto hit = surface(xy.x, xy.y)) nearest = hit, nearest_m = distance_m;
        }
    return nearest;
}

Stroke::Stroke(Curve curve, SurfaceBelow surface, const runtime::SurfaceHit& start)
    : curve_(std::move(curve)), surface_(std::move(surface)), last_(start)
{
}

StrokeTarget Stroke::at(double time_s)
{
    // The curve's clock stands still during the approach and gathers way during the onset: its integral of smoothstep.
    const double onset = std::clamp((time_s - approach_s) / press_onset_s, 0.0, 1.0);
    const double gathered_s = press_onset_s * onset * onset * onset * (1 - onset / 2);
    const double curve_s = gathered_s + std::max(time_s - approach_s - press_onset_s, 0.0);

    const CurvePoint curve = curve_(curve_s);
    if (const auto hit = surface_(curve.xy_m.x, curve.xy_m.y)) last_ = *hit;
    const double above_m = curve.lift_m + approach_m * (1 - smoothstep(time_s / approach_s));
    return {last_.point_m + glm::dvec3(0, 0, above_m), last_.facet_normal, curve.press * smoothstep(onset)};
}

} // namespace haptel::device
