#include "tests/support/project_path.h"

namespace haptel::test {

std::string project_path(const std::string& name)
{
    return HAPTEL_SOURCE_DIR "/" + name;
}

} // namespace haptel::test
