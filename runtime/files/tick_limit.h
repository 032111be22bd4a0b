// How often something may come round in a scene whose servo ticks that often.
#pragma once

#include "runtime/files/table_reader.h"

namespace haptel::runtime {

enum class Rounds { swings, turns };

// Half as often as the servo ticks, and beyond, what comes round is felt as something slower, or as running backwards:
// an error. Of turns the value is in degrees per second.
void need_slower_than_ticks(const TableReader& table, const char* key, double value, Rounds rounds, double rate_hz,
                            FileMessages& messages);

} // namespace haptel::runtime
