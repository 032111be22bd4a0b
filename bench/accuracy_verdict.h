// What the rows of error against time say: who is on the frontier, and whether ours holds against each plain way.
#pragma once

#include "bench/accuracy_bench.h"

#include <optional>

namespace haptel::bench {

// Sets is_on_frontier. The rows are those of one texture.
void mark_frontier(std::vector<AccuracyRow>& rows);

// A variant of ours holds against a plain way where it takes at most 1.1 times as long and is off by at most 1.25 times
// as much, or by at most 1e-14.
inline constexpr double time_factor_max = 1.1, error_factor_max = 1.25, error_always_fine = 1e-14;

// One plain way at one distance from the origin, and what is ours of the same texture and mode.
struct Alternative {
    const AccuracyRow* plain = nullptr;
    double wavelengths = 0, error = 0;         // largest of the gradient
    const AccuracyRow* holds = nullptr;        // our fastest that holds against it; null: none does
    const AccuracyRow* close_enough = nullptr; // our fastest whose error would do; null: none's does
    double times_as_fast() const { return close_enough ? plain->median_ns / close_enough->median_ns : 0; }
};
// Point into `rows`.
std::vector<Alternative> alternatives(const std::vector<AccuracyRow>& rows);

// Plain central differences at their best step, near the origin, over our fastest variant of no larger error.
struct DifferenceRatio {
    const AccuracyRow* plain = nullptr;
    const AccuracyRow* ours = nullptr; // null: all of ours are further off
    double times_as_slow() const { return ours ? plain->median_ns / ours->median_ns : 0; }
};
std::vector<DifferenceRatio> difference_ratios(const std::vector<AccuracyRow>& rows);

} // namespace haptel::bench
