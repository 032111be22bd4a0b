// Where a texture amplifies its rounding (jit/check/amplified_rounding.h), as it is told: place, text and cure.
#pragma once

#include "jit/check/check_gradient.h"
#include "lang/text/source.h"

#include <string>

namespace haptel::tools {

struct AmplifiedPlace {
    std::string file, text; // text: in one line
    lang::Position at;
    bool is_hash_of_sine = false;

    std::string where() const; // "a.haptel:3:12: fract(sin(n) * 43758.5453)"
    std::string hint() const;  // what to write instead
};

AmplifiedPlace place_of(const jit::AmplifiedRounding& found, const lang::SourceSet& sources);

} // namespace haptel::tools
