// The plain C++ textures that ours are measured against: every way to get a gradient, by every level of the instruction
// set that this processor has.
#pragma once

#include "bench/plain_level.h"
#include "lang/ir/ir.h"

#include <deque>
#include <vector>

namespace haptel::bench {

// Ready to be called as long as the list lives.
struct PlainMethod {
    const PlainEntry* entry;
    const char *level, *flags;
    double step; // of differences, in wavelengths; 0: none
    const void* block;
};

// The methods of one texture, whose wavelength is 1 m, so that heights and gradients are those of the bare functions.
class PlainMethods {
public:
    // The tables are those that `module`, which holds the library's functions, reads. Differences at each of `steps`.
    PlainMethods(Field field, const ir::Module& module, const std::vector<double>& steps);
    PlainMethods(const PlainMethods&) = delete;
    PlainMethods& operator=(const PlainMethods&) = delete;

    std::vector<PlainMethod> methods;

private:
    const void* block(const PlainEntry& entry, double step);

    Tables<double> f64_;
    Tables<float> f32_;
    std::deque<PlainBlock<double>> blocks_f64_; // that stay where they are
    std::deque<PlainBlock<float>> blocks_f32_;
};

} // namespace haptel::bench
