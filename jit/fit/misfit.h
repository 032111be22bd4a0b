// How far a texture is from what was measured: what a fit makes small.
#pragma once

#include <cstddef>
#include <span>

namespace haptel::jit {

class Misfit {
public:
    virtual ~Misfit() = default;
    virtual std::size_t rows() const = 0;
    // Of the texture with this block: made minus measured, row by row.
    virtual void residuals(const void* block, std::span<double> rows) = 0;
    // Beside them how each row moves with each real unknown, in the order of Unknowns::reals, column by column.
    virtual void gradient(const void* block, std::span<double> rows, std::span<double> by_parameters) = 0;
    // Of a rough guess: what tells a good one from others best, the less the better. Not more than 1 where the texture
    // has anything to do with what was measured.
    virtual double unlikeness(const void* block) = 0;
    // The root of the mean square of the rows of a texture that is flat, or as wrong as can be.
    virtual double scale() const = 0;
};

} // namespace haptel::jit
