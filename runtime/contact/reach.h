// How far around a round of a tick looks: what it finds there has to do for the way that it goes.
#pragma once

namespace haptel::runtime {

// In the first round: of the hand's way. Where friction lets go of more it takes more rounds.
inline constexpr double first_reach = 1.5;
// At least, of the way that is left, or of the radius of a ball.
inline constexpr double least_reach = 1e-3;

// After a step: the next is shorter, unless this one was as long as what was known.
inline double next_reach(double step, bool to_the_end) noexcept
{
    return (to_the_end ? 4 : 0.5) * step;
}

} // namespace haptel::runtime
