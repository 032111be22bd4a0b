#include "runtime/files/tick_limit.h"

#include <string>

namespace haptel::runtime {

void need_slower_than_ticks(const TableReader& table, const char* key, double value, Rounds rounds, double rate_hz,
                            FileMessages& messages)
{
    const bool turns = rounds == Rounds::turns;
    const double limit = turns ? 180 * rate_hz : rate_hz / 2;
    if (value < limit) return;
    messages.error(table.where(key),
                   "`" + std::string(key) + "` must be below " + (turns ? "half a turn in a tick at" : "half of") +
                       " the servo's `rate_hz`, so below " + shortest(limit) +
                       (turns ? " about all axes together" : "") + ": at that rate faster " +
                       (turns ? "turns" : "swings") + " are felt as slower ones. Lower it, or raise `rate_hz`");
}

} // namespace haptel::runtime
