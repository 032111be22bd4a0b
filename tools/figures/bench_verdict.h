// What error against time comes to, as it is shown: ours against every plain way, and against differences.
#pragma once

#include "bench/accuracy_bench.h"
#include "tools/output/json.h"

namespace haptel::tools {

// How tables call a row's mode, "batch" or "point", and the step of its differences, "1e-05 (best)"; empty for a row
// that takes no differences.
const char* mode_of(const bench::AccuracyRow& row);
std::string step_of(const bench::AccuracyRow& row);

std::string verdict_text(const std::vector<bench::AccuracyRow>& rows);
// Of all plain ways at all distances, and of all differences.
Json alternatives_json(const std::vector<bench::AccuracyRow>& rows);
Json differences_json(const std::vector<bench::AccuracyRow>& rows);

} // namespace haptel::tools
