// The truth about a texture at a point, to about 34 digits: its IR interpreted over a float of at least 113 bits, which
// starts from the f64 constants, parameters and points that code starts from. Slow: some 10 us per fractal octave.
#pragma once

#include "jit/texture/texture.h"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace haptel::jit {

struct OracleSample {
    double height_m = 0, gradient[3] = {}; // rounded to nearest
    uint32_t faults = 0;
    std::string height_digits, gradient_digits[3]; // 36 significant digits, in decimal; metres, metres per metre
    std::vector<std::string> output_digits;        // of the material outputs that it writes, component by component
};

// For one thread.
class Oracle {
public:
    // `binding` was made from `program`: its block gives the parameters, its texture's name says which texture.
    Oracle(std::shared_ptr<const CompiledProgram> program, const TextureBinding& binding);

    OracleSample sample(const haptel_point& point) { return evaluate(point); }

private:
    std::function<OracleSample(const haptel_point&)> evaluate;
};

// The same over double, by the plain interpreter: what code must equal bit for bit.
haptel_sample interpret_sample(const CompiledProgram& program, const TextureBinding& binding,
                               const haptel_point& point);

} // namespace haptel::jit
