// How the figures of the tick's growth are shown.
#pragma once

#include "bench/scale_bench.h"
#include "tools/output/json.h"

namespace haptel::tools {

std::string to_table(const bench::Scale& scale);
std::string to_csv(const bench::Scale& scale); // builds too: axis build, without ticks
Json to_json(const bench::ScaleRow& row);
Json to_json(const bench::BuildRow& row);

} // namespace haptel::tools
