// Times of a benchmark in its JSON.
#pragma once

#include "bench/timing.h"
#include "tools/output/json.h"

namespace haptel::tools {

inline Json to_json(const bench::Times& of)
{
    return {{"median", of.median}, {"p99", of.p99}, {"p999", of.p999}};
}

} // namespace haptel::tools
