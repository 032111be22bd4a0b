// How the figures of the servo's deadlines are shown.
#pragma once

#include "bench/servo_bench.h"
#include "tools/output/json.h"

namespace haptel::tools {

std::string to_table(const std::vector<bench::ServoRow>& rows);
std::string to_csv(const std::vector<bench::ServoRow>& rows);
Json to_json(const bench::ServoRow& row);

} // namespace haptel::tools
