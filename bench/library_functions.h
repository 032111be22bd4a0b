// The C library's elementary functions: what ours are measured against.
#pragma once

#include "lang/ir/ir.h"

#include <vector>

namespace haptel::bench {

// For ir::is_elementary(op). At the origin of atan2 0, as in Haptel.
double library_function(ir::Op op, double a, double b);
float library_function(ir::Op op, float a, float b);

// Of each i the sum over k of the function of operands[k][i] (and of operands[k + 1][i], the first after the last).
void library_sums(ir::Op op, const std::vector<std::vector<double>>& operands, double* sums);
void library_sums(ir::Op op, const std::vector<std::vector<float>>& operands, float* sums);

} // namespace haptel::bench
