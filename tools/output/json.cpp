#include "tools/output/json.h"

#include <cmath>
#include <cstdio>

namespace haptel::tools {

Json finite_or_null(double value)
{
    return std::isfinite(value) ? Json(value) : Json(nullptr);
}

std::string to_text(const Json& json)
{
    return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

void print_json(const Json& json)
{
    const std::string text = to_text(json) + "\n";
    std::fwrite(text.data(), 1, text.size(), stdout);
    std::fflush(stdout);
}

} // namespace haptel::tools
