// Surfaces of mesh files and shapes, so that a scene that is loaded again has those that did not change: they are not
// built anew, and a hand goes on touching them. A surface that nobody holds any more is forgotten.
#pragma once

#include "runtime/surface/surface.h"

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>

namespace haptel::runtime {

class SurfaceCache {
public:
    // Of a mesh file as it is now, or of a shape (an empty path), and what is made of it. No crease: the file's own.
    static std::string key(const std::filesystem::path& mesh, const std::string& shape, double size_m,
                           std::optional<double> crease_deg);

    // Null if there is none.
    std::shared_ptr<const Surface> find(const std::string& key) const;
    void keep(const std::string& key, const std::shared_ptr<const Surface>& surface);

private:
    std::map<std::string, std::weak_ptr<const Surface>> surfaces_;
};

} // namespace haptel::runtime
