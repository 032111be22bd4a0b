// A surface as a file: what was built comes back to the last bit. The arrays lie in it as in this program's memory, so
// that it serves this program on this machine alone; another one sees that and does not take it.
#pragma once

#include "input/checksum.h"
#include "runtime/surface/surface.h"

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace haptel::runtime {

struct KeptSurface {
    std::shared_ptr<const Surface> surface;
    MeshReport report;
    std::string text; // what else whoever keeps it wants to know
};

// In pieces that live as long as what they are of, and `room`.
std::vector<std::string_view> pieces_of_file(const KeptSurface& kept, const input::Checksum& key, unsigned threads,
                                             std::string& room);

// From an open file. Nothing if it is not whole, or of another key or version.
std::optional<KeptSurface> read_surface(int file, const input::Checksum& key, unsigned threads);

} // namespace haptel::runtime
