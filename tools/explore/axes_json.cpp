#include "tools/explore/axes_json.h"

#include <string>

namespace haptel::tools {

namespace {

Json names_of(const glm::bvec3& axes)
{
    Json names = Json::array();
    for (int i = 0; i < 3; ++i)
        if (axes[i]) names.push_back(std::string(1, "xyz"[i]));
    return names;
}

} // namespace

Json axes_json(const runtime::DeviceAxes& axes)
{
    return {{"sensed", names_of(axes.senses)}, {"pushed", names_of(axes.pushes)}};
}

} // namespace haptel::tools
