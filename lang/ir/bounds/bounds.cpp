#include "lang/ir/bounds/bounds.h"

#include "lang/ir/bounds/interval_evaluator.h"
#include "lang/ir/cost.h"

#include <algorithm>
#include <cmath>
#include <queue>

namespace haptel::ir {
namespace {

constexpr uint64_t operations_per_evaluation = 1'000'000;
constexpr uint64_t operations_in_all = 4'000'000; // keeps a reload short, whatever the program
// Instructions, of the longest programs that are looked at as closely: of longer ones every step costs more, so that
// fewer are taken.
constexpr uint64_t usual_extent = 5'000;
// A height in metres, a slope or a curvature per metre beyond this says as little as none: no piece that holds a pole
// is small enough yet, and cutting goes on although nothing improves.
constexpr double useless = 1e9;
// At which declared facts are tried: enough for what is wrong in a tenth of the box, and a fraction of the time that
// bounds take.
constexpr uint32_t points_for_facts = 64;

// "hollow" of "d resolved hollow(vec2)"
std::string source_name(const std::string& name)
{
    const std::string head = name.substr(0, name.find_first_of("(<"));
    return head.substr(head.rfind(' ') + 1);
}

// An upper bound to push down, of one piece of the box: -infinity where the piece holds no value at all.
enum class Goal : uint8_t { highest, lowest, slope, curvature, faults }; // faults: 1 where one may be, else 0

// The box, cut into pieces: the one that holds the greatest bound is cut next, for each goal in turn.
class Bisection {
public:
    // `result` of the body: 0 is the height, then the outputs.
    Bisection(const Module& module, const Texture& texture, BoundsBox around, std::vector<Goal> which,
              size_t result = 0)
        : evaluator(module, operations_per_evaluation)
        , entry(texture.body)
        , of_result(result)
        , box(std::move(around))
        , goals(std::move(which))
        , queues(goals.size())
    {
        const uint64_t extent = instructions_reached(module, entry);
        if (extent > usual_extent) operations_left = operations_in_all * usual_extent / extent;
        std::vector<bool> is_read(input_count, false);
        for_each_instruction(module.functions[entry].body, [&](const Instruction& made) {
            if (auto* read = std::get_if<ReadInput>(&made.kind)) is_read[static_cast<size_t>(read->input)] = true;
        });
        for (size_t i = 0; i < input_count; ++i)
            if (is_read[i]) consider(&box.input[i]);
        for (size_t i = 0; i < box.parameters.size(); ++i)
            if (texture.parameters[i].type == Type::real) consider(&box.parameters[i]);
        std::vector<Interval> all;
        for (const Interval* side : sides) all.push_back(*side);
        add(std::move(all));
    }

    void run(uint32_t evaluations)
    {
        std::vector<double> before(goals.size(), infinity);
        uint32_t limit = evaluations;
        for (uint32_t target = 16; !sides.empty() && !is_settled; target *= 2) {
            while (pieces.size() < std::min(target, limit) && operations_left > 0 && !is_settled) cut();
            bool has_improved = false;
            for (size_t g = 0; g < goals.size(); ++g) {
                if (!is_wanted(g)) continue;
                const double now = bound(g);
                has_improved |= target == 16 || now > useless || now < before[g] - 0.05 * std::fabs(before[g]);
                if (now >
                    useless) // within reason: what has a pole takes more pieces, to come to a bound at all and after it
                    limit = std::min(4 * evaluations, static_cast<uint32_t>(pieces.size()) + 2 * evaluations);
                before[g] = now;
            }
            if (pieces.size() >= limit || operations_left == 0 || !has_improved) break;
        }
    }

    // Cuts what may fault until nothing is left that may; false if something is.
    bool excludes_faults(uint32_t evaluations)
    {
        while (bound(0) > 0 && !sides.empty() && !is_settled && pieces.size() < evaluations && operations_left > 0)
            cut();
        return bound(0) == 0;
    }

    // Evaluates single points, evenly spread: facts that are false may show there.
    void look_at_points(uint32_t count)
    {
        double root = 1; // of x^(n + 1) = x + 1 for n sides: one is the golden ratio (Roberts' sequence)
        for (int i = 0; i < 40; ++i) root = std::pow(1 + root, 1 / (static_cast<double>(sides.size()) + 1));
        for (uint32_t k = 1; k <= count; ++k) {
            double step = 1 / root;
            for (size_t i = 0; i < sides.size(); ++i, step /= root) {
                const Interval& all = pieces[0].sides[i];
                const double at = all.minimum + std::fmod(0.5 + k * step, 1.0) * (all.maximum - all.minimum);
                *sides[i] = {at, at};
            }
            evaluator.run_varying(entry, box, false);
        }
    }

    double bound(size_t goal) { return pieces[next_of(queues[goal])].bounds[goal]; }
    bool may_be_nan() const
    {
        return std::any_of(pieces.begin(), pieces.end(),
                           [](const Piece& piece) { return !piece.is_cut && piece.may_be_nan; });
    }
    // Of the box in one piece, where the goals are of derivatives.
    const Variation& over_all() const { return whole; }
    const std::vector<Undefined>& undefined_over_all() const { return undefined; }
    const std::set<uint32_t>& believed_over_all() const { return believed; }
    const auto& contradicted() const { return evaluator.contradicted(); }

private:
    struct Piece {
        std::vector<Interval> sides;
        std::vector<double> bounds; // by goal
        bool may_be_nan = false, is_cut = false;
    };
    using Queue = std::priority_queue<std::pair<double, size_t>>; // bound, piece

    IntervalEvaluator evaluator;
    uint32_t entry;
    size_t of_result;
    BoundsBox box;
    std::vector<Goal> goals;
    std::vector<Interval*> sides; // of `box` that can be cut
    std::vector<Piece> pieces;
    std::vector<Queue> queues; // by goal
    Variation whole;
    std::vector<Undefined> undefined;
    std::set<uint32_t> believed;
    uint64_t operations_left = operations_in_all;
    size_t turn = 0;
    bool is_settled = false;

    void consider(Interval* side)
    {
        if (std::isfinite(side->maximum - side->minimum) && !side->is_point()) sides.push_back(side);
    }

    void add(std::vector<Interval> where)
    {
        for (size_t i = 0; i < sides.size(); ++i) *sides[i] = where[i];
        const bool of_height = goals[0] == Goal::highest;
        Interval height;
        Variation variation;
        bool may_fault = false;
        if (of_height) {
            height = evaluator.run(entry, {}, &box)[of_result];
        } else {
            IntervalEvaluator::Results results =
                evaluator.run_varying(entry, box, pieces.empty() && goals[0] == Goal::slope);
            height = results.values[0];
            variation = results.variations[0];
            const auto is_finite = [](const Interval& value) { return value.is_finite(); };
            may_fault = !std::all_of(results.values.begin(), results.values.end(), is_finite) || variation.may_fault;
            if (pieces.empty()) whole = variation, undefined = evaluator.undefined(), believed = evaluator.believed();
        }
        operations_left -= std::min(operations_left, evaluator.operations_used() + 1);
        Piece piece{std::move(where), {}, height.may_be_nan, false};
        for (size_t g = 0; g < goals.size(); ++g) {
            const double found = goals[g] == Goal::highest  ? height.maximum
                                 : goals[g] == Goal::lowest ? -height.minimum
                                 : goals[g] == Goal::slope  ? variation.slope
                                 : goals[g] == Goal::faults ? may_fault
                                                            : variation.curvature;
            piece.bounds.push_back(height.is_empty() ? -infinity : found);
            queues[g].emplace(piece.bounds[g], pieces.size());
        }
        pieces.push_back(std::move(piece));
    }

    // A curvature is of a gradient without jumps; of others it is not looked for, only told as it comes.
    bool is_wanted(size_t goal) const { return goals[goal] != Goal::curvature || whole.continuity >= Continuity::c1; }

    size_t next_of(Queue& queue)
    {
        while (pieces[queue.top().second].is_cut) queue.pop();
        return queue.top().second;
    }

    void cut()
    {
        while (!is_wanted(turn % goals.size())) ++turn;
        const size_t chosen = next_of(queues[turn++ % goals.size()]);
        std::vector<Interval> left = pieces[chosen].sides, right = left;
        size_t widest = sides.size();
        double widest_share = 0;
        for (size_t i = 0; i < sides.size(); ++i) {
            const Interval& all = pieces[0].sides[i];
            const double share = (left[i].maximum - left[i].minimum) / (all.maximum - all.minimum);
            if (share > widest_share) widest = i, widest_share = share;
        }
        if (widest == sides.size()) { // too small to cut
            is_settled = true;
            return;
        }
        pieces[chosen].is_cut = true;
        const double middle = left[widest].minimum / 2 + left[widest].maximum / 2;
        left[widest].maximum = right[widest].minimum = middle;
        add(std::move(left));
        add(std::move(right));
    }
};

} // namespace

Interval height_bounds(const Module& module, const Texture& texture, const BoundsBox& box, uint32_t evaluations)
{
    Bisection bisection(module, texture, box, {Goal::highest, Goal::lowest});
    bisection.run(evaluations);
    Interval height{-bisection.bound(1), bisection.bound(0), bisection.may_be_nan()};
    const bool may_be_infinite = height.is_empty() || std::isinf(height.minimum) || std::isinf(height.maximum);
    if (height.is_empty()) height = {0, 0, true};
    height.may_be_nan |= may_be_infinite;
    if (height.may_be_nan) height = {std::min(height.minimum, 0.0), std::max(height.maximum, 0.0), true};
    return height;
}

std::vector<Interval> output_bounds(const Module& module, const Texture& texture, const BoundsBox& box,
                                    uint32_t evaluations)
{
    std::vector<Interval> outputs;
    const size_t results = module.functions[texture.body].body.yields.size();
    for (size_t result = 1; result < results; ++result) {
        Bisection bisection(module, texture, box, {Goal::highest, Goal::lowest}, result);
        bisection.run(evaluations);
        outputs.push_back({-bisection.bound(1), bisection.bound(0), bisection.may_be_nan()});
    }
    return outputs;
}

TextureBounds texture_bounds(const Module& module, const Texture& texture, const BoundsBox& box, uint32_t evaluations)
{
    TextureBounds bounds{height_bounds(module, texture, box, evaluations), 0, 0, Continuity::unknown, {}, {}};
    Bisection bisection(module, texture, box, {Goal::slope, Goal::curvature});
    bisection.run(evaluations);
    bounds.slope_max = std::max(0.0, bisection.bound(0));
    bounds.curvature_max_per_m = std::max(0.0, bisection.bound(1));
    bounds.continuity = bisection.over_all().continuity;
    bounds.cause = bisection.over_all().cause;
    for (uint32_t function : bisection.believed_over_all()) {
        const std::string name = source_name(module.functions[function].name);
        if (std::find(bounds.declared.begin(), bounds.declared.end(), name) == bounds.declared.end())
            bounds.declared.push_back(name);
    }
    if (!bounds.declared.empty()) bisection.look_at_points(points_for_facts);
    for (const auto& [where, fact] : bisection.contradicted()) bounds.contradicted.push_back(fact);
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
    Bisection bisection(module, texture, std::move(bounded), {Goal::faults});
    return bisection.excludes_faults(evaluations) ? std::vector<Undefined>{} : bisection.undefined_over_all();
}

} // namespace haptel::ir
