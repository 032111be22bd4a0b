#include "lang/ir/bounds/bounds.h"

#include "lang/abi/contact_limits.h"
#include "lang/ir/bounds/interval_evaluator.h"
#include "lang/ir/cost.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <queue>

namespace haptel::ir {
namespace {

constexpr uint64_t operations_per_evaluation = 1'000'000;
constexpr uint64_t operations_of_derivatives = 5'000'000; // more than operations_of_check: calls count, too
// Instructions, of the longest programs that are looked at as closely: of longer ones every step costs more, so that
// fewer are taken.
constexpr uint64_t usual_extent = 2'500;
// A height in metres, a slope or a curvature per metre beyond this says as little as none: no piece that holds a pole
// is small enough yet, and cutting goes on although nothing improves.
constexpr double useless = 1e9;
// Twenty of each side of a place in space: a millionth of the box.
constexpr int cuts_of_dive = 60;
constexpr uint64_t looks_per_proof = 4; // by operations: a dive, or all points for facts
// At which declared facts are tried: enough for what is wrong in a tenth of the box, and a fraction of the time that
// bounds take.
constexpr uint32_t points_for_facts = 64;

// "hollow" of "d resolved hollow(vec2)"
std::string source_name(const std::string& name)
{
    const std::string head = name.substr(0, name.find_first_of("(<"));
    return head.substr(head.rfind(' ') + 1);
}

// Upper bounds to push down: of one result and of its negative; of slope and curvature; 1 where a fault may be, else 0.
enum class Goal : uint8_t { result, variation, no_faults };

// The box, cut into pieces: the one that holds the greatest bound is cut next, for each bound in turn.
class Bisection {
public:
    // `result` of the body: 0 is the height, then the outputs.
    Bisection(const Module& module, const Texture& texture, BoundsBox around, Goal which, size_t result = 0,
              uint64_t operations = operations_of_derivatives)
        : evaluator(module, operations_per_evaluation)
        , entry(texture.body)
        , of_result(result)
        , box(std::move(around))
        , goal(which)
        , operations_of_look(operations / looks_per_proof)
        , queues(goal == Goal::no_faults ? 1 : 2)
    {
        const uint64_t extent = instructions_reached(module, entry);
        operations_left = extent > usual_extent ? operations * usual_extent / extent : operations;
        std::set<Input> read;
        for_each_instruction(module.functions[entry].body, [&](const Instruction& made) {
            if (auto* input = std::get_if<ReadInput>(&made.kind)) read.insert(input->input);
        });
        for (Input input : read) consider(&box.input[static_cast<size_t>(input)]);
        for (size_t i = 0; i < box.parameters.size(); ++i)
            if (texture.parameters[i].type == Type::real) consider(&box.parameters[i]);
        std::vector<Interval> all;
        for (const Interval* side : sides) all.push_back(*side);
        add(std::move(all));
    }

    void run(uint32_t evaluations)
    {
        std::vector<double> before(queues.size(), infinity);
        uint32_t limit = evaluations;
        for (uint32_t target = 16; !is_settled; target *= 2) {
            while (pieces.size() < std::min(target, limit) && !is_settled) cut();
            bool has_improved = false;
            for (size_t i = 0; i < queues.size(); ++i) {
                if (!is_wanted(i)) continue;
                const double now = bound(i);
                has_improved |= target == 16 || now > useless || now < before[i] - 0.05 * std::fabs(before[i]);
                // within reason: what has a pole takes more pieces, to come to a bound at all and after it
                if (now > useless)
                    limit = std::min(4 * evaluations, static_cast<uint32_t>(pieces.size()) + 2 * evaluations);
                before[i] = now;
            }
            if (pieces.size() >= limit || !has_improved) break;
        }
    }

    // Cuts what may fault until nothing is left that may; false if something is.
    bool excludes_faults(uint32_t evaluations)
    {
        while (bound(0) > 0 && !is_settled && pieces.size() < evaluations) cut();
        return bound(0) == 0;
    }

    // Evaluates single points, evenly spread: facts that are false may show there. Fewer where one takes long.
    void look_at_points(uint32_t count)
    {
        operations_left = operations_of_look;
        double root = 1; // of x^(n + 1) = x + 1 for n sides: one is the golden ratio (Roberts' sequence)
        for (int i = 0; i < 40; ++i) root = std::pow(1 + root, 1 / (static_cast<double>(sides.size()) + 1));
        for (uint32_t k = 1; k <= count && operations_left > 0; ++k) {
            double step = 1 / root;
            for (size_t i = 0; i < sides.size(); ++i, step /= root) {
                const Interval& all = pieces[0].sides[i];
                const double at = all.minimum + std::fmod(0.5 + k * step, 1.0) * (all.maximum - all.minimum);
                *sides[i] = {at, at};
            }
            evaluator.run_varying(entry, box, IntervalEvaluator::Sought::curvature);
            spend();
        }
    }

    // Into the piece of the greatest bound, as far as f64 and patience go.
    void dive(size_t which, double (&place)[input_count])
    {
        size_t at = next_of(queues[which]);
        operations_left = operations_of_look;
        for (int cuts = 0; cuts < cuts_of_dive && operations_left > 0; ++cuts) {
            if (!halve(at)) break;
            at = pieces.size() - (pieces.end()[-2].bounds[which] > pieces.back().bounds[which] ? 2 : 1);
        }
        for (size_t input = 0; input < input_count; ++input) {
            const auto side = std::find(sides.begin(), sides.end(), &box.input[input]);
            if (side == sides.end()) continue;
            const Interval& middle_of = pieces[at].sides[static_cast<size_t>(side - sides.begin())];
            place[input] = middle_of.minimum / 2 + middle_of.maximum / 2;
        }
    }

    double bound(size_t which) { return pieces[next_of(queues[which])].bounds[which]; }
    bool may_be_nan() const
    {
        return std::ranges::any_of(pieces, [](const Piece& piece) { return !piece.is_cut && piece.may_be_nan; });
    }
    // Of the box in one piece, where the goal is of derivatives.
    const Variation& over_all() const { return whole; }
    const IntervalEvaluator::Findings& found_over_all() const { return of_whole; }
    const IntervalEvaluator::Findings& found() const { return evaluator.findings(); }

private:
    struct Piece {
        std::vector<Interval> sides;
        std::vector<double> bounds; // -infinity where the piece holds no value at all
        bool may_be_nan = false, is_cut = false;
    };
    using Queue = std::priority_queue<std::pair<double, size_t>>; // bound, piece

    IntervalEvaluator evaluator;
    uint32_t entry;
    size_t of_result;
    BoundsBox box;
    Goal goal;
    uint64_t operations_left, operations_of_look;
    std::vector<Interval*> sides; // of `box` that can be cut
    std::vector<Piece> pieces;
    std::vector<Queue> queues; // by bound
    Variation whole;
    IntervalEvaluator::Findings of_whole;
    size_t turn = 0;
    bool is_settled = false;

    void consider(Interval* side)
    {
        if (std::isfinite(side->maximum - side->minimum) && !side->is_point()) sides.push_back(side);
    }

    void add(std::vector<Interval> where)
    {
        for (size_t i = 0; i < sides.size(); ++i) *sides[i] = where[i];
        Interval value;
        Piece piece{std::move(where), {}};
        if (goal == Goal::result) {
            value = evaluator.run(entry, {}, &box)[of_result];
            piece.bounds = {value.maximum, -value.minimum};
        } else {
            using enum IntervalEvaluator::Sought;
            const auto [values, variations] = evaluator.run_varying(entry, box,
                                                                    goal == Goal::no_faults ? slope
                                                                    : pieces.empty()        ? continuity
                                                                    : is_wanted(1)          ? curvature
                                                                                            : slope);
            value = values[0];
            const bool may_fault = variations[0].may_fault || !std::ranges::all_of(values, &Interval::is_finite);
            if (pieces.empty()) whole = variations[0], of_whole = evaluator.findings();
            piece.bounds = {variations[0].slope, is_wanted(1) ? variations[0].curvature : whole.curvature};
            if (goal == Goal::no_faults) piece.bounds = {may_fault ? 1.0 : 0.0};
        }
        spend();
        piece.may_be_nan = value.may_be_nan;
        for (size_t i = 0; i < queues.size(); ++i) {
            if (value.is_empty()) piece.bounds[i] = -infinity;
            queues[i].emplace(piece.bounds[i], pieces.size());
        }
        pieces.push_back(std::move(piece));
    }

    void spend() { operations_left -= std::min(operations_left, evaluator.operations_used() + 1); }

    // A curvature is of a gradient without jumps; of others it is not looked for, only told as it comes.
    bool is_wanted(size_t bound) const
    {
        return goal != Goal::variation || bound == 0 || whole.continuity >= Continuity::c1;
    }

    size_t next_of(Queue& queue)
    {
        while (pieces[queue.top().second].is_cut) queue.pop();
        return queue.top().second;
    }

    void cut()
    {
        while (!is_wanted(turn % queues.size())) ++turn;
        const size_t chosen = next_of(queues[turn++ % queues.size()]);
        is_settled = operations_left == 0 || !halve(chosen); // too long, or too small to cut
    }

    // False where it is too small to be cut.
    bool halve(size_t chosen)
    {
        std::vector<Interval> left = pieces[chosen].sides, right = left;
        size_t widest = sides.size();
        double widest_share = 0;
        for (size_t i = 0; i < sides.size(); ++i) {
            const Interval& all = pieces[0].sides[i];
            const double share = (left[i].maximum - left[i].minimum) / (all.maximum - all.minimum);
            if (share > widest_share) widest = i, widest_share = share;
        }
        if (widest == sides.size()) return false;
        pieces[chosen].is_cut = true;
        const double middle = left[widest].minimum / 2 + left[widest].maximum / 2;
        left[widest].maximum = right[widest].minimum = middle;
        add(std::move(left));
        add(std::move(right));
        return true;
    }
};

Interval result_bounds(const Module& module, const Texture& texture, const BoundsBox& box, uint32_t evaluations,
                       size_t result, uint64_t operations = operations_of_check,
                       std::function<HeightPlaces()>* places = nullptr)
{
    const auto bisection = std::make_shared<Bisection>(module, texture, box, Goal::result, result, operations);
    bisection->run(evaluations);
    if (places)
        *places = [bisection] {
            HeightPlaces found;
            bisection->dive(0, found.highest);
            bisection->dive(1, found.lowest);
            return found;
        };
    return {-bisection->bound(1), bisection->bound(0), bisection->may_be_nan()};
}

} // namespace

Interval height_bounds(const Module& module, const Texture& texture, const BoundsBox& box, uint32_t evaluations,
                       uint64_t operations, std::function<HeightPlaces()>* places)
{
    Interval height = result_bounds(module, texture, box, evaluations, 0, operations, places);
    if (height.is_empty()) height = {0, 0, true};
    height.may_be_nan |= !height.is_finite();
    if (height.may_be_nan) height = {std::min(height.minimum, 0.0), std::max(height.maximum, 0.0), true};
    return height;
}

void set_contact(BoundsBox& box)
{
    const auto set = [&](Input first, size_t count, Interval interval) {
        std::fill_n(box.input + static_cast<size_t>(first), count, interval);
    };
    set(Input::velocity_x, 3, {-contact_speed_max_m_per_s, contact_speed_max_m_per_s});
    set(Input::normal_force, 1, {0, normal_force_max_n});
    set(Input::tool_radius, 1, {0, tool_radius_max_m});
    set(Input::tangent_x, 3, {-1, 1});
    set(Input::bitangent_x, 3, {-1, 1});
    set(Input::curvature, 1, {-curvature_max_per_m, curvature_max_per_m});
}

std::vector<Interval> output_bounds(const Module& module, const Texture& texture, const BoundsBox& box,
                                    uint32_t evaluations)
{
    std::vector<Interval> outputs;
    for (size_t result = 1; result < module.functions[texture.body].body.yields.size(); ++result)
        outputs.push_back(result_bounds(module, texture, box, evaluations, result));
    return outputs;
}

TextureBounds texture_bounds(const Module& module, const Texture& texture, const BoundsBox& box, uint32_t evaluations)
{
    TextureBounds bounds{height_bounds(module, texture, box, evaluations), 0, 0, Continuity::unknown, {}, {}};
    Bisection bisection(module, texture, box, Goal::variation);
    bisection.run(evaluations);
    bounds.slope_max = std::max(0.0, bisection.bound(0));
    bounds.curvature_max_per_m = std::max(0.0, bisection.bound(1));
    bounds.continuity = bisection.over_all().continuity;
    bounds.cause = bisection.over_all().cause;
    for (uint32_t function : bisection.found_over_all().believed) {
        const std::string name = source_name(module.functions[function].name);
        if (std::find(bounds.declared.begin(), bounds.declared.end(), name) == bounds.declared.end())
            bounds.declared.push_back(name);
    }
    if (!bounds.declared.empty()) bisection.look_at_points(points_for_facts);
    for (const auto& [where, fact] : bisection.found().contradicted) bounds.contradicted.push_back(fact);
    return bounds;
}

std::vector<Undefined> undefined_in(const Module& module, const Texture& texture, const BoundsBox& box,
                                    uint32_t evaluations)
{
    // Large, and still no overflow of what an author would compute from it.
    constexpr double some_number = 1e15;
    BoundsBox bounded = box;
    for (Interval& input : bounded.input)
        input = {std::max(input.minimum, -some_number), std::min(input.maximum, some_number)};
    Bisection bisection(module, texture, std::move(bounded), Goal::no_faults);
    return bisection.excludes_faults(evaluations) ? std::vector<Undefined>{} : bisection.found_over_all().undefined;
}

} // namespace haptel::ir
