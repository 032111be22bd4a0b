#include "jit/texture/envelope.h"

#include "jit/texture/object_points.h"
#include "lang/abi/outputs.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

namespace haptel::jit {

namespace {

// Operations in all: 10 to 30 ms, however slow the texture is; and calls, of which a third are of climbs.
constexpr uint64_t operations_most = 4'000'000, calls_least = 48, calls_most = 6000;
constexpr uint64_t operations_of_few = 50'000, calls_of_few = 200; // a quarter of a millisecond
constexpr size_t climbs_most = 8;                                  // to each end
constexpr double first_step = 1.0 / 64;                            // of the box
constexpr double after_success = 1.4, after_failure = 0.3;

// Of an end that is not bounded, or by more than the object's size: where a climb comes so many times as far from the
// middle as the places did, or farther than the object is wide, it climbs a pole, and the end is so many times as far
// as a quarter of the places are.
constexpr double is_pole = 8, before_pole = 16;

// A range is proven well enough if it is no wider than so many times the one found: sums of octaves, whose peaks hardly
// ever meet, are proven to twice what anybody finds, and are felt well. So is one that lowers the surface by no more
// than a tenth of what a hand sinks in that presses with 1 N on 1000 N/m.
constexpr double wide_proof = 3, deep_proof_m = 0.1e-3;
// Of the range found: heights up to so far beyond are felt as they are, and a shoulder goes on from there.
constexpr double margin = 0.2, shoulder = 0.2;
// Nothing was found where all heights were equal; so much is felt of what a search missed.
constexpr double least_range_m = 1e-6;

constexpr FoundHeights nothing_found{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};

// Then it is what is felt; and so it is if more is found.
bool is_proven_well(const haptel_facts& facts, const FoundHeights& found)
{
    return facts.height_max_m - facts.height_min_m <= wide_proof * (found.maximum_m - found.minimum_m) ||
           (facts.height_min_m >= found.minimum_m - deep_proof_m &&
            facts.height_max_m <= found.maximum_m + deep_proof_m);
}

haptel_sample sampled(const TextureBinding& binding, const haptel_point& point, FoundHeights& found)
{
    haptel_sample result = blank_sample;
    binding.texture->height_gradient(&point, binding.block, &result);
    found.minimum_m = std::min(found.minimum_m, result.height_m);
    found.maximum_m = std::max(found.maximum_m, result.height_m);
    return result;
}

class HeightSearch {
public:
    HeightSearch(const TextureBinding& of, const TextureRequest& over) : binding(of), request(over)
    {
        for (int k = 0; k < 3; ++k) side_m = std::max(side_m, request.box_maximum_m[k] - request.box_minimum_m[k]);
        if (!(side_m > 0)) side_m = 1;
        for (int k = 0; k < 2; ++k) {
            const double width = request.uv.maximum[k] - request.uv.minimum[k];
            uv_side[k] = std::isfinite(width) && width > 0 ? width : 1;
        }
    }

    FoundHeights heights(const FindPlaces& places_of, Search how_far)
    {
        const uint64_t operations = std::max<uint64_t>(binding.facts.operations_max, 1);
        const uint64_t calls = std::clamp(operations_most / operations, calls_least, calls_most);
        ObjectPoints points(request);
        std::vector<Seen> seen;
        for (uint64_t i = 0; i < 2 * calls / 3; ++i) {
            const haptel_point point = points.next();
            seen.push_back({point, sample(point).height_m, i});
            if (how_far == Search::until_clear && proof_will_do()) return found;
        }
        const FoundHeights of_places = found;
        const LikelyPlaces places = places_of();
        const size_t climbs = std::clamp<size_t>(calls / 6 / 20, 1, climbs_most);
        const auto steps = static_cast<int>(calls / 6 / climbs);
        climb(places.highest, 1, steps);
        climb(places.lowest, -1, steps);
        const auto climb_from = [&](auto higher, double uphill) {
            const auto end = seen.begin() + static_cast<std::ptrdiff_t>(std::min(climbs, seen.size()));
            std::partial_sort(seen.begin(), end, seen.end(), [&](const Seen& a, const Seen& b) {
                return higher(a.height_m, b.height_m) || (a.height_m == b.height_m && a.number < b.number);
            });
            for (auto start = seen.begin(); start != end; ++start) climb(start->point, uphill, steps);
        };
        climb_from(std::greater<>(), 1);
        climb_from(std::less<>(), -1);

        const auto quantile = [&](std::size_t parts, auto value_of) {
            std::vector<double> values;
            for (const Seen& one : seen) values.push_back(value_of(one.height_m));
            const auto at = values.begin() + static_cast<std::ptrdiff_t>(values.size() / parts);
            std::nth_element(values.begin(), at, values.end());
            return *at;
        };
        const double middle_m = quantile(2, [](double height_m) { return height_m; });
        const double far_m = before_pole * quantile(4, [&](double height_m) { return std::fabs(height_m - middle_m); });
        const auto before = [&](double& end_m, double of_places_m, double proven_m, double way) {
            const double away_m = way * (end_m - middle_m);
            const bool is_climbed = away_m > is_pole * way * (of_places_m - middle_m) || away_m > side_m;
            if (far_m > 0 && is_climbed && way * (proven_m - middle_m) > side_m)
                end_m = middle_m + way * std::min(far_m, away_m);
        };
        before(found.maximum_m, of_places.maximum_m, binding.facts.height_max_m, 1);
        before(found.minimum_m, of_places.minimum_m, binding.facts.height_min_m, -1);
        return found;
    }

private:
    struct Seen {
        haptel_point point;
        double height_m;
        uint64_t number;
    };

    const TextureBinding& binding;
    const TextureRequest& request;
    double side_m = 0, uv_side[2];
    FoundHeights found = nothing_found;

    // Whatever else is found: nothing that was found is taken back where the proof is no wider than the object.
    bool proof_will_do() const
    {
        return binding.facts.height_max_m - binding.facts.height_min_m <= side_m &&
               is_proven_well(binding.facts, found);
    }

    haptel_sample sample(const haptel_point& point) { return sampled(binding, point, found); }

    // The point `way` farther, within the box: coordinates of the mesh and normals go along, so that what reads them
    // alone is climbed as well.
    haptel_point moved(const haptel_point& from, const double (&way_m)[3]) const
    {
        haptel_point to = from;
        double length = 0;
        for (int k = 0; k < 3; ++k) {
            to.p[k] = std::clamp(from.p[k] + way_m[k], request.box_minimum_m[k], request.box_maximum_m[k]);
            to.n[k] = from.n[k] + way_m[k] / side_m;
            length += to.n[k] * to.n[k];
            for (int j = 0; j < 3; ++j) to.n_dp[k][j] = k == j ? 1 / side_m : 0;
        }
        if (length > 0)
            for (double& n : to.n) n /= std::sqrt(length);
        for (int k = 0; k < 2; ++k) {
            to.uv[k] = from.uv[k] + way_m[k] / side_m * uv_side[k];
            if (std::isfinite(request.uv.minimum[k]) && std::isfinite(request.uv.maximum[k]))
                to.uv[k] = std::clamp(to.uv[k], request.uv.minimum[k], request.uv.maximum[k]);
            for (int j = 0; j < 3; ++j) to.uv_dp[k][j] = k == j ? uv_side[k] / side_m : 0;
        }
        return to;
    }

    // Uphill 1, or downhill -1, by steps that grow while they succeed.
    void climb(const haptel_point& start, double uphill, int steps)
    {
        haptel_point at = moved(start, {0, 0, 0});
        haptel_sample here = sample(at);
        double step_m = first_step * side_m;
        for (int i = 1; i < steps; ++i) {
            double way_m[3], slope = 0;
            for (int k = 0; k < 3; ++k) {
                way_m[k] = uphill * here.gradient[k];
                // A flat box has no way across it, and none leads out of one whose normals and coordinates stay.
                const bool is_flat = request.box_maximum_m[k] == request.box_minimum_m[k];
                if (is_flat && !(binding.texture->reads & (HAPTEL_READS_NORMAL | HAPTEL_READS_UV))) way_m[k] = 0;
                slope += way_m[k] * way_m[k];
            }
            slope = std::sqrt(slope);
            if (!(slope > 0) || !std::isfinite(slope)) return;
            for (double& way : way_m) way *= step_m / slope;
            const haptel_point there = moved(at, way_m);
            const haptel_sample next = sample(there);
            const bool is_higher = uphill * (next.height_m - here.height_m) > 0;
            step_m *= is_higher ? after_success : after_failure;
            if (is_higher) at = there, here = next;
        }
    }
};

FoundHeights heights_of_few(const TextureBinding& binding, const TextureRequest& request)
{
    const uint64_t operations = std::max<uint64_t>(binding.facts.operations_max, 1);
    FoundHeights heights = nothing_found;
    ObjectPoints points(request);
    for (uint64_t left = std::clamp(operations_of_few / operations, calls_least, calls_of_few); left > 0; --left)
        sampled(binding, points.next(), heights);
    return heights;
}

} // namespace

FoundHeights find_heights(const TextureBinding& binding, const TextureRequest& request, const FindPlaces& places,
                          Search how_far)
{
    return HeightSearch(binding, request).heights(places, how_far);
}

bool give_envelope(TextureBinding& binding, const FoundHeights& found)
{
    haptel_facts& facts = binding.facts;
    const double found_m = found.maximum_m - found.minimum_m, proven_m = facts.height_max_m - facts.height_min_m;
    if (is_proven_well(facts, found)) return false;
    if (found_m == 0 && std::isfinite(proven_m)) return false; // what there is lies where nobody looked
    const double range_m = std::max(found_m, least_range_m), reach_m = (margin + 0.5 * shoulder) * range_m;
    const double least_excess_m = std::max(reach_m, deep_proof_m);
    if (facts.height_min_m < found.minimum_m - least_excess_m) {
        facts.height_min_m = found.minimum_m - reach_m;
        binding.shoulder_m[0] = shoulder * range_m;
    }
    if (facts.height_max_m > found.maximum_m + least_excess_m) {
        facts.height_max_m = found.maximum_m + reach_m;
        binding.shoulder_m[1] = shoulder * range_m;
    }
    return binding.shoulder_m[0] > 0 || binding.shoulder_m[1] > 0;
}

bool stretch_envelope(TextureBinding& binding, const TextureBinding& before, const TextureRequest& request)
{
    haptel_facts& facts = binding.facts;
    const auto range_of = [](const haptel_facts& of) { return of.height_max_m - of.height_min_m; };
    const double range_before_m = range_of(before.facts);
    const bool is_found = before.shoulder_m[0] > 0 || before.shoulder_m[1] > 0;
    if (!is_found && range_of(facts) <= wide_proof * range_before_m) return true;
    const FoundHeights then = heights_of_few(before, request), now = heights_of_few(binding, request);
    const double stretch = (now.maximum_m - now.minimum_m) / (then.maximum_m - then.minimum_m);
    const bool is_stretched = stretch > 0 && std::isfinite(stretch);
    if (is_found) {
        if (!is_stretched) return false;
        const double minimum_m = now.minimum_m - stretch * (then.minimum_m - before.facts.height_min_m),
                     maximum_m = now.maximum_m + stretch * (before.facts.height_max_m - then.maximum_m);
        if (before.shoulder_m[0] > 0 && facts.height_min_m < minimum_m) {
            facts.height_min_m = minimum_m;
            binding.shoulder_m[0] = stretch * before.shoulder_m[0];
        }
        if (before.shoulder_m[1] > 0 && facts.height_max_m > maximum_m) {
            facts.height_max_m = maximum_m;
            binding.shoulder_m[1] = stretch * before.shoulder_m[1];
        }
    }
    // A short proof can be far too wide, where a longer one is not: of a surface so low nobody would feel anything.
    const double usual_m = std::max(is_stretched ? stretch : 1, 1.0) * range_before_m;
    if (range_of(facts) > wide_proof * usual_m && !is_proven_well(facts, now)) return false;
    return std::isfinite(range_of(facts)) && range_of(facts) >= 0.5 * (binding.shoulder_m[0] + binding.shoulder_m[1]);
}

} // namespace haptel::jit
