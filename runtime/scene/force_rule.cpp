#include "runtime/scene/force_rule.h"

#include <algorithm>

namespace haptel::runtime {

std::optional<ForceModel> force_model_named(std::string_view name)
{
    const auto found = std::find(force_model_names.begin(), force_model_names.end(), name);
    if (found == force_model_names.end()) return std::nullopt;
    return static_cast<ForceModel>(found - force_model_names.begin());
}

} // namespace haptel::runtime
