// The precision that check --max-error picks, as it is shown.
#pragma once

#include "jit/check/precision_choice.h"
#include "tools/output/json.h"

#include <string>

namespace haptel::tools {

struct CheckedPrecision {
    double error_max = 0;
    jit::PrecisionChoice choice;

    bool is_met() const;
    // Of all three, in words: for the finding that none is close enough.
    std::string closest() const;
};

Json precision_json(const CheckedPrecision& checked);
std::string precision_text(const CheckedPrecision& checked);

} // namespace haptel::tools
