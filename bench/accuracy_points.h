// Points as arrays, what is true at them, and how far a way to get a height and a gradient is from it.
#pragma once

#include "bench/accuracy_bench.h"
#include "jit/check/oracle.h"
#include "jit/texture/texture.h"

#include <vector>

namespace haptel::bench {

// Random points of a cube, with room for their samples.
struct Points {
    Points(size_t count, double half_side_m, uint32_t seed);
    size_t size() const { return faults.size(); }
    haptel_point at(size_t i) const;
    // Samples of points first .. first + count, by a batch.
    void evaluate(haptel_batch_entry* entry, const void* block, size_t first, size_t count);
    haptel_sample sample(size_t i) const; // as the last batch left it

private:
    std::vector<std::vector<double>> coordinates, numbers;
    std::vector<uint32_t> faults;
};

// The 113-bit oracle at points, and how large it gets.
class Truth {
public:
    Truth(const jit::CompiledTextures& exact, const TextureBinding& binding, const Points& points);
    // Of samples at the same points; `wavelengths` is only noted.
    Accuracy of(const std::vector<haptel_sample>& found, double wavelengths) const;

private:
    std::vector<jit::OracleSample> samples;
    double height = 0, gradient = 0;
};

} // namespace haptel::bench
