// Work on several processors whose result does not depend on how many: parts are known by number, each writes what is
// its own, and whoever needs an order takes that of the numbers.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>

namespace haptel::runtime {

// Calls part(0) .. part(count - 1) once each, on so many threads (0: one for each processor), the caller's among them,
// and returns when all have. What a part throws goes on to the caller; then some parts may not have been called.
void in_parallel(std::size_t count, unsigned threads, const std::function<void(std::size_t part)>& part);

// The numbers below `count` in pieces: calls range(begin, end, piece), where piece is begin / items_per_piece.
inline constexpr std::size_t items_per_piece = 1 << 14;
inline std::size_t pieces_of(std::size_t count)
{
    return (count + items_per_piece - 1) / items_per_piece;
}
template <class Range>
void in_pieces(std::size_t count, unsigned threads, Range&& range)
{
    in_parallel(pieces_of(count), threads, [&](std::size_t piece) {
        range(piece * items_per_piece, std::min(count, (piece + 1) * items_per_piece), piece);
    });
}
template <class Visit>
void each_in_parallel(std::size_t count, unsigned threads, Visit&& visit)
{
    in_pieces(count, threads, [&](std::size_t begin, std::size_t end, std::size_t) {
        for (std::size_t i = begin; i < end; ++i) visit(static_cast<uint32_t>(i));
    });
}

} // namespace haptel::runtime
