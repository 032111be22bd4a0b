// How long it takes from text to code, by the length of the text.
#pragma once

#include "bench/timing.h"

#include <cstdint>
#include <string>
#include <vector>

namespace haptel::bench {

struct CompileRow {
    std::string texture;
    uint32_t lines = 0;
    Times front_end;     // text to checked, differentiated, verified IR; the standard library's text included
    double first_ms = 0; // to callable code, the first time in this process
    Times warm;          // again
};

// Small and large textures, interleaved: every length is measured once per round.
std::vector<CompileRow> bench_compile(bool quick);

// Time of the front end per line beyond the first texture's, of the longest over that of the second shortest: 1 if it
// grows in proportion.
double growth(const std::vector<CompileRow>& rows);

} // namespace haptel::bench
