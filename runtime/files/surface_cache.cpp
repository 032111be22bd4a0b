#include "runtime/files/surface_cache.h"

#include <sstream>
#include <system_error>

namespace haptel::runtime {

std::string SurfaceCache::key(const std::filesystem::path& mesh, const std::string& shape, double size_m,
                              std::optional<double> crease_deg)
{
    std::ostringstream key;
    key << std::hexfloat << shape << '\n' << size_m << '\n' << crease_deg.value_or(-1) << '\n' << mesh.string();
    if (!mesh.empty()) { // what is not there has no date, and is no surface
        std::error_code none;
        key << '\n' << std::filesystem::last_write_time(mesh, none).time_since_epoch().count();
        key << '\n' << std::filesystem::file_size(mesh, none);
    }
    return key.str();
}

std::shared_ptr<const Surface> SurfaceCache::find(const std::string& key) const
{
    const auto found = surfaces_.find(key);
    return found == surfaces_.end() ? nullptr : found->second.lock();
}

void SurfaceCache::keep(const std::string& key, const std::shared_ptr<const Surface>& surface)
{
    std::erase_if(surfaces_, [](const auto& entry) { return entry.second.expired(); });
    surfaces_[key] = surface;
}

} // namespace haptel::runtime
