// What a fit looks for: the parameters of a texture that are free, each in a coordinate from 0 to 1 over its range.
#pragma once

#include "lang/abi/texture_binding.h"

#include <cstdint>
#include <string>
#include <vector>

namespace haptel::jit {

// A real parameter. By its logarithm where its range is positive: 1 % of a small value counts as 1 % of a large one.
struct RealUnknown {
    uint32_t parameter; // index in haptel_texture::parameters
    double minimum, maximum;
    bool is_by_logarithm;

    double value(double coordinate) const;
    double slope(double coordinate) const; // dvalue/dcoordinate
    double coordinate(double value) const; // held to 0 .. 1
};

// A whole number or a choice, tried value by value.
struct WholeUnknown {
    uint32_t parameter;
    int64_t minimum, maximum;
};

// A place among all that can be: coordinates of the real unknowns, values of the whole ones.
struct Guess {
    std::vector<double> coordinates;
    std::vector<int64_t> wholes;
};

// Whole numbers of more values than this are left as they are.
inline constexpr int64_t whole_values_max = 64;

class Unknowns {
public:
    // All parameters of the binding's texture but pictures, those named in `given` and whole numbers of too many
    // values: these stay as the block has them.
    Unknowns(const TextureBinding& binding, const std::vector<std::string>& given);

    // The binding's block with the guess's values.
    const void* block(const Guess& guess);
    std::vector<uint32_t> real_parameters() const;
    Guess start() const; // the block as it is

    std::vector<RealUnknown> reals;
    std::vector<WholeUnknown> wholes;
    std::vector<uint32_t> left; // parameters that could be looked for but are not: too many values

private:
    const haptel_texture& texture;
    std::vector<uint64_t> bytes; // of 8 bytes for its alignment
};

} // namespace haptel::jit
