// One small octahedron in the bytes of every format that meshes are read from.
#pragma once

#include <string>
#include <vector>

namespace haptel::test {

struct MeshBytes {
    std::string extension; // ".ply"
    std::string bytes;
};

// PLY and STL twice: as text and in binary.
std::vector<MeshBytes> octahedron_files();

} // namespace haptel::test
