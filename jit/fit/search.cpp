#include "jit/fit/search.h"

#include <algorithm>
#include <cmath>
#include <random>

// LevenbergMarquardt is MINPACK's lmder.
#include <Eigen/Core>
#include <unsupported/Eigen/LevenbergMarquardt>

namespace haptel::jit {

namespace {

// Guesses double with each unknown and are as many as a minute allows: three unknowns are looked for at 25 places each,
// six at 7.
constexpr std::size_t guesses_bits = 11, guesses_bits_max = 17;
constexpr std::size_t kept_min = 6; // so that what fits alike is found, too
constexpr int steps_at_first = 20;  // on all levels but the last
constexpr double shaken_by = 0.2;   // of each range

// The coordinate of a variable that may be any number: it cannot leave its range, and an end of it is a place where the
// misfit is level.
double folded(double variable)
{
    return (1 + std::sin(variable)) / 2;
}

struct Problem : Eigen::DenseFunctor<double> {
    Problem(Unknowns& looked_for, Misfit& of, Guess from)
        : DenseFunctor(static_cast<int>(looked_for.reals.size()),
                       static_cast<int>(std::max(of.rows(), looked_for.reals.size())))
        , unknowns(looked_for)
        , misfit(of)
        , guess(std::move(from))
    {
    }

    const void* block_at(const InputType& variables)
    {
        for (Eigen::Index i = 0; i < variables.size(); ++i)
            guess.coordinates[static_cast<std::size_t>(i)] = folded(variables[i]);
        return unknowns.block(guess);
    }
    int operator()(const InputType& variables, ValueType& rows)
    {
        rows.setZero(values()); // more unknowns than rows: further rows say nothing
        misfit.residuals(block_at(variables), {rows.data(), misfit.rows()});
        return 0;
    }
    int df(const InputType& variables, JacobianType& jacobian)
    {
        const void* block = block_at(variables);
        const std::size_t count = misfit.rows();
        std::vector<double> rows(count), by_parameters(count * unknowns.reals.size());
        misfit.gradient(block, rows, by_parameters);
        jacobian.setZero(values(), inputs());
        for (std::size_t j = 0; j < unknowns.reals.size(); ++j) {
            const auto column = static_cast<Eigen::Index>(j);
            const double turn = unknowns.reals[j].slope(guess.coordinates[j]) * std::cos(variables[column]) / 2;
            for (std::size_t i = 0; i < count; ++i)
                jacobian(static_cast<Eigen::Index>(i), column) = by_parameters[j * count + i] * turn;
        }
        return 0;
    }

    Unknowns& unknowns;
    Misfit& misfit;
    Guess guess;
};

double root_mean_square(std::span<const double> rows)
{
    double sum = 0;
    for (const double row : rows) sum += row * row;
    return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(rows.size(), 1)));
}

double misfit_of(Unknowns& unknowns, Misfit& misfit, const Guess& guess)
{
    std::vector<double> rows(misfit.rows());
    misfit.residuals(unknowns.block(guess), rows);
    return root_mean_square(rows);
}

// Spread evenly over all unknowns, in the order of Halton's numbers: no two are close.
class Guesses {
public:
    Guesses(const Unknowns& looked_for, uint64_t seed) : unknowns(looked_for)
    {
        std::mt19937_64 random(seed);
        for (uint32_t candidate = 2; bases.size() < unknowns.reals.size() + unknowns.wholes.size(); ++candidate)
            if (std::ranges::none_of(bases, [&](uint32_t base) { return candidate % base == 0; })) {
                bases.push_back(candidate);
                shifts.push_back(std::uniform_real_distribution<double>()(random));
            }
    }
    Guess guess(uint64_t number) const
    {
        Guess made;
        std::size_t axis = 0;
        for (; axis < unknowns.reals.size(); ++axis) made.coordinates.push_back(place(axis, number));
        for (const WholeUnknown& whole : unknowns.wholes) {
            const double values = static_cast<double>(whole.maximum - whole.minimum + 1);
            made.wholes.push_back(whole.minimum + static_cast<int64_t>(place(axis++, number) * values));
        }
        return made;
    }

private:
    const Unknowns& unknowns;
    std::vector<uint32_t> bases;
    std::vector<double> shifts;

    double place(std::size_t axis, uint64_t number) const
    {
        double place = shifts[axis], digit = 1;
        for (; number > 0; number /= bases[axis]) {
            digit /= bases[axis];
            place += digit * static_cast<double>(number % bases[axis]);
        }
        return place - std::floor(place);
    }
};

void sort_and_keep(std::vector<Found>& all, std::size_t most)
{
    std::ranges::stable_sort(all, {}, &Found::misfit);
    // The same place, found twice, is no other one.
    const auto same = [](const Found& a, const Found& b) {
        double apart = a.guess.wholes == b.guess.wholes ? 0 : 1;
        for (std::size_t i = 0; i < a.guess.coordinates.size(); ++i)
            apart = std::max(apart, std::abs(a.guess.coordinates[i] - b.guess.coordinates[i]));
        return apart < 1e-6;
    };
    std::vector<Found> different;
    for (Found& each : all) {
        if (different.size() == most) break;
        if (std::ranges::none_of(different, [&](const Found& other) { return same(each, other); }))
            different.push_back(std::move(each));
    }
    all = std::move(different);
}

// Each whole unknown one up and one down, as long as that is better.
void step_wholes(Unknowns& unknowns, Misfit& misfit, std::vector<Found>& all, int steps_max)
{
    for (bool is_better = true; is_better;) {
        is_better = false;
        const Found best = all.front();
        for (std::size_t i = 0; i < unknowns.wholes.size(); ++i)
            for (const int64_t step : {-1, 1}) {
                Guess other = best.guess;
                other.wholes[i] += step;
                if (other.wholes[i] < unknowns.wholes[i].minimum || other.wholes[i] > unknowns.wholes[i].maximum)
                    continue;
                all.push_back(refine(unknowns, misfit, std::move(other), steps_max));
                is_better |= all.back().misfit < 0.999 * best.misfit; // rounding is no reason to go on
            }
        sort_and_keep(all, all.size());
    }
}

// Nobody is given another value than the texture's own where nothing asks for it: a fine ridge, for one, that is
// recorded as a coarse one is (aliasing).
void prefer_start(const Unknowns& unknowns, const Misfit& misfit, std::vector<Found>& all)
{
    const Guess start = unknowns.start();
    const auto apart = [](const Guess& a, const Guess& b) {
        double square = 0;
        for (std::size_t i = 0; i < a.coordinates.size(); ++i)
            square += std::pow(a.coordinates[i] - b.coordinates[i], 2);
        for (std::size_t i = 0; i < a.wholes.size(); ++i) square += a.wholes[i] != b.wholes[i] ? 1 : 0;
        return std::sqrt(square);
    };
    constexpr double same_place = 0.02; // on the way to the best, and not yet there
    auto nearest = all.begin();
    for (auto other = all.begin(); other != all.end() && fits_as_well(*other, all.front(), misfit); ++other)
        if (apart(other->guess, all.front().guess) > same_place &&
            apart(other->guess, start) < apart(nearest->guess, start))
            nearest = other;
    std::iter_swap(all.begin(), nearest);
}

// What else fits as well near the best: found by going away from it a little and coming back.
void shake(Unknowns& unknowns, Misfit& misfit, std::vector<Found>& all, const FitEffort& effort, uint64_t seed)
{
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> away(-shaken_by, shaken_by);
    const Guess best = all.front().guess;
    for (int i = 0; i < effort.shakes; ++i) {
        Guess other = best;
        for (double& coordinate : other.coordinates) coordinate = std::clamp(coordinate + away(random), 0.0, 1.0);
        all.push_back(refine(unknowns, misfit, std::move(other), effort.steps_at_last));
    }
    sort_and_keep(all, all.size());
}

} // namespace

bool fits_as_well(const Found& found, const Found& best, const Misfit& misfit)
{
    constexpr double alike_ratio = 1.01; // misfits within 1 % are told apart by nothing
    return found.misfit <= alike_ratio * best.misfit + misfit_rounding * misfit.scale();
}

Found refine(Unknowns& unknowns, Misfit& misfit, Guess start, int steps_max)
{
    Found found{std::move(start), 0};
    if (!unknowns.reals.empty()) {
        Eigen::VectorXd variables(static_cast<Eigen::Index>(unknowns.reals.size()));
        for (Eigen::Index i = 0; i < variables.size(); ++i) // not at an end, where it could not leave
            variables[i] =
                std::asin(2 * std::clamp(found.guess.coordinates[static_cast<std::size_t>(i)], 0.001, 0.999) - 1);
        Problem problem(unknowns, misfit, found.guess);
        Eigen::LevenbergMarquardt<Problem> least(problem);
        least.setMaxfev(steps_max);
        least.setFtol(1e-15);
        least.setXtol(1e-12);
        least.minimize(variables);
        problem.block_at(variables);
        found.guess = problem.guess;
    }
    found.misfit = misfit_of(unknowns, misfit, found.guess);
    return found;
}

std::vector<Found> search(Unknowns& unknowns, std::span<const std::unique_ptr<Misfit>> levels, Misfit& overview,
                          const FitEffort& effort, uint64_t seed)
{
    const Guesses places(unknowns, seed);
    const std::size_t bits = std::min(guesses_bits + unknowns.reals.size() + unknowns.wholes.size(), guesses_bits_max);
    const auto best_guesses = [&](Misfit& by, std::size_t most) {
        std::vector<Found> best{{unknowns.start(), by.unlikeness(unknowns.block(unknowns.start()))}};
        for (uint64_t i = 1; i <= uint64_t{1} << bits; ++i) {
            Guess guess = places.guess(i);
            const double unlikeness = by.unlikeness(unknowns.block(guess));
            best.push_back({std::move(guess), unlikeness});
            if (best.size() == 16 * most) sort_and_keep(best, most);
        }
        sort_and_keep(best, most);
        return best;
    };
    std::size_t most = effort.kept;
    std::vector<Found> all = best_guesses(*levels.front(), most);
    for (const std::unique_ptr<Misfit>& level : levels) {
        const bool is_last = level == levels.back();
        if (is_last) std::ranges::move(best_guesses(overview, effort.kept / 4), std::back_inserter(all));
        for (Found& found : all)
            found = refine(unknowns, *level, std::move(found.guess), is_last ? effort.steps_at_last : steps_at_first);
        most = std::max(most / 2, kept_min);
        sort_and_keep(all, most);
    }
    step_wholes(unknowns, *levels.back(), all, effort.steps_at_last);
    shake(unknowns, *levels.back(), all, effort, seed);
    prefer_start(unknowns, *levels.back(), all);
    return all;
}

} // namespace haptel::jit
