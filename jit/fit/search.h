// The least misfit over all unknowns: rough guesses everywhere, the best of them refined by least squares, over ever
// more of what was measured.
#pragma once

#include "jit/fit/misfit.h"
#include "jit/fit/unknowns.h"

#include <memory>
#include <span>
#include <vector>

namespace haptel::jit {

// What a search spends, by how long a misfit takes.
struct FitEffort {
    std::size_t kept;  // guesses that are refined on the first level; half as many on each further one
    int steps_at_last; // of a refinement on the last level, at most
    int shakes;        // looks for what fits as well near the best
};

struct Found {
    Guess guess;
    double misfit = 0; // root of the mean square of the rows, in their unit
};

inline constexpr double misfit_rounding = 1e-9; // of what was measured: less is no difference
// Whether nothing that was measured tells it from the best.
bool fits_as_well(const Found& found, const Found& best, const Misfit& misfit);

// Each level is harder to be near to than the one before, and tells more: first a small part of what was measured,
// where a guess need not be close, last all of it. What is found is sorted, the best first, and of what fits as well as
// that what is nearest to where the unknowns start; the same for the same seed.
// At least one level, and one guess is always found. `overview` is all of what was measured with few rows: what is like
// it is tried on the last level at once, where a small part tells nothing.
std::vector<Found> search(Unknowns& unknowns, std::span<const std::unique_ptr<Misfit>> levels, Misfit& overview,
                          const FitEffort& effort, uint64_t seed);

// Levenberg's and Marquardt's least squares over the real unknowns, within their ranges; whole ones stay.
Found refine(Unknowns& unknowns, Misfit& misfit, Guess start, int steps_max);

} // namespace haptel::jit
