// What the long runs are told by the environment.
#pragma once

#include "tests/runtime/surface/meshes.h"

#include <cstdint>
#include <vector>

namespace haptel::test {

// HAPTEL_TEST_MESHES: files with ':' between; each as it is and 1e4 m from the origin.
std::vector<NamedMesh> meshes_of_environment();

uint64_t number_of_environment(const char* name, uint64_t otherwise);

} // namespace haptel::test
