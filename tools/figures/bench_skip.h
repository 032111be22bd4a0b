// How the figures of what a tick leaves out are shown.
#pragma once

#include "bench/skip_bench.h"
#include "tools/output/json.h"

namespace haptel::tools {

std::string to_table(const std::vector<bench::SkipRow>& rows);
std::string to_csv(const std::vector<bench::SkipRow>& rows);
Json to_json(const bench::SkipRow& row);

} // namespace haptel::tools
