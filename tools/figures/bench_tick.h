// How the figures of the servo's tick are shown.
#pragma once

#include "bench/tick_bench.h"
#include "tools/output/json.h"

namespace haptel::tools {

std::string to_table(const std::vector<bench::TickRow>& rows);
std::string to_csv(const std::vector<bench::TickRow>& rows);
Json to_json(const bench::TickRow& row);

// What ticks cost more on more triangles and among more objects: of all rows of one scene, the last over the first.
std::string growth_table(const std::vector<bench::TickRow>& rows);
Json growth_json(const std::vector<bench::TickRow>& rows);

} // namespace haptel::tools
