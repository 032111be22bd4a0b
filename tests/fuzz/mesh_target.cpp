// Files that claim to be meshes: what reads them may crash in its own process, what is made of them here may not.
#include "runtime/files/mesh_file.h"
#include "runtime/surface/surface.h"
#include "tests/fuzz/target.h"
#include "tests/support/folder.h"
#include "tests/support/mesh_bytes.h"

namespace haptel::fuzz {

// The first line is the extension; one that is not known is that of a PLY file.
void read_mesh(std::string_view bytes)
{
    static const std::vector<test::MeshBytes> known = test::octahedron_files();
    static const test::Folder folder;
    const size_t line = std::min(bytes.find('\n'), bytes.size());
    std::string extension = ".ply";
    for (const test::MeshBytes& file : known)
        if (file.extension == bytes.substr(0, line)) extension = file.extension;
    bytes.remove_prefix(std::min(line + 1, bytes.size()));

    const runtime::MeshReadLimits some_never_end = {0.2, 20};
    const runtime::MeshFileResult read =
        runtime::load_mesh(folder.write("mesh" + extension, std::string(bytes)), some_never_end);
    if (read.error.empty() == read.mesh.triangles.empty()) fail("neither a mesh nor a reason, or both");
    count(read.error.empty() ? "meshes" : read.error.find("gave up") == std::string::npos ? "refused" : "given up");
    if (!read.error.empty()) return;
    const runtime::SurfaceResult built = runtime::build_surface(read.mesh, 40);
    if ((built.surface == nullptr) == built.error.empty()) fail("neither a surface nor a reason, or both");
    if (built.surface) count("surfaces");
}

std::vector<std::string> mesh_corpus()
{
    std::vector<std::string> corpus;
    for (const test::MeshBytes& file : test::octahedron_files()) corpus.push_back(file.extension + "\n" + file.bytes);
    return corpus;
}

} // namespace haptel::fuzz
