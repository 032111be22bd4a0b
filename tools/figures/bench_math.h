// How the figures of elementary functions are shown.
#pragma once

#include "bench/math_bench.h"
#include "tools/output/json.h"

namespace haptel::tools {

std::string to_table(const std::vector<bench::MathRow>& rows);
std::string to_csv(const std::vector<bench::MathRow>& rows);
Json to_json(const bench::MathRow& row);

} // namespace haptel::tools
