#include "lang/ir/bounds.h"

#include "lang/ir/interval_evaluator.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

namespace haptel::ir {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr uint64_t operations_per_evaluation = 1'000'000;
constexpr uint64_t operations_in_all = 4'000'000; // keeps a reload short, whatever the program

// Marks the point inputs that an entry reads and that the box leaves open.
void find_open_inputs(const Block& block, const BoundsBox& box, std::vector<bool>& open)
{
    for (const Instruction& made : block.instructions) {
        if (auto* read = std::get_if<ReadInput>(&made.kind)) {
            auto index = static_cast<size_t>(read->input);
            const Interval& range = box.input[index];
            if (std::isfinite(range.maximum - range.minimum) && !range.is_point()) open[index] = true;
        }
        if (auto* choice = std::get_if<If>(&made.kind))
            for (const Block& arm : choice->arms) find_open_inputs(arm, box, open);
        if (auto* loop = std::get_if<For>(&made.kind)) find_open_inputs(loop->body[0], box, open);
    }
}

// The box, cut into pieces: the one that holds the greatest bound is cut next, or the one with the least, in turn.
class Bisection {
public:
    Bisection(const Module& module, const Texture& texture, const BoundsBox& whole)
        : evaluator(module, operations_per_evaluation), entry(texture.body), box(whole), is_open(input_count, false)
    {
        find_open_inputs(module.functions[entry].body, box, is_open);
        add(std::vector<Interval>(std::begin(whole.input), std::end(whole.input)));
    }

    Interval run(uint32_t evaluations)
    {
        const bool can_cut = std::find(is_open.begin(), is_open.end(), true) != is_open.end();
        double width_before = infinity;
        for (uint32_t target = 16; can_cut && used < operations_in_all && !is_settled; target *= 2) {
            while (pieces.size() < std::min(target, evaluations) && used < operations_in_all && !is_settled) cut();
            Interval found = bounds();
            const double width = found.maximum - found.minimum;
            if (pieces.size() >= evaluations || !(width < 0.95 * width_before)) break;
            width_before = width;
        }
        return bounds();
    }

private:
    struct Piece {
        std::vector<Interval> input;
        Interval height;
        bool is_cut = false;
    };
    IntervalEvaluator evaluator;
    uint32_t entry;
    BoundsBox box;
    std::vector<bool> is_open;
    std::vector<Piece> pieces;
    std::priority_queue<std::pair<double, size_t>> highest, lowest; // bound (outward), piece
    uint64_t used = 0;
    bool take_highest = true, is_settled = false;

    void add(std::vector<Interval> input)
    {
        std::copy(input.begin(), input.end(), box.input);
        Interval height = evaluator.run(entry, {}, &box)[0];
        used += evaluator.operations_used() + 1;
        highest.emplace(height.is_empty() ? -infinity : height.maximum, pieces.size());
        lowest.emplace(height.is_empty() ? -infinity : -height.minimum, pieces.size());
        pieces.push_back({std::move(input), height});
    }

    size_t next_of(std::priority_queue<std::pair<double, size_t>>& queue)
    {
        while (pieces[queue.top().second].is_cut) queue.pop();
        return queue.top().second;
    }

    void cut()
    {
        const size_t chosen = next_of(take_highest ? highest : lowest);
        take_highest = !take_highest;
        pieces[chosen].is_cut = true;
        std::vector<Interval> left = pieces[chosen].input, right = left;
        size_t widest = input_count;
        double widest_share = 0;
        for (size_t i = 0; i < input_count; ++i) {
            if (!is_open[i]) continue;
            const Interval& whole = pieces[0].input[i];
            double share = (left[i].maximum - left[i].minimum) / (whole.maximum - whole.minimum);
            if (share > widest_share) widest = i, widest_share = share;
        }
        if (widest == input_count) { // too small to cut
            pieces[chosen].is_cut = false;
            is_settled = true;
            return;
        }
        const double middle = left[widest].minimum / 2 + left[widest].maximum / 2;
        left[widest].maximum = right[widest].minimum = middle;
        add(std::move(left));
        add(std::move(right));
    }

    Interval bounds()
    {
        Interval all{-lowest_bound(), pieces[next_of(highest)].height.maximum};
        for (const Piece& piece : pieces) all.may_be_nan |= !piece.is_cut && piece.height.may_be_nan;
        return all;
    }
    double lowest_bound() { return -pieces[next_of(lowest)].height.minimum; }
};

} // namespace

Interval height_bounds(const Module& module, const Texture& texture, const BoundsBox& box, uint32_t evaluations)
{
    Interval height = Bisection(module, texture, box).run(evaluations);
    const bool may_be_infinite = height.is_empty() || std::isinf(height.minimum) || std::isinf(height.maximum);
    if (height.is_empty()) height = {0, 0, true};
    height.may_be_nan |= may_be_infinite;
    if (height.may_be_nan) height = {std::min(height.minimum, 0.0), std::max(height.maximum, 0.0), true};
    return height;
}

std::vector<Interval> function_bounds(const Module& module, uint32_t function, std::span<const Interval> arguments)
{
    return IntervalEvaluator(module, operations_per_evaluation).run(function, arguments, nullptr);
}

} // namespace haptel::ir
