// Values of Haptel source, computed by the interpreter: source in, numbers out.
#pragma once

#include <array>
#include <string>
#include <vector>

namespace haptel::lang::test {

// A point and block for an evaluation; parameters by index, the rest at their defaults.
struct Inputs {
    std::array<double, 3> p{}, n{}, center{}, extent{};
    std::array<double, 2> uv{};
    double time_s = 0, footprint_m = 0;
    std::vector<double> parameters;
};

struct Sample {
    double height = 0;
    std::array<double, 3> gradient{};
    uint32_t faults = 0;
    std::vector<double> outputs; // material outputs that the texture writes, in the order of HAPTEL_WRITES_*
};

// Of the last texture in `source`. What does not compile fails the test with its diagnostics.
Sample evaluate(const std::string& source, const Inputs& inputs = {});

// Height of `texture t() { return EXPRESSION; }` behind `declarations`.
double value_of(const std::string& expression, const std::string& declarations = {}, const Inputs& inputs = {});

struct ExpressionValue {
    std::string expression;
    double value;
};
void check_values(const std::vector<ExpressionValue>& cases, const std::string& declarations = {},
                  const Inputs& inputs = {});
// Within a few roundings.
void check_values_near(const std::vector<ExpressionValue>& cases, const std::string& declarations = {},
                       const Inputs& inputs = {});

} // namespace haptel::lang::test
