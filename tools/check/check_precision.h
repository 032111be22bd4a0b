// The precision that check --max-error picks, as it is shown.
#pragma once

#include "jit/check/precision_choice.h"
#include "tools/check/amplified_place.h"
#include "tools/output/json.h"

#include <optional>
#include <string>

namespace haptel::tools {

struct CheckedPrecision {
    double error_max = 0;
    jit::PrecisionChoice choice;
    std::optional<AmplifiedPlace> amplified = {}; // why less than f64 is not enough, where that is known

    bool is_met() const;
    bool takes_f64() const; // or no precision at all
    // Of all three, in words: for the finding that none is close enough.
    std::string closest() const;
};

// Why the precisions of this texture differ, if it is that, over the request's box.
std::optional<AmplifiedPlace> find_amplified(const std::string& file, const std::string& texture,
                                             const TextureRequest& request);

Json precision_json(const CheckedPrecision& checked);
std::string precision_text(const CheckedPrecision& checked);

} // namespace haptel::tools
