// The plain C++ textures as entries like those of compiled textures, by every way to get a gradient.
#pragma once

#include "lang/abi/abi.h"
#include "lang/ir/ir.h"

#include <string>
#include <vector>

namespace haptel::bench {

enum class Field : uint8_t { noise, perlin, fbm1, fbm2, fbm4, fbm8, gardner7 };

// Ready to be called as long as the list lives.
struct PlainMethod {
    std::string name;      // cpp_analytic, cpp_dual, cpp_difference_2 | 4 | 6, cpp_sine_N of degree N
    std::string precision; // f64, f32
    double step = 0;       // of differences, in wavelengths
    haptel_entry* point = nullptr;
    haptel_batch_entry* batch = nullptr;
    const void* block = nullptr;
};

// The methods of one texture, whose wavelength is 1 m, so that heights and gradients are those of the bare functions.
class PlainMethods {
public:
    // The tables are those that `module`, which holds the library's functions, reads.
    PlainMethods(Field field, const ir::Module& module);
    ~PlainMethods();
    PlainMethods(const PlainMethods&) = delete;
    PlainMethods& operator=(const PlainMethods&) = delete;

    // Differences at each of these steps.
    const std::vector<PlainMethod>& add_differences(const std::vector<double>& steps);
    std::vector<PlainMethod> methods;

private:
    struct Blocks;
    Blocks* blocks;
    Field field;
};

} // namespace haptel::bench
