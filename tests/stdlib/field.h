// A library expression as a field over q, a point in plain numbers: compiled, then called.
#pragma once

#include "jit/texture/texture.h"

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace haptel::test {

using Vec3 = std::array<double, 3>;

struct FieldSample {
    double value;
    Vec3 gradient;
};

class Field {
public:
    // `expression` in q (vec3); `declarations` are functions it may use. What does not compile fails the test. The
    // footprint is in units of q.
    explicit Field(const std::string& expression, const std::string& declarations = {}, double footprint = 0);
    FieldSample operator()(const Vec3& q) const; // a fault fails the test
    uint32_t faults(const Vec3& q) const;

private:
    std::shared_ptr<const jit::CompiledProgram> program;
    std::vector<double> block;
};

// Cells of a constant table of the library, read from its text.
std::vector<double> library_table(const std::string& name);
int shuffled(int i); // that cell of its table perlin_m, which repeats

// What is left of an octave with so many footprints per wavelength.
double octave_left(double detail);

// Functions that are not the library's, to be summed by it.
inline const std::string own_basis = "float basis(vec3 q) { return sin(q.x) * cos(q.y) + 0.5 * sin(q.z); }\n"
                                     "float flat_basis(vec2 q) { return sin(q.x) * cos(q.y); }\n";

// `count` points, uniform within -size .. size in each coordinate, the same on every machine.
std::vector<Vec3> points_within(double size, int count, uint32_t seed = 1);

} // namespace haptel::test
