#include "tests/runtime/contact/long_run.h"

#include "runtime/files/mesh_file.h"

#include <cstdlib>
#include <sstream>
#include <stdexcept>

namespace haptel::test {

std::vector<NamedMesh> meshes_of_environment()
{
    std::vector<NamedMesh> meshes;
    const char* files = std::getenv("HAPTEL_TEST_MESHES");
    std::istringstream list(files ? files : "");
    for (std::string file; std::getline(list, file, ':');) {
        runtime::MeshFileResult read = runtime::load_mesh(file);
        if (!read.error.empty()) throw std::runtime_error(read.error);
        meshes.push_back({file, read.mesh});
        meshes.push_back({file + ", far away", far_away(std::move(read.mesh))});
    }
    return meshes;
}

uint64_t number_of_environment(const char* name, uint64_t otherwise)
{
    const char* text = std::getenv(name);
    return text ? std::strtoull(text, nullptr, 10) : otherwise;
}

} // namespace haptel::test
