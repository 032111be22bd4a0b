#include "bench/accuracy_verdict.h"

#include <algorithm>

namespace haptel::bench {
namespace {

// Our fastest of the same texture and mode that is off by at most so much at that distance.
const AccuracyRow* fastest_of_ours(const std::vector<AccuracyRow>& rows, const AccuracyRow& against, size_t distance,
                                   double error_max)
{
    const AccuracyRow* fastest = nullptr;
    for (const AccuracyRow& row : rows)
        if (row.is_ours() && row.texture == against.texture && row.is_batch == against.is_batch &&
            row.errors[distance].gradient_max <= error_max && (!fastest || row.median_ns < fastest->median_ns))
            fastest = &row;
    return fastest;
}

} // namespace

void mark_frontier(std::vector<AccuracyRow>& rows)
{
    for (AccuracyRow& row : rows)
        row.is_on_frontier = std::none_of(rows.begin(), rows.end(), [&](const AccuracyRow& other) {
            const double error = row.errors[0].gradient_max, others = other.errors[0].gradient_max;
            return other.is_batch == row.is_batch && other.median_ns <= row.median_ns && others <= error &&
                   (other.median_ns < row.median_ns || others < error);
        });
}

std::vector<Alternative> alternatives(const std::vector<AccuracyRow>& rows)
{
    std::vector<Alternative> found;
    for (const AccuracyRow& row : rows) {
        if (!row.is_plain()) continue;
        for (size_t i = 0; i < row.errors.size(); ++i) {
            Alternative one{&row, row.errors[i].wavelengths, row.errors[i].gradient_max, nullptr, nullptr};
            one.close_enough = fastest_of_ours(rows, row, i, std::max(error_factor_max * one.error, error_always_fine));
            if (one.close_enough && one.close_enough->median_ns <= time_factor_max * row.median_ns)
                one.holds = one.close_enough;
            found.push_back(one);
        }
    }
    return found;
}

std::vector<DifferenceRatio> difference_ratios(const std::vector<AccuracyRow>& rows)
{
    std::vector<DifferenceRatio> found;
    for (const AccuracyRow& row : rows)
        if (row.is_plain() && row.is_difference() && row.is_best_step)
            found.push_back({&row, fastest_of_ours(rows, row, 0, row.errors[0].gradient_max)});
    return found;
}

} // namespace haptel::bench
